// Rows of contacts that are met on the way (swept_contact.h).
#include "solve/swept_contact.h"

#include "avbd/rows/math3.h"
#include "solve/body_rows.h"
#include "solve/geometric.h"

namespace avbd {

namespace {

using rows::Q4;
using rows::Twist;
using rows::V3;

/// A contact where the bodies have moved so far, relative to A's centre at the start of the step.
struct Moved {
  V3<float> centerA, centerB, n, plane, point[4];

  Moved(const SweptContact& s, const Twist<float>& dA, const Twist<float>& dB)
      : centerA(dA.lin), centerB(s.between + dB.lin) {
    const Q4<float> turnA = rows::expQuat(dA.ang), turnB = rows::expQuat(dB.ang);
    const Q4<float> turnPlane = s.turns ? (s.planeOnA ? turnA : turnB) : Q4<float>{1, 0, 0, 0};
    n = rotate(turnPlane, s.n);
    plane = (s.planeOnA ? centerA : centerB) + rotate(turnPlane, s.plane);
    const V3<float> out = n * (s.planeOnA ? -s.radius : s.radius);
    for (int i = 0; i < s.count; ++i)
      point[i] = (s.planeOnA ? centerB : centerA) + rotate(s.planeOnA ? turnB : turnA, s.core[i]) + out;
  }
  float depth(const SweptContact& s, int i) const { return (s.planeOnA ? -1.0f : 1.0f) * dot(n, point[i] - plane); }
};

}  // namespace

float depthOf(const SweptContact& contact, int point, const Twist<float>& dA, const Twist<float>& dB) {
  return Moved(contact, dA, dB).depth(contact, point);
}

void linearise(const SweptContact& s, const Twist<float>& dA, const Twist<float>& dB, rows::Contact<float>& c) {
  const Moved moved(s, dA, dB);
  V3<float> reference{0, 0, 0};
  for (int i = 0; i < s.count; ++i) reference = reference + moved.point[i];
  reference = reference * (1.0f / static_cast<float>(s.count));
  c.n = moved.n;
  rows::orthonormalBasis(c.n, c.t1, c.t2);
  c.armA = reference - moved.centerA, c.armB = reference - moved.centerB;
  const Twist<float> motion = relativeMotion(dA, dB, c.armA, c.armB);
  const Twist<float> met = relativeMotion(s.metA, s.metB, c.armA, c.armB);
  for (int i = 0; i < s.count; ++i) {
    rows::ContactPointRows<float>& p = c.point[i];
    p.arm = moved.point[i] - reference;
    const V3<float> slip = s.belt - met.lin - cross(met.ang, p.arm);
    p.biasN = moved.depth(s, i) - s.offset[i] - dot(c.n, motion.lin + cross(motion.ang, p.arm));
    p.bias1 = dot(c.t1, slip), p.bias2 = dot(c.t2, slip);
  }
}

void lineariseSwept(const BatchView& view) {
  for (const SweptContact& s : view.swept) {
    const uint32_t tile = s.lane / kTile;
    const int lane = static_cast<int>(s.lane % kTile);
    if (s.isFull) {
      rows::FullContact<float> full = view.full.tile[tile].get(lane);
      linearise(s, readTwist(view.d, view.full.a[s.lane]), readTwist(view.d, view.full.b[s.lane]), full.contact);
      view.full.tile[tile].set(lane, full);
      continue;
    }
    rows::Contact<float> contact = view.contacts.tile[tile].get(lane);
    linearise(s, readTwist(view.d, view.contacts.a[s.lane]), readTwist(view.d, view.contacts.b[s.lane]), contact);
    view.contacts.tile[tile].set(lane, contact);
  }
}

namespace {

void stiffen(const BatchView& view, const rows::Contact<float>& c, uint32_t rowA, uint32_t rowB) {
  const Twist<float> dA = readTwist(view.d, rowA), dB = readTwist(view.d, rowB);
  const Twist<float> motion = relativeMotion(dA, dB, c.armA, c.armB);
  for (const rows::ContactPointRows<float>& p : c.point) {
    if (!(p.floorN > 0)) continue;
    const float k = rows::max(p.floorN, rows::min(c.stiffest, p.lambdaN * c.loadStiffness));
    const float force = p.lambdaN + k * (p.biasN + dot(c.n, motion.lin + cross(motion.ang, p.arm)));
    if (!(force > 0)) continue;
    if (rowA < view.bodies) addAngular(view, rowA, rows::geometricStiffness(c.n * -force, c.armA + p.arm));
    if (rowB < view.bodies) addAngular(view, rowB, rows::geometricStiffness(c.n * force, c.armB + p.arm));
  }
}

}  // namespace

void stiffenSwept(const BatchView& view) {
  for (const SweptContact& s : view.swept) {
    const uint32_t tile = s.lane / kTile;
    const int lane = static_cast<int>(s.lane % kTile);
    if (s.isFull)
      stiffen(view, view.full.tile[tile].get(lane).contact, view.full.a[s.lane], view.full.b[s.lane]);
    else
      stiffen(view, view.contacts.tile[tile].get(lane), view.contacts.a[s.lane], view.contacts.b[s.lane]);
  }
}

}  // namespace avbd
