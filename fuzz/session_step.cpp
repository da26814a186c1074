// Steps, and what they say happened.
#include <algorithm>

#include "fuzz/session.h"

namespace avbd::fuzz {

void Session::step() {
  const float dt = in_.byte() < 245 ? 1.0f / 60 : in_.number();
  const uint64_t hash = world_.hash();
  std::vector<Pose> before(bodies_.size()), after(bodies_.size());
  std::vector<Velocity> speedBefore(bodies_.size()), speedAfter(bodies_.size());
  world_.getPoses(bodies_, before);
  world_.getVelocities(bodies_, speedBefore);
  try {
    world_.step(dt);
    checkEvents();
  } catch (const Error& error) {
    const float shortest = 1e-7f * static_cast<float>(world_.definition().substeps);
    require(!(dt >= shortest && dt <= 1) || error.definition() == "ContactPlan", "a good step refused");
    require(world_.hash() == hash, "a refused step changed the world");
  } catch (const NonFiniteError& error) {
    require(!error.stage().empty(), "a step that failed without a stage");
    world_.getPoses(bodies_, after);
    world_.getVelocities(bodies_, speedAfter);
    require(before == after && speedBefore == speedAfter, "a failed step moved something");
    world_.clearForces();
  }
}

bool Session::everLived(ShapeId id) const {
  return world_.isAlive(id) || std::find(deadShapes_.begin(), deadShapes_.end(), id) != deadShapes_.end();
}

void Session::checkEvents() {
  checkTouches();
  checkVisits();
  const Events& events = world_.events();
  for (const HitEvent& hit : events.hits) {
    require(world_.isAlive(hit.shapeA) && world_.isAlive(hit.shapeB), "a hit of a dead shape");
    require(isUnit(hit.normal) && isFinite(hit.position), "a hit nowhere");
    require(std::isfinite(hit.speed) && hit.speed >= world_.definition().hitSpeed, "a hit below the threshold");
    require(std::isfinite(hit.impulse) && hit.impulse > 0, "a hit without impulse");
  }
  require(events.moves.empty() || world_.definition().moveEvents, "moves that nobody asked for");
  for (const MoveEvent& move : events.moves) {
    require(world_.isAlive(move.body), "a dead body moved");
    require(move.pose == world_.pose(move.body), "a body moved elsewhere");
  }
}

/// Begins and ends alternate for each pair, also where both are in one step. `now`: pairs that have begun and not
/// ended; returns those that were so at any time of the step.
std::set<Session::Pair> Session::follow(std::set<Pair>& now, const std::set<Pair>& begins, const std::set<Pair>& ends) {
  std::set<Pair> ever = now;
  ever.insert(begins.begin(), begins.end());
  for (const Pair& pair : ends) require(ever.count(pair) == 1, "an end without a begin");
  for (const Pair& pair : begins) require(now.count(pair) == 0 || ends.count(pair) == 1, "a second begin");
  const std::set<Pair> before = now;
  for (const Pair& pair : ends) now.erase(pair);
  for (const Pair& pair : begins)
    if (before.count(pair) == ends.count(pair)) now.insert(pair);
  for (const Pair& pair : now) require(lives(pair.first) && lives(pair.second), "what is dead goes on");
  return ever;
}

/// What carries force has begun.
void Session::checkTouches() {
  const Events& events = world_.events();
  std::set<Pair> begins, ends;
  for (const TouchEvent& e : events.ends) {
    require(everLived(e.shapeA) && everLived(e.shapeB), "an end of a shape that never was");
    require(ends.insert(pairOf(e.softA, e.shapeA, e.softB, e.shapeB)).second, "two ends of one pair");
  }
  for (const TouchEvent& e : events.begins) {
    require(world_.isAlive(e.shapeA) && world_.isAlive(e.shapeB), "a begin of a dead shape");
    require(world_.body(e.shapeA) == e.bodyA && world_.body(e.shapeB) == e.bodyB, "a begin of other bodies");
    require(world_.softBody(e.bodyA) == e.softA && world_.softBody(e.bodyB) == e.softB, "a begin of other soft bodies");
    // Of a soft body some points may ask and others not.
    require((e.softA || !silent_.count(e.shapeA)) && (e.softB || !silent_.count(e.shapeB)),
            "a begin that nobody asked for");
    require(begins.insert(pairOf(e.softA, e.shapeA, e.softB, e.shapeB)).second, "two begins of one pair");
  }
  const std::set<Pair> touched = follow(touching_, begins, ends);
  for (const Contact& contact : world_.contacts()) {
    bool carries = false;
    for (int i = 0; i < contact.pointCount; ++i)
      carries = carries || contact.points[static_cast<size_t>(i)].normalForce > 0;
    if (!carries || silent_.count(contact.shapeA) || silent_.count(contact.shapeB)) continue;
    const Pair pair = pairOf(contact.softA, contact.shapeA, contact.softB, contact.shapeB);
    require(touched.count(pair) == 1, "a contact that never began");
    require(contact.touch != TouchPhase::None, "a contact that carries and does not touch");
  }
}

void Session::checkVisits() {
  const Events& events = world_.events();
  std::set<Pair> enters, leaves;
  for (const TriggerEvent& e : events.leaves) {
    require(everLived(e.trigger) && everLived(e.visitor), "a leave of a shape that never was");
    require(leaves.insert(pairOf({}, e.trigger, e.visitorSoft, e.visitor)).second, "two leaves of one pair");
  }
  for (const TriggerEvent& e : events.enters) {
    require(world_.isAlive(e.trigger) && world_.isAlive(e.visitor), "an enter of a dead shape");
    require(world_.isTrigger(e.trigger), "an enter into what is no trigger");
    require(world_.softBody(world_.body(e.visitor)) == e.visitorSoft, "an enter of another soft body");
    require(enters.insert(pairOf({}, e.trigger, e.visitorSoft, e.visitor)).second, "two enters of one pair");
  }
  follow(visiting_, enters, leaves);
}

void Session::checkContacts() const {
  for (const Contact& contact : world_.contacts()) {
    require(world_.isAlive(contact.shapeA) && world_.isAlive(contact.shapeB), "a contact of a dead shape");
    require(world_.body(contact.shapeA) == contact.bodyA && world_.body(contact.shapeB) == contact.bodyB,
            "a contact of other bodies");
    require(world_.softBody(contact.bodyA) == contact.softA && world_.softBody(contact.bodyB) == contact.softB,
            "a contact of other soft bodies");
    require(!world_.isTrigger(contact.shapeA) && !world_.isTrigger(contact.shapeB), "a contact of a trigger");
    require(isUnit(contact.normal), "a contact normal that is not unit");
    require(contact.pointCount >= 1 && contact.pointCount <= 4, "a contact without points");
    for (int i = 0; i < contact.pointCount; ++i) {
      const ContactPoint& p = contact.points[static_cast<size_t>(i)];
      require(isFinite(p.position) && std::isfinite(p.separation), "a contact point that is not finite");
      require(isFinite(p.frictionForce) && std::isfinite(p.normalForce), "a contact force that is not finite");
      require(p.normalForce >= 0, "a contact that pulls");
    }
  }
}

}  // namespace avbd::fuzz
