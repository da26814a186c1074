// MJCF contact pairs as collision groups.
#include <algorithm>

#include "io/mjcf_build.h"

namespace avbd::mjcf {

namespace {

using Key2 = std::pair<int, size_t>;

const Geom& geomOf(const Description& description, GeomRef ref) {
  return description.bodies[static_cast<size_t>(ref.body)].geoms[ref.geom];
}

bool filtersMeet(const Description& description, const Geom& a, const Geom& b) {
  return !description.contactsOff && ((a.contype & b.conaffinity) != 0 || (b.contype & a.conaffinity) != 0);
}

}  // namespace

std::map<Key2, PairGroup> pairGroups(const Description& description, Notes& notes) {
  std::map<Key2, PairGroup> out;
  int next = 0;
  for (const Pair& pair : description.pairs) {
    if (description.pairsOff) {
      notes.add(pair.where, "contact pairs are switched off by option");
      continue;
    }
    const Geom &a = geomOf(description, pair.a), &b = geomOf(description, pair.b);
    const bool ownSurface = pair.hasFriction || pair.hasCondim;
    if (filtersMeet(description, a, b)) {
      if (ownSurface) notes.add(pair.where, "contact pair: the friction of its geoms is used, not its own");
      continue;
    }
    const Key2 keyA{pair.a.body, pair.a.geom}, keyB{pair.b.body, pair.b.geom};
    // A shape has one group, so each geom can be in one pair only.
    if (out.contains(keyA) || out.contains(keyB)) {
      notes.add(pair.where, "contact pair is left out: one of its geoms is in a pair already");
      continue;
    }
    PairGroup group{++next};
    const auto meetsNothing = [&](const Geom& geom) {
      return description.contactsOff || (geom.contype == 0 && geom.conaffinity == 0);
    };
    if (ownSurface && meetsNothing(a) && meetsNothing(b)) {
      const int condim = pair.hasCondim ? pair.condim : std::max(a.condim, b.condim);
      group.friction = condim == 1 ? 0 : pair.hasFriction ? pair.friction : std::max(a.friction, b.friction);
      if (condim >= 4) group.torsional = pair.hasFriction ? pair.torsional : std::max(a.torsional, b.torsional);
      if (condim == 6) group.rolling = pair.hasFriction ? pair.rolling : std::max(a.rolling, b.rolling);
    } else if (ownSurface) {
      notes.add(pair.where, "contact pair: the friction of its geoms is used, not its own");
    }
    out[keyA] = out[keyB] = group;
  }
  return out;
}

}  // namespace avbd::mjcf
