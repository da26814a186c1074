// Contacts with a Mesh or HeightField: several patches, each an entry of the pair's run.
//
// A patch takes the entry that touched the surface in its direction in the last step, if possible on the same triangle;
// its points continue those of that entry by feature, or the nearest of the whole run, so that a body that slides from
// triangle to triangle keeps its multipliers.
#include <algorithm>

#include "avbd/rows/row.h"
#include "collide/collide_surface.h"
#include "step/contacts.h"

namespace avbd {

namespace {

/// One pair's search for its patches, and what becomes of its run.
class Run {
 public:
  Run(WorldData& world, StepData& step, size_t begin, size_t end)
      : world_(world), step_(step), begin_(begin), size_(end - begin), head_(world.pairs[begin]) {}

  NearPair now() const {
    return {nearPose(a(), world_.shapes[head_.shapeA], a().position),
            nearPose(b(), world_.shapes[head_.shapeB], a().position), speculativeMargin(world_, a(), b(), step_.h)};
  }

  void collide(const NearPair& near) {
    const ShapeData &shapeA = world_.shapes[head_.shapeA], &shapeB = world_.shapes[head_.shapeB];
    surfaceIsA_ = isSurface(shapeA.geom.type);
    if (surfaceIsA_)
      collideSurface(shapeB.geom, near.b, shapeA.geom, near.a, near.margin, step_.patches);
    else
      collideSurface(shapeA.geom, near.a, shapeB.geom, near.b, near.margin, step_.patches);
    if (!surfaceIsA_) return;
    for (SurfacePatch& patch : step_.patches) patch.manifold.normal = -patch.manifold.normal;
  }

  void fill() {
    listOld();
    chooseEntries();
    matchPoints();
    for (size_t entry = 0; entry < step_.patchOf.size(); ++entry) {
      const uint32_t patch = step_.patchOf[entry];
      if (entry >= size_) step_.overflow.push_back(newEntry(head_, static_cast<uint16_t>(entry)));
      PairData& pair = entry < size_ ? world_.pairs[begin_ + entry] : step_.overflow.back();
      patch != kNone ? fillEntry(pair, patch) : closeEntry(pair);
    }
    if (step_.substep > 0) inheritForces();
  }

 private:
  const BodyData& a() const { return world_.bodies[head_.bodyA]; }
  const BodyData& b() const { return world_.bodies[head_.bodyB]; }

  PairData newEntry(const PairData& head, uint16_t patch) const {
    PairData pair = head;
    pair.mean = kNone;
    forgetContact(world_, step_, pair);
    pair.gonePoints = 0;
    pair.touching = pair.wasTouching = pair.touchBegins = false;
    pair.patch = patch;
    return pair;
  }

  /// Points of the whole run; `oldEntry` says whose.
  void listOld() {
    step_.oldPoints.clear(), step_.oldEntry.clear();
    for (uint32_t i = 0; i < size_; ++i) {
      const PairData& pair = world_.pairs[begin_ + i];
      for (int k = 0; k < pair.pointCount; ++k) {
        const bool gave = step_.substep > 0 && pair.mean != kNone;
        const Vec3 mean = gave ? world_.means[pair.mean][static_cast<size_t>(k)] : Vec3{};
        step_.oldPoints.push_back({pair.points[k], {pair.normal, pair.t1, pair.t2}, mean});
        step_.oldEntry.push_back(i);
      }
    }
    step_.oldTaken.assign(step_.oldPoints.size(), 0);
  }

  /// How well an entry of the last step goes on as this patch; 0: not at all.
  float likeness(const PairData& pair, const SurfacePatch& patch) const {
    const float along = dot(pair.normal, patch.manifold.normal);
    if (pair.pointCount == 0 || along <= kSameNormal || pair.material != patch.material) return 0;
    return pair.element == patch.element ? along + 1 : along;
  }

  void chooseEntries() {
    step_.patchOf.assign(std::max(size_, step_.patches.size()), kNone);
    step_.entryOf.assign(step_.patches.size(), kNone);
    for (uint32_t p = 0; p < step_.patches.size(); ++p) {
      float best = 0;
      for (uint32_t i = 0; i < size_; ++i) {
        if (step_.patchOf[i] != kNone) continue;
        const float like = likeness(world_.pairs[begin_ + i], step_.patches[p]);
        if (like > best) best = like, step_.entryOf[p] = i;
      }
      if (step_.entryOf[p] != kNone) step_.patchOf[step_.entryOf[p]] = p;
    }
    step_.continues.assign(step_.patches.size(), 0);
    uint32_t free = 0;
    for (uint32_t p = 0; p < step_.patches.size(); ++p) {
      step_.continues[p] = step_.entryOf[p] != kNone;
      if (step_.continues[p]) continue;
      while (step_.patchOf[free] != kNone) ++free;
      step_.patchOf[free] = p;
      step_.entryOf[p] = free;
    }
  }

