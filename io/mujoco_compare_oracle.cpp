// Comparing with MuJoCo: bodies, masses, poses and geoms of the same file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io/mjcf.h"
#include "io/mjcf_build.h"
#include "io/mjcf_mass.h"
#include "io/mjcf_stages.h"
#include "io/mujoco_compare.h"

namespace avbd::mjcf {

Loaded load(const std::string& file) {
  mju_user_warning = [](const char*) {};  // else it writes a log file where the test runs
  Loaded out;
  char error[1000] = "";
  out.model.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
  out.error = error;
  if (!out.model) return out;
  out.data.reset(mj_makeData(out.model.get()));
  mj_kinematics(out.model.get(), out.data.get());
  return out;
}

namespace {

/// A folder of this process alone: tests of several run at the same time.
struct OwnFolder {
  std::string path;
  OwnFolder() : path(testing::TempDir() + "avbd_mujoco_XXXXXX") { EXPECT_NE(mkdtemp(path.data()), nullptr); }
  ~OwnFolder() { std::filesystem::remove_all(path); }
};

}  // namespace

const std::string& folder() {
  static const OwnFolder own;
  return own.path;
}

std::string write(const std::string& text, const std::string& name) {
  const std::string path = folder() + '/' + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

void expectNear(Vec3d a, const mjtNum* b, double tolerance, const std::string& what) {
  EXPECT_NEAR(a.x, b[0], tolerance) << what;
  EXPECT_NEAR(a.y, b[1], tolerance) << what;
  EXPECT_NEAR(a.z, b[2], tolerance) << what;
}

namespace {

double scaleOf(const Sym3d& m) { return std::abs(m.xx) + std::abs(m.yy) + std::abs(m.zz) + 1e-12; }

void expectSameTurn(Quatd q, const mjtNum* m, double tolerance, const std::string& what) {
  const double cosine = std::abs(q.w * m[0] + q.x * m[1] + q.y * m[2] + q.z * m[3]);
  EXPECT_NEAR(cosine, 1, tolerance) << what;
}

void expectSame(const Sym3d& a, const Sym3d& b, double relative, const std::string& what) {
  const double tolerance = relative * scaleOf(b);
  EXPECT_NEAR(a.xx, b.xx, tolerance) << what;
  EXPECT_NEAR(a.yy, b.yy, tolerance) << what;
  EXPECT_NEAR(a.zz, b.zz, tolerance) << what;
  EXPECT_NEAR(a.xy, b.xy, tolerance) << what;
  EXPECT_NEAR(a.xz, b.xz, tolerance) << what;
  EXPECT_NEAR(a.yz, b.yz, tolerance) << what;
}

Mass massIn(const mjModel* m, int body) {
  const mjtNum *p = m->body_ipos + 3 * body, *q = m->body_iquat + 4 * body, *d = m->body_inertia + 3 * body;
  return {m->body_mass[body], {p[0], p[1], p[2]}, rotated({d[0], d[1], d[2]}, {q[0], q[1], q[2], q[3]})};
}

// How far points reach in a direction.
template <class Points, class Place>
double reach(const Points& points, Vec3d direction, const Place& place) {
  double out = -1e300;
  for (const auto& p : points) out = std::max(out, dot(direction, place(p)));
  return out;
}

Vec3d directionAt(int i) {
  // A spiral over the sphere.
  const double z = 1 - (2 * i + 1) / 100.0, turn = 2.399963 * i, r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// MuJoCo moves a mesh to its inertia frame and the geom back; what counts is where the vertices are.
void compareMeshes(const Geom& geom, const Description& d, const mjModel* m, int g) {
  ASSERT_EQ(m->geom_type[g], mjGEOM_MESH) << geom.where;
  const MeshAsset& mesh = d.meshes[static_cast<size_t>(geom.asset)];
  const int id = m->geom_dataid[g];
  const mjtNum *p = m->geom_pos + 3 * g, *q = m->geom_quat + 4 * g;
  const Posed theirPose{{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}};
  std::vector<Vec3d> theirs;
  for (int i = 0; i < m->mesh_vertnum[id]; ++i) {
    const float* v = m->mesh_vert + 3 * (m->mesh_vertadr[id] + i);
    theirs.push_back((theirPose * Posed{{v[0], v[1], v[2]}, {}}).position);
  }
  const auto place = [&](Vec3d v) { return (geom.pose * Posed{v, {}}).position; };
  double size = 0;
  for (const Vec3d& v : mesh.vertices) size = std::max(size, length(place(v)));
  for (const Vec3d& v : theirs) size = std::max(size, length(v));
  Notes notes;
  GeomShapes shapes(d, notes);
  const auto shape = shapes.shape(geom);
  ASSERT_TRUE(shape) << geom.where;
  const HullData& hull = *std::get<Hull>(shape->geometry).data;
  for (int i = 0; i < 100; ++i) {
    const Vec3d direction = directionAt(i);
    const double their = reach(theirs, direction, [](Vec3d v) { return v; });
    EXPECT_NEAR(reach(mesh.vertices, direction, place), their, 2e-6 * size) << geom.where;
    const double ours = reach(hull.vertices(), direction, [&](Vec3 v) { return place(toDouble(v)); });
    EXPECT_NEAR(ours, their, 2e-6 * size + hull.error()) << geom.where;
  }
}

// A primitive fitted to a mesh: the same solid, whatever the order of equal axes.
void compareFitted(const Geom& geom, const mjModel* m, int g) {
  const mjtNum *p = m->geom_pos + 3 * g, *q = m->geom_quat + 4 * g, *s = m->geom_size + 3 * g;
  const double tolerance = 1e-5 * (1 + length(geom.size));
  expectNear(geom.pose.position, p, tolerance, geom.where);
  const GeomKind kinds[] = {GeomKind::Plane,     GeomKind::HeightField, GeomKind::Sphere, GeomKind::Capsule,
                            GeomKind::Ellipsoid, GeomKind::Cylinder,    GeomKind::Box};
  ASSERT_EQ(kinds[m->geom_type[g]], geom.kind) << geom.where;
  const Vec3d theirSize{s[0], geom.kind == GeomKind::Sphere ? 0 : s[1],
                        geom.kind == GeomKind::Box || geom.kind == GeomKind::Ellipsoid ? s[2] : 0};
  const Sym3d ours = rotated(unitInertia(geom.kind, geom.size), geom.pose.rotation);
  const Sym3d theirs = rotated(unitInertia(geom.kind, theirSize), {q[0], q[1], q[2], q[3]});
  expectSame(ours, theirs, 1e-5, geom.where);
  EXPECT_NEAR(volume(geom.kind, geom.size), volume(geom.kind, theirSize), 1e-5 * volume(geom.kind, theirSize));
}

void compareGeoms(const Description& d, const mjModel* m, int index) {
  const Body& body = d.bodies[static_cast<size_t>(index)];
  ASSERT_EQ(static_cast<int>(body.geoms.size()), m->body_geomnum[index]) << body.where;
  for (size_t k = 0; k < body.geoms.size(); ++k) {
    const Geom& geom = body.geoms[k];
    const int g = m->body_geomadr[index] + static_cast<int>(k);
    EXPECT_EQ(geom.contype, m->geom_contype[g]) << geom.where;
    EXPECT_EQ(geom.conaffinity, m->geom_conaffinity[g]) << geom.where;
    EXPECT_EQ(geom.condim, m->geom_condim[g]) << geom.where;
    EXPECT_EQ(geom.priority, m->geom_priority[g]) << geom.where;
    EXPECT_EQ(geom.group, m->geom_group[g]) << geom.where;
    EXPECT_DOUBLE_EQ(geom.friction, m->geom_friction[3 * g]) << geom.where;
    EXPECT_DOUBLE_EQ(geom.torsional, m->geom_friction[3 * g + 1]) << geom.where;
    EXPECT_DOUBLE_EQ(geom.rolling, m->geom_friction[3 * g + 2]) << geom.where;
    if (geom.kind == GeomKind::Mesh) {
      compareMeshes(geom, d, m, g);
      continue;
    }
    if (geom.asset >= 0 && geom.kind != GeomKind::HeightField) {
      compareFitted(geom, m, g);
      continue;
    }
    expectNear(geom.pose.position, m->geom_pos + 3 * g, 1e-9, geom.where);
    expectSameTurn(geom.pose.rotation, m->geom_quat + 4 * g, 1e-12, geom.where);
    if (geom.kind == GeomKind::Plane || geom.kind == GeomKind::HeightField) continue;
    // MuJoCo keeps numbers that the shape has no use for.
    const bool one = geom.kind == GeomKind::Sphere,
               two = geom.kind == GeomKind::Capsule || geom.kind == GeomKind::Cylinder;
    const mjtNum* size = m->geom_size + 3 * g;
    const mjtNum used[3] = {size[0], one ? 0 : size[1], one || two ? 0 : size[2]};
    expectNear(geom.size, used, 1e-12, geom.where);
  }
}

// Layer one: everything but what meshes would add.
void compareParsed(const Description& d, const Loaded& mj) {
  const mjModel* m = mj.model.get();
  ASSERT_EQ(static_cast<int>(d.bodies.size()), m->nbody);
  EXPECT_EQ(static_cast<int>(d.nq), m->nq);
  EXPECT_EQ(static_cast<int>(d.nv), m->nv);
  EXPECT_DOUBLE_EQ(d.dt, m->opt.timestep);
  const std::vector<Posed> poses = worldPoses(d, {});
  for (int i = 0; i < m->nbody; ++i) {
    const Body& body = d.bodies[static_cast<size_t>(i)];
    const char* name = mj_id2name(m, mjOBJ_BODY, i);
    EXPECT_EQ(body.name, name ? name : "");
    EXPECT_EQ(body.parent, m->body_parentid[i]) << body.where;
    expectNear(poses[static_cast<size_t>(i)].position, mj.data->xpos + 3 * i, 1e-9, body.where);
    expectSameTurn(poses[static_cast<size_t>(i)].rotation, mj.data->xquat + 4 * i, 1e-12, body.where);
    compareGeoms(d, m, i);
    if (i == 0 || !body.massKnown) continue;
    const Mass theirs = massIn(m, i);
    // MuJoCo keeps vertices as float.
    const double tolerance = d.meshes.empty() ? 1e-9 : 2e-6;
    EXPECT_NEAR(body.mass.mass, theirs.mass, tolerance * (theirs.mass + 1e-9)) << body.where;
    if (theirs.mass == 0) continue;
    expectNear(body.mass.center, m->body_ipos + 3 * i, tolerance, body.where);
    expectSame(body.mass.inertia, theirs.inertia, d.meshes.empty() ? 1e-6 : 1e-5, body.where);
  }
  for (size_t k = 0; k < d.keys.size(); ++k) {
    mj_resetDataKeyframe(m, mj.data.get(), static_cast<int>(k));
    mj_kinematics(m, mj.data.get());
    if (d.keys[k].qpos.empty()) continue;
    const std::vector<Posed> at = worldPoses(d, d.keys[k].qpos);
    for (int i = 1; i < m->nbody; ++i) {
      expectNear(at[static_cast<size_t>(i)].position, mj.data->xpos + 3 * i, 1e-9, d.keys[k].where);
      expectSameTurn(at[static_cast<size_t>(i)].rotation, mj.data->xquat + 4 * i, 1e-12, d.keys[k].where);
    }
  }
}

Mass massOf(const World& world, BodyId id) {
  const SymMat3 s = world.inertia(id);
  return {world.mass(id), toDouble(world.centerOfMass(id)), {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz}};
}

// Layer two: what became a body of ours has the pose, mass, centre and inertia of all that was welded into it.
void compareModel(const std::string& file, const Description& d, const Loaded& mj) {
  const mjModel* m = mj.model.get();
  mj_resetData(m, mj.data.get());
  mj_kinematics(m, mj.data.get());
  MjcfOptions options;
  options.useKeyframe = false;
  const Model model = readMjcf(file, options);
  const Clusters clusters = clustersOf(d);
  size_t next = 0;
  for (int i = 0; i < m->nbody; ++i) {
    if (clusters.rootOf[static_cast<size_t>(i)] != i) continue;
    if (i == 0 && (model.bodies.empty() || model.bodies[0].name != "world")) continue;
    // Between several joints of a body stand bodies with a part of its mass, before it; at the file's poses their
    // frames are its own.
    std::vector<Mass> made;
    const bool jointed = clusters.linkOf[static_cast<size_t>(i)] == Clusters::Link::Jointed;
    const size_t stages = jointed ? stagesOf(d.bodies[static_cast<size_t>(i)]).size() : 1;
    for (size_t k = 0; k + 1 < stages; ++k) made.push_back(massOf(model.world, model.bodies.at(next++).id));
    ASSERT_LT(next, model.bodies.size());
    const NamedBody& ours = model.bodies[next++];
    const Pose pose = model.world.pose(ours.id);
    expectNear(pose.position, mj.data->xpos + 3 * i, 1e-9, ours.name);
    const Quatd q{pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
    expectSameTurn(q, mj.data->xquat + 4 * i, 1e-6, ours.name);
    if (model.world.type(ours.id) != BodyType::Dynamic) continue;
    std::vector<Mass> parts;
    for (int k = i; k < m->nbody; ++k) {
      if (clusters.rootOf[static_cast<size_t>(k)] != i) continue;
      const auto poseOf = [&](int b) {
        const mjtNum *p = mj.data->xpos + 3 * b, *r = mj.data->xquat + 4 * b;
        return Posed{{p[0], p[1], p[2]}, {r[0], r[1], r[2], r[3]}};
      };
      parts.push_back({m->body_mass[k], {}, {}});
      const Mass own = massIn(m, k);
      const Posed rel = inverse(poseOf(i)) * poseOf(k);
      parts.back() = {own.mass, rel.position + rotate(rel.rotation, own.center), rotated(own.inertia, rel.rotation)};
    }
    Mass total;
    for (const Mass& part : parts) total.mass += part.mass;
    for (const Mass& part : parts) total.center = total.center + part.center * (part.mass / total.mass);
    for (const Mass& part : parts) {
      total.inertia = total.inertia + part.inertia + pointInertia(part.mass, part.center - total.center);
    }
    made.push_back(massOf(model.world, ours.id));
    const Mass whole = sum(made);
    EXPECT_NEAR(whole.mass, total.mass, 1e-5 * total.mass) << ours.name;
    const mjtNum center[3] = {total.center.x, total.center.y, total.center.z};
    expectNear(whole.center, center, 1e-5 * (1 + length(total.center)), ours.name);
    expectSame(whole.inertia, total.inertia, stages > 1 ? 0.01 : 1e-5, ours.name);
  }
  EXPECT_EQ(next, model.bodies.size());
}

void weighAsBoxes(Description& d) {
  for (Body& body : d.bodies) {
    std::vector<Mass> parts;
    bool any = false;
    for (Geom& geom : body.geoms) {
      if (geom.kind == GeomKind::Mesh) {
        const MeshAsset& mesh = d.meshes[static_cast<size_t>(geom.asset)];
        const Mass& unit = geom.isShell ? mesh.shell : mesh.solid;
        const auto p = principal(unit.inertia).values;
        double box = 1;
        for (size_t i = 0; i < 3; ++i) {
          box *= std::sqrt(6 * (p[(i + 1) % 3] + p[(i + 2) % 3] - p[i]) / unit.mass);
        }
        geom.mass *= box / unit.mass;
        any = true;
      }
      parts.push_back(massOf(geom, d.meshes));
    }
    if (any) body.mass = sum(parts);
  }
}

}  // namespace

void compare(const std::string& file, MeshWeight weight) {
  const Loaded mj = load(file);
  ASSERT_TRUE(mj.model) << file << ": " << mj.error;
  Description d = parseFile(file);
  if (weight == MeshWeight::BoxOfInertia) weighAsBoxes(d);
  compareParsed(d, mj);
  if (weight == MeshWeight::Same && !testing::Test::HasFailure()) compareModel(file, d, mj);
}

}  // namespace avbd::mjcf
