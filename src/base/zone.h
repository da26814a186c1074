// A stretch of work with a name, for a profiler that the user brings: AVBD_ZONE(name) marks the rest of its block.
// Empty unless the library is built with AVBD_TRACY.
#pragma once

#ifdef AVBD_TRACY
#include <tracy/Tracy.hpp>
#define AVBD_ZONE(name) ZoneTransientN(avbdZone, name, true)
#else
#define AVBD_ZONE(name) static_cast<void>(0)
#endif
