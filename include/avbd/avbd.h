// The whole public API.
#pragma once

#include <avbd/articulation.h>
#include <avbd/body.h>
#include <avbd/coupling.h>
#include <avbd/custom_joint.h>
#include <avbd/debug_draw.h>
#include <avbd/decompose.h>
#include <avbd/error.h>
#include <avbd/events.h>
#include <avbd/geometry.h>
#include <avbd/height_field.h>
#include <avbd/hull.h>
#include <avbd/id.h>
#include <avbd/joint.h>
#include <avbd/mesh.h>
#include <avbd/mover.h>
#include <avbd/profile.h>
#include <avbd/query.h>
#include <avbd/soft.h>
#include <avbd/soft_binding.h>
#include <avbd/soft_lattice.h>
#include <avbd/soft_mesh.h>
#include <avbd/tasks.h>
#include <avbd/types.h>
#include <avbd/world.h>
