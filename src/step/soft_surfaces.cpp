// Places of soft bodies, and faces that come near each other (soft_surfaces.h).
#include "step/soft_surfaces.h"

#include <algorithm>
#include <tuple>

#include "avbd/rows/math.h"
#include "geom/soft_mesh_parts.h"
#include "step/free_motion.h"
#include "step/step_data.h"
#include "world/mass.h"
#include "world/soft.h"

namespace avbd {

float touchMargin(const WorldData& world) { return kSpeculative * world.def.lengthUnit; }

PlaceShift shiftOf(const SoftPlace& a, const SoftPlace& b) { return {toFloat(b.origin - a.origin), b.drift - a.drift}; }

namespace {

/// Its way if nothing but gravity acts.
Vec3 freeWay(const WorldData& world, const BodyData& body, float h) {
  if (body.asleep) return {};
  return unlocked((body.linearVelocity + world.def.gravity * (body.gravityScale * h)) * h, body.locks);
}

/// Of faces and edges from those of their points.
void boxFeatures(const SoftMeshData& mesh, SoftPlace& place) {
  const auto faces = mesh.surface();
  const auto& edges = mesh.parts().features.edges;
  place.faces.resize(faces.size()), place.edgeBoxes.resize(edges.size());
  const auto box = [&](uint32_t point) -> const Aabb& { return place.pointBoxes[point]; };
  for (size_t f = 0; f < faces.size(); ++f)
    place.faces[f] = merge(merge(box(faces[f][0]), box(faces[f][1])), box(faces[f][2]));
  for (size_t e = 0; e < edges.size(); ++e) place.edgeBoxes[e] = merge(box(edges[e][0]), box(edges[e][1]));
  mesh.faceTree().refit(place.faces, place.bounds);
}

float growth(const WorldData& world, const SoftData& soft) { return soft.radius + 0.5f * touchMargin(world); }

/// All that a point passes over.
Aabb pointBox(const SoftPlace& place, size_t point, float by) {
  const Vec3 start = place.points[point], end = start + place.ways[point];
  return grown({lesser(start, end), greater(start, end)}, by);
}

void boxPoints(const SoftMeshData& mesh, float by, SoftPlace& place) {
  place.pointBoxes.resize(place.points.size());
  for (size_t i = 0; i < place.points.size(); ++i) place.pointBoxes[i] = pointBox(place, i, by);
  boxFeatures(mesh, place);
}

void findNormals(const SoftMeshData& mesh, SoftPlace& place) {
  const auto faces = mesh.surface();
  place.normals.resize(faces.size()), place.endNormals.resize(faces.size());
  for (size_t f = 0; f < faces.size(); ++f) {
    const auto start = [&](size_t k) { return place.points[faces[f][k]]; };
    const auto end = [&](size_t k) { return start(k) + place.ways[faces[f][k]]; };
    place.normals[f] = unitNormal(start(0), start(1), start(2));
    place.endNormals[f] = unitNormal(end(0), end(1), end(2));
  }
}

template <class WayOf>
void place(const WorldData& world, const SoftData& soft, SoftPlace& out, WayOf&& wayOf) {
  const size_t count = soft.bodies.size();
  out.origin = world.bodies[soft.bodies[0]].position;
  out.points.resize(count), out.ways.resize(count);
  Vec3 sum;
  float fastest = 0;
  for (size_t i = 0; i < count; ++i) {
    out.points[i] = toFloat(world.bodies[soft.bodies[i]].position - out.origin);
    const Vec3 way = out.ways[i] = wayOf(soft.bodies[i]);
    sum = sum + way;
    fastest = std::max(fastest, dot(way, way));
  }
  out.drift = sum * (1 / static_cast<float>(count));
  for (Vec3& way : out.ways) way = way - out.drift;
  out.fastest = rows::sqrt(fastest);
  boxPoints(*soft.mesh, growth(world, soft), out);
  findNormals(*soft.mesh, out);
}

template <class WayOf>
void placeAll(const WorldData& world, StepData& step, WayOf&& wayOf) {
  step.softs.places.resize(world.softs.size());
  world.softIds.forEach([&](uint32_t slot) { place(world, world.softs[slot], step.softs.places[slot], wayOf); });
}

/// Bodies by their lower ends along x.
void sweep(const WorldData& world, SoftSurfaces& s) {
  s.ends.clear(), s.pairs.clear();
  world.softIds.forEach([&](uint32_t slot) {
    const SoftPlace& place = s.places[slot];
    const Aabb box = swept(place.bounds[0], place.drift);
    s.ends.push_back({place.origin.x + double{box.lower.x}, place.origin.x + double{box.upper.x}, slot});
  });
  std::sort(s.ends.begin(), s.ends.end(), [](const SoftSurfaces::Ends& a, const SoftSurfaces::Ends& b) {
    return std::tie(a.lower, a.slot) < std::tie(b.lower, b.slot);
  });
  for (size_t i = 0; i < s.ends.size(); ++i)
    for (size_t k = i + 1; k < s.ends.size() && s.ends[k].lower <= s.ends[i].upper; ++k) {
      const uint32_t a = std::min(s.ends[i].slot, s.ends[k].slot), b = std::max(s.ends[i].slot, s.ends[k].slot);
      if (isAsleep(world, world.softs[a]) && isAsleep(world, world.softs[b])) continue;
      if (overlaps(s.places[a].bounds[0], shiftOf(s.places[a], s.places[b]).of(s.places[b].bounds[0])))
        s.pairs.push_back({a, b});
    }
  std::sort(s.pairs.begin(), s.pairs.end());
}

constexpr float kBeside = 3;  ///< sizes of faces: within that at rest two may lie beside each other

/// Leaves out what lies beside each other where the surface turns as one.
void nearWithin(const SoftData& soft, const SoftPlace& place, uint32_t slot, std::vector<NearFaces>& near) {
  const SurfaceAtRest& rest = soft.mesh->parts().atRest;
  const auto faces = soft.mesh->surface();
  const float size = kBeside * soft.mesh->faceSize();
  const bool isCloth = soft.mesh->isCloth();
  const auto skip = [&](uint32_t a, uint32_t b) {
    return rest.nodesAreBeside(a, b, size) && nodesTurnAsOne(place.turns, a, b);
  };
  soft.mesh->faceTree().pairs({place.faces, place.bounds, {}, {}}, skip, [&](uint32_t a, uint32_t b) {
    if (!rest.areBeside(a, b, size, isCloth) || !turnAsOne(place.turns, faces[a][0], faces[b][0]))
      near.push_back({slot, slot, a, b});
  });
}

}  // namespace

Vec3 solvedWay(const WorldData& world, const StepData& step, uint32_t body) {
  return toFloat(step.end[step.endOf[body]].position - world.bodies[body].position);
}

void placeSofts(const WorldData& world, StepData& step) {
  placeAll(world, step, [&](uint32_t body) { return freeWay(world, world.bodies[body], step.h); });
}

namespace {

constexpr float kUsed = 0.75f;  ///< of the radius: how far beyond what is thought a point may go

/// Where it goes now.
Vec3 wayOf(const WorldData& world, const StepData& step, uint32_t body) {
  if (world.bodies[body].asleep) return {};
  return step.softs.ways.empty() ? solvedWay(world, step, body) : step.softs.ways[body];
}

}  // namespace

void placeSolvedSofts(const WorldData& world, StepData& step) {
  step.softs.ways.clear();
  placeAll(world, step, [&](uint32_t body) { return wayOf(world, step, body); });
}

bool takeSolvedWays(const WorldData& world, StepData& step) {
  step.softs.ways.clear();
  bool within = true;
  world.softIds.forEach([&](uint32_t slot) {
    SoftPlace& place = step.softs.places[slot];
    const SoftData& soft = world.softs[slot];
    // Bounds were grown by more than this, so that those of two that do not overlap leave a gap.
    const float slack = kUsed * soft.radius;
    const auto inside = [&](float way, float thought) {
      return way >= std::min(thought, 0.0f) - slack && way <= std::max(thought, 0.0f) + slack;
    };
    for (size_t i = 0; i < soft.bodies.size(); ++i) {
      const Vec3 way = wayOf(world, step, soft.bodies[i]) - place.drift, thought = place.ways[i];
      within = within && inside(way.x, thought.x) && inside(way.y, thought.y) && inside(way.z, thought.z);
      place.ways[i] = way;
    }
    if (within && soft.selfContact && !place.tangled && !isAsleep(world, soft))
      within = turnsAsThought(*soft.mesh, place, place.turns, step.softs.turnScratch);
  });
  return within;
}

namespace {

/// Faces of all bodies that a face comes near.
void nearFace(const WorldData& world, SoftSurfaces& s, uint32_t slot, uint32_t face) {
  const SoftPlace& place = s.places[slot];
  world.softIds.forEach([&](uint32_t other) {
    if (other == slot && (!world.softs[slot].selfContact || place.tangled)) return;
    const Aabb box = shiftOf(s.places[other], place).of(place.faces[face]);
    world.softs[other].mesh->faceTree().query(s.places[other].bounds, box, [&](uint32_t near) {
      if (!overlaps(s.places[other].faces[near], box)) return;
      if (slot < other || (slot == other && face < near)) s.near.push_back({slot, other, face, near});
      if (other < slot || (slot == other && near < face)) s.near.push_back({other, slot, near, face});
    });
  });
}

}  // namespace

void takeWays(const WorldData& world, StepData& step, const std::vector<std::array<uint32_t, 2>>& points) {
  SoftSurfaces& s = step.softs;
  std::vector<std::vector<uint8_t>>& touched = s.moved;
  touched.resize(world.softs.size());
  for (std::vector<uint8_t>& ofSoft : touched) ofSoft.clear();
  for (const auto& [slot, point] : points) {
    SoftPlace& place = s.places[slot];
    const SoftData& soft = world.softs[slot];
    place.ways[point] = wayOf(world, step, soft.bodies[point]) - place.drift;
    place.pointBoxes[point] = merge(place.pointBoxes[point], pointBox(place, point, growth(world, soft)));
    touched[slot].resize(soft.bodies.size());
    touched[slot][point] = 1;
  }
  s.near.clear();
  for (uint32_t slot = 0; slot < touched.size(); ++slot)
    if (!touched[slot].empty()) boxFeatures(*world.softs[slot].mesh, s.places[slot]);
  for (uint32_t slot = 0; slot < touched.size(); ++slot) {
    if (touched[slot].empty()) continue;
    const auto faces = world.softs[slot].mesh->surface();
    for (uint32_t f = 0; f < faces.size(); ++f)
      if (touched[slot][faces[f][0]] || touched[slot][faces[f][1]] || touched[slot][faces[f][2]])
        nearFace(world, s, slot, f);
  }
  std::sort(s.near.begin(), s.near.end());
  s.near.erase(std::unique(s.near.begin(), s.near.end()), s.near.end());
}

namespace {

float volumeOf(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return dot(cross(b - a, c - a), d - a); }

bool passesThrough(const SoftPlace& place, uint32_t from, uint32_t to, const FaceTree::Face& face) {
  if (from == face[0] || from == face[1] || from == face[2] || to == face[0] || to == face[1] || to == face[2])
    return false;
  const Vec3 p = place.points[from], q = place.points[to];
  const Vec3 a = place.points[face[0]], b = place.points[face[1]], c = place.points[face[2]];
  if ((volumeOf(a, b, c, p) > 0) == (volumeOf(a, b, c, q) > 0)) return false;
  const float u = volumeOf(p, q, a, b), v = volumeOf(p, q, b, c), w = volumeOf(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

/// A solid is flat or inside out as a whole.
bool isInsideOut(const SoftMeshData& mesh, const SoftPlace& place) {
  float volume = 0;
  for (const auto& t : mesh.tets())
    volume += volumeOf(place.points[t[0]], place.points[t[1]], place.points[t[2]], place.points[t[3]]);
  return !(volume > 0);
}

/// The surface of a solid passes through itself as the step begins, as it does after its points were set so: then it
/// has to come back before it can touch itself.
bool isTangled(const SoftMeshData& mesh, const SoftPlace& place, std::span<const NearFaces> near) {
  if (isInsideOut(mesh, place)) return true;
  const auto faces = mesh.surface();
  for (const NearFaces& pair : near)
    for (const auto& [through, face] :
         {std::pair{faces[pair.faceA], faces[pair.faceB]}, std::pair{faces[pair.faceB], faces[pair.faceA]}})
      for (size_t k = 0; k < 3; ++k)
        if (passesThrough(place, through[k], through[(k + 1) % 3], face)) return true;
  return false;
}

}  // namespace

void findNearFaces(const WorldData& world, SoftSurfaces& s) {
  sweep(world, s);
  s.near.clear();
  for (const std::array<uint32_t, 2>& pair : s.pairs) {
    const uint32_t a = pair[0], b = pair[1];
    const SoftData &softA = world.softs[a], &softB = world.softs[b];
    const Aabb shift = shiftOf(s.places[a], s.places[b]).of({});
    softA.mesh->faceTree().pairs({s.places[a].faces, s.places[a].bounds, {}, {}}, softB.mesh->faceTree(),
                                 {s.places[b].faces, s.places[b].bounds, shift.lower, shift.upper},
                                 [&](uint32_t faceA, uint32_t faceB) {
                                   s.near.push_back({a, b, faceA, faceB});
                                 });
  }
  world.softIds.forEach([&](uint32_t slot) {
    const SoftData& soft = world.softs[slot];
    if (!soft.selfContact || isAsleep(world, soft)) return;
    SoftPlace& place = s.places[slot];
    const size_t before = s.near.size();
    findTurns(*soft.mesh, place, s.turnScratch, place.turns);
    nearWithin(soft, place, slot, s.near);
    place.tangled = !soft.mesh->isCloth() && isTangled(*soft.mesh, place, std::span(s.near).subspan(before));
    if (place.tangled) s.near.resize(before);
  });
}

}  // namespace avbd
