// Where the links of an articulation are and how they move, from its coordinates (articulation_placed.h).
//
// For a joint whose body A is the parent, with w the spin of A, R A's axes, l and u the linear and angular velocity of
// frame B in A (articulation_joint.h), and the pivot at the origin of frame B, the child's material point there has
//   velocity: that of the parent's point there + R l;  spin: the parent's + R u;
//   acceleration: that of the parent's point there + 2 w x R l + R l';  angular: the parent's + w x R u + R u'.
// Where B is the parent the same terms are taken away; w is then the child's spin.
#include "api/articulation_placed.h"

#include <avbd/world.h>

#include <span>

#include "api/articulation_joint.h"

namespace avbd::articulation {
namespace {

/// What a link hangs on.
struct Carrier {
  Posed frame;   ///< of the body, in the world
  Vec3d center;  ///< where `velocity` is meant
  Spatial velocity;
};

/// A body of the base, or where null the world. Such bodies have no centre of mass but their origin.
Carrier baseCarrier(const World& world, BodyId base) {
  Carrier carrier;
  if (!base) return carrier;
  carrier.frame = toDouble(world.pose(base));
  carrier.center = carrier.frame.position;
  const Velocity velocity = world.velocity(base);
  carrier.velocity = {avbd::toDouble(velocity.linear), avbd::toDouble(velocity.angular)};
  return carrier;
}

SymMat3d turned(Quatd q, const SymMat3& i) {
  const SymMat3d body{i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
  const Quatd back = conjugate(q);
  const Vec3d x = rotate(q, times(body, rotate(back, Vec3d{1, 0, 0})));
  const Vec3d y = rotate(q, times(body, rotate(back, Vec3d{0, 1, 0})));
  const Vec3d z = rotate(q, times(body, rotate(back, Vec3d{0, 0, 1})));
  return {x.x, y.y, z.z, 0.5 * (x.y + y.x), 0.5 * (x.z + z.x), 0.5 * (y.z + z.y)};
}

/// Once its frame is known.
void weigh(const World& world, BodyId body, PlacedLink& link) {
  link.center = link.frame.position + rotate(link.frame.rotation, avbd::toDouble(world.centerOfMass(body)));
  link.mass = static_cast<double>(world.mass(body));
  link.inertia = turned(link.frame.rotation, world.inertia(body));
  const double share = link.mass * static_cast<double>(world.gravityScale(body));
  link.weight = avbd::toDouble(world.definition().gravity) * share;
}

class Placing {
 public:
  Placing(const World& world, const Articulation& tree, const ArticulationState& state)
      : world_(world), state_(state), baseDofs_(tree.isFloating() ? 6 : 0) {
    placed_.gravity = avbd::toDouble(world.definition().gravity);
    placed_.dofs.resize(tree.dofCount());
    for (size_t i = 0; i < tree.dofCount(); ++i) placed_.dofs[i].velocity = state.velocities[i];
    for (const ArticulationLink& link : tree.links()) placed_.links.push_back(link.joint ? hung(link) : root(link));
  }
  Placed take() { return std::move(placed_); }

 private:
  PlacedLink root(const ArticulationLink& def) {
    PlacedLink link{.firstDof = def.firstDof, .dofCount = def.dofCount, .frame = toDouble(state_.base)};
    weigh(world_, def.body, link);
    link.pivot = link.center;
    const Vec3d unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::vector<PlacedDof>& dofs = placed_.dofs;
    for (size_t i = 0; i < 3; ++i) dofs[i].axis.linear = dofs[i + 3].axis.angular = unit[i];
    for (size_t i = 0; i < 6; ++i) link.velocity = link.velocity + dofs[i].axis * dofs[i].velocity;
    return link;
  }

  PlacedLink hung(const ArticulationLink& def) {
    const JointModel joint = readJoint(world_, def.joint);
    const Carrier parent = def.parent < 0 ? baseCarrier(world_, def.base) : linkCarrier(def.parent);
    PlacedLink link{.parent = def.parent, .firstDof = def.firstDof, .dofCount = def.dofCount};
    link.baseOrigin = parent.center, link.baseSpin = parent.velocity.angular;
    const size_t first = static_cast<size_t>(def.firstDof), count = static_cast<size_t>(def.dofCount);
    const auto q = count ? std::span(state_.positions).subspan(first - baseDofs_, count) : std::span<const double>();
    const auto v = count ? std::span(state_.velocities).subspan(first, count) : std::span<const double>();
    const Posed relative = relativePose(joint, q);
    const Posed onParent = parent.frame * (def.reversed ? joint.frameB : joint.frameA);
    const Posed onChild = onParent * (def.reversed ? inverse(relative) : relative);
    link.frame = onChild * inverse(def.reversed ? joint.frameA : joint.frameB);
    link.pivot = def.reversed ? onParent.position : onChild.position;
    weigh(world_, def.body, link);
    setMotion(link, parent, subspace(joint, q, v), def.reversed ? onChild.rotation : onParent.rotation, def.reversed);
    for (size_t i = 0; i < count; ++i) placed_.dofs[first + i].armature = joint.armature[i];
    return link;
  }

  /// axesA: of frame A, in the world.
  void setMotion(PlacedLink& link, const Carrier& parent, const JointSubspace& moves, Quatd axesA, bool reversed) {
    const auto inWorld = [&](const Spatial& s) {
      return Spatial{rotate(axesA, s.linear), rotate(axesA, s.angular)} * (reversed ? -1 : 1);
    };
    for (size_t i = 0; i < static_cast<size_t>(link.dofCount); ++i)
      placed_.dofs[static_cast<size_t>(link.firstDof) + i].axis = inWorld(moves.columns[i]);
    const Spatial own = inWorld(moves.velocity);
    const Spatial atPivot = movedBy(parent.velocity, link.pivot - parent.center) + own;
    link.velocity = movedBy(atPivot, link.center - link.pivot);
    const Vec3d spin = reversed ? link.velocity.angular : parent.velocity.angular;
    link.rate = inWorld(moves.rate) + Spatial{cross(spin, own.linear) * 2, cross(spin, own.angular)};
  }

  Carrier linkCarrier(int parent) const {
    const PlacedLink& link = placed_.links[static_cast<size_t>(parent)];
    return {link.frame, link.center, link.velocity};
  }

  const World& world_;
  const ArticulationState& state_;
  size_t baseDofs_;
  Placed placed_;
};

}  // namespace

Placed place(const World& world, const Articulation& tree, const ArticulationState& state) {
  return Placing(world, tree, state).take();
}

}  // namespace avbd::articulation
