// The list of the built-in families. A family over two bodies is a struct template of R members only (so that a tile of
// 16 lanes is its transpose), with kRows and rows(dA, dB, sink); one over N blocks has kBlocks and rows(d, sink).
#pragma once

#include <avbd/rows/ball_joint.h>
#include <avbd/rows/contact.h>
#include <avbd/rows/fixed_joint.h>
#include <avbd/rows/full_contact.h>
#include <avbd/rows/tet_volume.h>

namespace avbd::rows {

template <template <class> class F>
struct Family {};

/// Calls f(Family<F>{}, name) for each pair family. Law tests, storage and back-ends run over this list.
template <class Visitor>
AVBD_INLINE void forEachPairFamily(Visitor&& f) {
  f(Family<Contact>{}, "contact");
  f(Family<BallJoint>{}, "ball_joint");
  f(Family<FixedJoint>{}, "fixed_joint");
  f(Family<FullContact>{}, "full_contact");
}

template <class Visitor>
AVBD_INLINE void forEachBlockFamily(Visitor&& f) {
  f(Family<TetVolume>{}, "tet_volume");
}

}  // namespace avbd::rows
