// The whole public API.
#pragma once

#include <avbd/body.h>
#include <avbd/error.h>
#include <avbd/events.h>
#include <avbd/geometry.h>
#include <avbd/id.h>
#include <avbd/joint.h>
#include <avbd/profile.h>
#include <avbd/types.h>
#include <avbd/world.h>
