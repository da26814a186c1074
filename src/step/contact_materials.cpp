// Two materials to one: how a pair rubs and rebounds.
#include <algorithm>

#include "avbd/rows/math.h"
#include "step/contacts.h"

namespace avbd {

namespace {

float combined(float a, float b, Combine rule) {
  switch (rule) {
    case Combine::GeometricMean:
      return rows::sqrt(a * b);
    case Combine::Average:
      return 0.5f * (a + b);
    case Combine::Minimum:
      return std::min(a, b);
    case Combine::Multiply:
      return a * b;
    case Combine::Maximum:
      return std::max(a, b);
  }
  return 0;
}

float staticOf(const Material& m) { return m.staticFriction < 0 ? m.friction : m.staticFriction; }

}  // namespace

CombinedMaterial combined(const Material& a, const Material& b) {
  if (a.frictionPriority != b.frictionPriority) {
    const Material& m = a.frictionPriority > b.frictionPriority ? a : b;
    return {staticOf(m), m.friction, m.restitution, m.torsionalFriction, m.rollingFriction};
  }
  const Combine rule = std::max(a.frictionCombine, b.frictionCombine);
  const float friction = combined(a.friction, b.friction, rule);
  // Of two zeros every rule makes zero.
  const bool turns = a.torsionalFriction > 0 || b.torsionalFriction > 0;
  const bool rolls = a.rollingFriction > 0 || b.rollingFriction > 0;
  return {std::max(friction, combined(staticOf(a), staticOf(b), rule)), friction,
          combined(a.restitution, b.restitution, std::max(a.restitutionCombine, b.restitutionCombine)),
          turns ? combined(a.torsionalFriction, b.torsionalFriction, rule) : 0,
          rolls ? combined(a.rollingFriction, b.rollingFriction, rule) : 0};
}

void combineMaterials(PairData& pair, const Material& a, const Material& b) {
  const CombinedMaterial m = combined(a, b);
  pair.staticFriction = m.staticFriction, pair.friction = m.friction, pair.restitution = m.restitution;
  pair.torsionalFriction = m.torsionalFriction, pair.rollingFriction = m.rollingFriction;
  pair.isFull = pair.torsionalFriction > 0 || pair.rollingFriction > 0;
}

}  // namespace avbd