  /// Distance of a new point from where an old one was, in the nearer of the two bodies' frames.
  float distanceSq(const ManifoldPoint& point, const OldPoint& old) const {
    const Vec3 onA = toBody(a(), point.position) - old.memory.anchorA;
    const Vec3 onB = toBody(b(), point.position - toFloat(b().position - a().position)) - old.memory.anchorB;
    return std::min(dot(onA, onA), dot(onB, onB));
  }

  /// Fills match with what `fits` allows, the smallest distance first; features must be equal where asked.
  template <class Fits>
  void matchEach(bool byFeature, float farthest, Fits&& fits) {
    for (uint32_t p = 0; p < step_.patches.size(); ++p) {
      const Manifold& manifold = step_.patches[p].manifold;
      for (int k = 0; k < manifold.count; ++k) {
        uint32_t& match = step_.match[p * kMaxManifoldPoints + static_cast<uint32_t>(k)];
        if (match != kNone) continue;
        float best = farthest * farthest;
        for (uint32_t j = 0; j < step_.oldPoints.size(); ++j) {
          const OldPoint& old = step_.oldPoints[j];
          if (step_.oldTaken[j] || dot(old.basis.normal, manifold.normal) <= kSameNormal || !fits(p, j)) continue;
          if (byFeature && old.memory.feature != manifold.points[k].feature) continue;
          const float distance = distanceSq(manifold.points[k], old);
          if (distance < best || (byFeature && match == kNone)) best = distance, match = j;
        }
        if (match != kNone) step_.oldTaken[match] = 1;
      }
    }
  }

  void matchPoints() {
    step_.match.assign(step_.patches.size() * kMaxManifoldPoints, kNone);
    if (step_.oldPoints.empty()) return;
    const auto sameEntry = [&](uint32_t p, uint32_t j) {
      return step_.continues[p] && step_.oldEntry[j] == step_.entryOf[p];
    };
    const auto anyEntry = [](uint32_t, uint32_t) { return true; };
    matchEach(true, rows::kInfinity, sameEntry);
    matchEach(false, kNearPoint * smallerSize(a(), b()), anyEntry);
    // A fast body's points are far from where they were, and yet they carry what those carried.
    matchEach(false, rows::kInfinity, sameEntry);
  }

  void fillEntry(PairData& pair, uint32_t p) {
    const SurfacePatch& patch = step_.patches[p];
    const ShapeData &shapeA = world_.shapes[pair.shapeA], &shapeB = world_.shapes[pair.shapeB];
    const ShapeData& surface = surfaceIsA_ ? shapeA : shapeB;
    const Material& own = surface.materials.empty() ? surface.material : surface.materials[patch.material];
    pair.origin = a().position;
    pair.manifold = patch.manifold;
    pair.element = patch.element;
    pair.material = patch.material;
    combineMaterials(pair, surfaceIsA_ ? own : shapeA.material, surfaceIsA_ ? shapeB.material : own);
    if (!step_.continues[p]) pair.turn = pair.torque = Vec3{};
    KnownPoint known[kMaxManifoldPoints];
    for (uint32_t k = 0; k < kMaxManifoldPoints; ++k) {
      const uint32_t match = step_.match[p * kMaxManifoldPoints + k];
      if (match == kNone) continue;
      const OldPoint& old = step_.oldPoints[match];
      known[k] = {&old.memory, &old.basis};
    }
    if (step_.substep == 0) pair.mean = kNone;
    rememberPoints(world_, pair, known);
    for (int k = 0; step_.substep > 0 && k < pair.pointCount; ++k) {
      const uint32_t match = step_.match[p * kMaxManifoldPoints + static_cast<uint32_t>(k)];
      continueForce(world_, pair, k, match != kNone ? &step_.oldPoints[match] : nullptr);
    }
    if (!step_.continues[p]) beginSlide(world_, step_, pair, {});
  }

  /// Where others go on, its manifold is not the latest any more.
  void closeEntry(PairData& pair) const {
    forgetContact(world_, step_, pair);
    if (!step_.patches.empty()) pair.manifold.normal = {};
  }

  void inheritForces() {
    for (uint32_t j = 0; j < step_.oldPoints.size(); ++j)
      if (!step_.oldTaken[j]) inheritForce(world_, world_.pairs[begin_ + step_.oldEntry[j]], step_.oldPoints[j]);
  }

  WorldData& world_;
  StepData& step_;
  size_t begin_, size_;
  const PairData head_;
  bool surfaceIsA_ = false;
};

}  // namespace

void findPatches(WorldData& world, StepData& step, size_t begin, size_t end) {
  Run run(world, step, begin, end);
  run.collide(run.now());
  run.fill();
}

void findPatches(WorldData& world, StepData& step, size_t begin, size_t end, const NearPair& near) {
  Run run(world, step, begin, end);
  run.collide(near);
  run.fill();
}

void lengthenRuns(WorldData& world, StepData& step) { world.pairs.insert(step.overflow); }

}  // namespace avbd
