// Numbers of articulations (articulation_check.h).
#include "api/articulation_check.h"

#include "world/limits.h"

namespace avbd::articulation {
namespace {

constexpr double kMostTurns = 1e5;  ///< [rad] beyond, a float cannot tell angles apart

void checkCount(const Path& path, std::span<const double> values, size_t count) {
  if (values.size() != count) path.refuse(toText(values.size()) + " numbers", "must have " + toText(count));
}

}  // namespace

void checkLinks(const Path& call, const World& world, const Articulation& tree) {
  const Path path = call / "links";
  for (size_t i = 0; i < tree.links().size(); ++i) {
    const ArticulationLink& link = tree.links()[i];
    const Path at = path[i];
    if (!world.isAlive(link.body)) (at / "body").refuse(toText(link.body), "must be a living body of this world");
    if (link.joint && !world.isAlive(link.joint))
      (at / "joint").refuse(toText(link.joint), "must be a living joint of this world");
  }
}

void checkNumbers(const Path& path, std::span<const double> values, const Articulation& tree, Kind kind, float unit) {
  const bool positions = kind == Kind::Positions;
  const size_t count = positions ? tree.positionCount() : tree.dofCount(), first = tree.dofCount() - count;
  checkCount(path, values, count);
  const double most[2] = {(positions ? kMaxSize : kMaxSpeed) * static_cast<double>(unit),
                          positions ? kMostTurns : kMaxSpin};
  for (size_t i = 0; i < count; ++i) {
    const bool angular = tree.dofs()[first + i].axis >= JointAxis::Twist;
    // As the world is given them.
    check(path[i], static_cast<float>(values[i]), symmetric(most[angular]));
  }
}

ArticulationState checkedState(const Path& call, const World& world, const Articulation& tree,
                               const ArticulationState& state) {
  const float unit = world.definition().lengthUnit;
  const Path path = call / "state";
  checkNumbers(path / "positions", state.positions, tree, Kind::Positions, unit);
  checkNumbers(path / "velocities", state.velocities, tree, Kind::Velocities, unit);
  ArticulationState out = state;
  if (tree.isFloating()) out.base = checkedPose(path / "base", state.base, kMaxPosition * static_cast<double>(unit));
  return out;
}

void checkForces(const Path& path, std::span<const double> values, size_t count) {
  checkCount(path, values, count);
  for (size_t i = 0; i < count; ++i) check(path[i], values[i], symmetric(kMaxForce));
}

}  // namespace avbd::articulation
