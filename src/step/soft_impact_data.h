// What impacts of soft bodies are made of (soft_impacts.h), kept between steps for its room.
#pragma once

#include <array>
#include <vector>

#include "world/world_data.h"

namespace avbd {

/// Two features, or a shape and a face, that meet.
struct SoftImpact {
  bool ofShape = false;
  std::array<uint32_t, 4> nodes{};  ///< body slots
  std::array<float, 4> weight{};    ///< SoftTouch's
  Vec3 normal;                      ///< unit, from the second side to the first
  Vec3 arm;                         ///< of a shape from its body's centre of mass to where it meets
  float start = 0;                  ///< [m] along the normal at the start of the step, less what is to be left
  float shapeWay = 0;               ///< [m] of a shape along the normal
  float time = 1;                   ///< 0 .. 1 of the step, when so much is to be left
  bool isFast = false;
  bool hasRow = false;  ///< the solve knew of it
  float meets = 0;      ///< 0 .. 1 of the step
  float impulse = 0;    ///< [kg m] >= 0: a change of ways
};
/// Of a point that is stopped.
struct SoftStop {
  Vec3 way;             ///< [m] that it went before
  float share = 1;      ///< of that, beyond its group's
  bool hadRow = false;  ///< for all that it met
  Vec3 taken;           ///< [kg m] impulses that did not move it
};
/// Soft bodies and shapes' bodies that have met.
struct SoftGroup {
  float mass = 0;
  Vec3 way;               ///< [kg m] of all, then [m] the mean
  uint32_t held = kNone;  ///< a body that does not yield, whose way is the group's
  Vec3 lost;              ///< [kg m] that stops took
};

struct SoftImpactData {
  std::vector<SoftImpact> impacts;
  std::vector<size_t> met;                      ///< of `impacts`, in this pass
  std::vector<uint32_t> pointOf;                ///< by body slot
  std::vector<uint8_t> touched;                 ///< by body slot: it is in `changed`
  std::vector<uint32_t> changed;                ///< body slots whose ways changed in this pass
  std::vector<SoftStop> stops;                  ///< by body slot
  std::vector<uint32_t> stopped;                ///< body slots
  std::vector<uint32_t> parent;                 ///< of members of groups: soft slots, then body slots
  std::vector<SoftGroup> groups;                ///< by the member that names it
  std::vector<uint32_t> shapes;                 ///< body slots
  std::vector<std::array<uint32_t, 2>> points;  ///< soft bodies and points that go other ways than before
};

}  // namespace avbd
