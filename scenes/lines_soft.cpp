// Acceptance, soft bodies: elasticity against theory, laws of motion, shapes that come back.
#include <algorithm>
#include <cmath>

#include "scenes/catalogue.h"
#include "scenes/soft_lines.h"

namespace avbd::scenes {

double sagOfBeam(const Settings& settings, int across, double nu, double seconds, float dt, SolidModel model) {
  constexpr double kSag = 0.04, kThick = 0.1;
  const double e = 1.5 * double{kSoftDensity} * double{kGravity} / (kSag * kThick * kThick);
  const double kappa = 10 * (1 + nu) / (12 + 11 * nu);
  const double shear = 4 * 2 * (1 + nu) * kThick * kThick / (12 * kappa);
  Soft soft(settings, {}, {0.5f, 0.05f, 0.05f}, {8 * across, across, across},
            {.youngsModulus = static_cast<float>(e),
             .poissonRatio = static_cast<float>(nu),
             .density = kSoftDensity,
             .model = model});
  soft.dt = dt;
  soft.each([&](BodyId p, Vec3 rest) {
    if (rest.x < -0.4999f) soft.world.setLocks(p, kLockLinearX | kLockLinearY | kLockLinearZ);
  });
  soft.run(seconds);
  const double sunk = soft.mean([](Vec3 rest) { return rest.x > 0.4999f; },
                                [](Vec3d now, Vec3 rest) { return double{rest.y} - now.y; });
  return sunk / (kSag * (1 + shear));
}

namespace {

std::vector<Figure> freeFall(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float e : {1e3f, 1e4f, 1e5f, 1e6f}) {
    Soft soft(settings, {}, {0.25f, 0.25f, 0.25f}, {4, 4, 4}, {.youngsModulus = e});
    double worst = 0, mass = 0;
    for (const BodyId p : soft.particles) mass += double{soft.world.mass(p)};
    for (int i = 1; i <= 60; ++i) {
      const double before = soft.world.momentum().y;
      soft.world.step(soft.dt);
      const double rate = (soft.world.momentum().y - before) / (mass * double{soft.dt});
      worst = std::max(worst, std::fabs(rate / -9.81 - 1));
    }
    figures.push_back(atMost("acceleration_error", worst, 1e-4, "of g", "E=" + text(double{e})));
  }
  return figures;
}

std::vector<Figure> spin(const Settings& settings) {
  Soft soft(settings, weightless(), {0.25f, 0.25f, 0.25f}, {4, 4, 4}, {.youngsModulus = 1e5f},
            {.linear = {}, .angular = {0, 2, 0}});
  const double before = soft.world.angularMomentum().y;
  soft.run(5);
  return {within("angular_momentum", soft.world.angularMomentum().y / before, 1, 0.01, "of the first")};
}

/// The energy's own law of a bar: nominal stress [of E] at a stretch y along, with no stress sideways:
/// mu (1 - y) + lambda (J - 1) y = 0.
double stressOfBar(double y, double nu) {
  const double mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu)) + mu;
  const double volume = 1 + mu * (y - 1) / (lambda * y);
  return mu * (y - volume / (y * y));
}

/// How much longer a bar of 1 m becomes that hangs, where Hooke would have it longer by `stretch`.
double stretchByTheory(double stretch, double nu) {
  constexpr int kSlices = 200;
  double sum = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double stress = 2 * stretch * (i + 0.5) / kSlices;
    double low = 1, high = 1.5;
    while (high - low > 1e-12) (stressOfBar((low + high) / 2, nu) < stress ? low : high) = (low + high) / 2;
    sum += (low - 1) / kSlices;
  }
  return sum;
}

/// How much longer a bar of 1 m becomes under its own weight, of what theory says.
double stretchOfBar(const Settings& settings, int across, SolidModel model = SolidModel::NeoHookean) {
  constexpr float kStretch = 0.01f;
  constexpr float kE = kSoftDensity * kGravity / (2 * kStretch);
  Soft soft(settings, {}, {0.05f, 0.5f, 0.05f}, {across, 8 * across, across},
            {.youngsModulus = kE, .density = kSoftDensity, .model = model});
  bool first = true;
  soft.each([&](BodyId p, Vec3 rest) {
    if (rest.y < 0.4999f) return;
    soft.world.setLocks(p, first ? kLockLinearX | kLockLinearY | kLockLinearZ : kLockLinearY);
    first = false;
  });
  soft.run(10);
  const double sunk = soft.mean([](Vec3 rest) { return rest.y < -0.4999f; },
                                [](Vec3d now, Vec3 rest) { return double{rest.y} - now.y; });
  // A co-rotational bar that nothing turns is Hooke's own.
  return sunk / (model == SolidModel::Corotational ? double{kStretch} : stretchByTheory(double{kStretch}, 0.3));
}

/// What searches leave of a displacement.
constexpr double kSearched = 0.001;

/// Three resolutions: within the bound at the finest, and nearer with each.
template <class F>
std::vector<Figure> converging(const std::array<int, 3>& resolutions, F&& ratioOf) {
  std::vector<Figure> figures;
  double before = 0;
  for (size_t i = 0; i < 3; ++i) {
    const double ratio = ratioOf(resolutions[i]), error = std::fabs(ratio - 1);
    const std::string params = "across=" + text(resolutions[i]);
    if (i > 0) figures.push_back(holds("nearer", error < std::max(before, kSearched), params));
    if (i == 2)
      figures.push_back(within("of_theory", ratio, 1, 0.03, "", params));
    else
      figures.push_back(within("of_theory", ratio, 1, 1, "", params));
    before = error;
  }
  return figures;
}

std::vector<Figure> bar(const Settings& settings) {
  return converging({1, 2, 3}, [&](int across) { return stretchOfBar(settings, across); });
}

std::vector<Figure> cantilever(const Settings& settings) {
  return converging({1, 2, 4}, [&](int across) { return sagOfBeam(settings, across); });
}

constexpr float kPressed = 0.9f;

/// A cube between two plates that are 10 % nearer than it is high.
struct PressedCube {
  Soft soft;
  double strain = 0;  ///< sideways

  PressedCube(const Settings& settings, const SoftMaterial& material)
      : soft(settings, weightless(), {0.25f, 0.25f, 0.25f}, {4, 4, 4}, material) {
    bool first = true;
    soft.each([&](BodyId p, Vec3 rest) {
      soft.world.setPose(p, {{double{rest.x}, double{rest.y * kPressed}, double{rest.z}}, {}});
      if (std::fabs(rest.y) < 0.2499f) return;
      soft.world.setLocks(p, first ? kLockLinearX | kLockLinearY | kLockLinearZ : kLockLinearY);
      first = false;
    });
    soft.run(4);
    strain = (side(1) - side(-1)) / 0.5 - 1;
  }
  double side(float sign) const {
    return soft.mean([&](Vec3 rest) { return rest.x * sign > 0.2499f; }, [](Vec3d now, Vec3) { return now.x; });
  }
};

/// Sideways strain by the energy's own formula: no stress sideways is mu (1 - y) + lambda (J - 1) y = 0 of the stretch
/// y along and J = y s^2.
std::vector<Figure> poisson(const Settings& settings) {
  std::vector<Figure> figures;
  for (const float nu : {0.1f, 0.3f, 0.45f, 0.49f, 0.4999f}) {
    const PressedCube cube(settings, {.youngsModulus = 1e5f, .poissonRatio = nu});
    const double n = double{nu}, y = double{kPressed}, mu = 1 / (2 * (1 + n)),
                 lambda = n / ((1 + n) * (1 - 2 * n)) + mu;
    const double volume = 1 - mu * (1 - y) / (lambda * y), expected = std::sqrt(volume / y) - 1;
    figures.push_back(within("sideways", cube.strain / expected, 1, 0.03, "of theory", "nu=" + text(n)));
    if (nu >= 0.49f)
      figures.push_back(within("volume", cube.soft.world.volume(cube.soft.id) / cube.soft.mesh->volume(), volume,
                               nu < 0.4999f ? 0.01 : 0.001, "of rest", "nu=" + text(n)));
  }
  return figures;
}

std::vector<Figure> independence(const Settings& settings) {
  double least = 1e9, most = 0;
  const auto add = [&](const Settings& with, float dt) {
    const double sag = sagOfBeam(with, 2, 0.3, 6, dt);
    least = std::min(least, sag), most = std::max(most, sag);
  };
  for (const int iterations : {5, 10, 20}) {
    Settings with = settings;
    with.iterations = iterations;
    add(with, 1.0f / 60);
  }
  for (const float rate : {30.0f, 120.0f, 240.0f}) add(settings, 1 / rate);
  return {atMost("apart", most / least - 1, 0.03, "", "iterations 5, 10, 20; dt 1/30 .. 1/240")};
}

/// The worst of the tetrahedra's edges against rest, after the shape was spoilt and left alone.
double comesBack(const Settings& settings, SolidModel model, const std::function<Vec3(Vec3)>& spoilt) {
  Soft soft(settings, weightless(), {0.25f, 0.25f, 0.25f}, {3, 3, 3}, {.youngsModulus = 1e5f, .model = model});
  soft.each([&](BodyId p, Vec3 rest) { soft.world.setPose(p, {toDouble(spoilt(rest)), {}}); });
  soft.run(10);
  double worst = 0;
  for (const auto& tet : soft.mesh->tets())
    for (size_t i = 0; i < 4; ++i)
      for (size_t k = 0; k < i; ++k) {
        const Vec3 rest = soft.mesh->points()[tet[i]] - soft.mesh->points()[tet[k]];
        const Vec3 now = toFloat(soft.at(soft.particles[tet[i]]) - soft.at(soft.particles[tet[k]]));
        worst = std::max(worst, double{std::fabs(length(now) / length(rest) - 1)});
      }
  return worst;
}

Figure flattened(const Settings& settings, SolidModel model) {
  const auto spoilt = [](Vec3 p) { return Vec3{p.x, 0, p.z}; };
  return atMost("strain", comesBack(settings, model, spoilt), 0.01, "", "flattened");
}

Figure mirrored(const Settings& settings, SolidModel model) {
  const auto spoilt = [](Vec3 p) { return Vec3{p.x, -p.y, p.z}; };
  return atMost("strain", comesBack(settings, model, spoilt), 0.01, "", "mirrored");
}

/// Points anywhere within `size` of where a share of their place has them.
Figure scrambled(const Settings& settings, SolidModel model, float share, float size, const std::string& what) {
  Draws draws(7);
  const auto spoilt = [&](Vec3 p) { return p * share + Vec3{draws.next(), draws.next(), draws.next()} * size; };
  return atMost("strain", comesBack(settings, model, spoilt), 0.01, "", what);
}

std::vector<Figure> inverted(const Settings& settings) {
  constexpr SolidModel kModel = SolidModel::NeoHookean;
  return {flattened(settings, kModel), mirrored(settings, kModel), scrambled(settings, kModel, 0, 0.25f, "scrambled")};
}

/// Hooke's law at any strain.
std::vector<Figure> corotational(const Settings& settings) {
  constexpr SolidModel kModel = SolidModel::Corotational;
  std::vector<Figure> figures;
  figures.push_back(within("stretch", stretchOfBar(settings, 2, kModel), 1, 0.02, "of theory", "bar, across=2"));
  for (const double nu : {0.3, 0.45})
    figures.push_back(within("sag", sagOfBeam(settings, 4, nu, 6, 1.0f / 60, kModel), 1, 0.05, "of theory",
                             "beam, across=4, nu=" + text(nu)));
  for (const float nu : {0.1f, 0.3f, 0.45f, 0.48f}) {
    const PressedCube cube(settings, {.youngsModulus = 1e5f, .poissonRatio = nu, .model = kModel});
    figures.push_back(within("sideways", cube.strain / double{nu * (1 - kPressed)}, 1, 0.03, "of theory",
                             "cube, nu=" + text(double{nu})));
  }
  Soft turning(settings, weightless(), {0.25f, 0.25f, 0.25f}, {4, 4, 4}, {.youngsModulus = 1e5f, .model = kModel},
               {.linear = {}, .angular = {0, 2, 0}});
  const double before = turning.world.angularMomentum().y;
  turning.run(5);
  figures.push_back(
      within("angular_momentum", turning.world.angularMomentum().y / before, 1, 0.01, "of the first", "cube"));
  figures.push_back(flattened(settings, kModel));
  figures.push_back(mirrored(settings, kModel));
  // By the width of a cell: from anywhere in the cube a corner may stay within it, where the energy has a minimum.
  figures.push_back(scrambled(settings, kModel, 1, 0.16f, "scrambled by a cell"));
  return figures;
}

/// Points of one body within tetrahedra of another.
int pointsInside(const World& world, SoftId of, SoftId in) {
  const auto mesh = world.mesh(in);
  std::vector<Vec3d> points(world.mesh(of)->points().size()), corners(mesh->points().size());
  world.getPoints(of, points), world.getPoints(in, corners);
  const auto side = [](Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
    const Vec3d u = b - a, v = c - a;
    return dot(Vec3d{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x}, p - a);
  };
  int count = 0;
  for (const Vec3d& p : points)
    for (const auto& t : mesh->tets()) {
      const Vec3d a = corners[t[0]], b = corners[t[1]], c = corners[t[2]], d = corners[t[3]];
      if (side(a, b, c, p) > 0 && side(a, c, d, p) > 0 && side(a, d, b, p) > 0 && side(b, d, c, p) > 0) {
        ++count;
        break;
      }
    }
  return count;
}

double weightOnGround(const World& world, BodyId ground) {
  double force = 0;
  for (const Contact& contact : world.contacts())
    if (contact.bodyA == ground || contact.bodyB == ground)
      for (int i = 0; i < contact.pointCount; ++i) force += double{contact.points[static_cast<size_t>(i)].normalForce};
  return force;
}

/// Something soft stands on something, and all of it on the ground.
struct Stack {
  Build build;
  BodyId ground;
  std::vector<SoftId> softs;
  double mass = 0;

  Stack(const Settings& settings) : build("stack_soft", settings), ground(build.ground()) {}
  void soft(Vec3 half, std::array<int, 3> cells, double y, SoftMaterial material) {
    softs.push_back(build.world().create(SoftDef{
        .mesh = makeTetBox(half, cells[0], cells[1], cells[2]), .pose = {{0, y, 0}, {}}, .material = material}));
    for (const BodyId p : build.world().particles(softs.back())) mass += double{build.world().mass(p)};
  }
  void rigid(Box half, double y, float kilograms) {
    build.box("box", half, {0, y, 0}, kilograms);
    mass += double{kilograms};
  }
  std::vector<Figure> settle(const char* what) {
    World& world = build.world();
    int inside = 0;
    double weight = 0;
    for (int i = 0; i < 360; ++i) {
      world.step(1.0f / 60);
      for (const SoftId a : softs)
        for (const SoftId b : softs)
          if (a != b && i % 4 == 0) inside += pointsInside(world, a, b);
      if (i == 60) weight = weightOnGround(world, ground);
    }
    double deepest = 0, farthest = 0;
    for (const SoftId id : softs)
      for (const BodyId p : world.particles(id)) {
        deepest = std::max(deepest, double{world.radius(id)} - world.pose(p).position.y);
        farthest = std::max(farthest, std::hypot(world.pose(p).position.x, world.pose(p).position.z));
      }
    return {atMost("points_inside", inside, 0, "", what), atMost("depth", deepest, 0.002, "m", what),
            atMost("aside", farthest, 0.6, "m", what),
            within("weight", weight / (mass * double{kGravity}), 1, 0.01, "of all", what)};
  }
};

std::vector<Figure> stackSoft(const Settings& settings) {
  const SoftMaterial rubber{.youngsModulus = 1e6f, .density = 400};
  const Vec3 half{0.25f, 0.25f, 0.25f};
  std::vector<Figure> figures;
  const auto add = [&](std::vector<Figure> more) { figures.insert(figures.end(), more.begin(), more.end()); };
  Stack five(settings);
  for (int i = 0; i < 5; ++i) five.soft(half, {4, 4, 4}, 0.262 + 0.522 * i, rubber);
  add(five.settle("five soft cubes"));
  Stack loaded(settings);
  loaded.soft({0.3f, 0.3f, 0.3f}, {5, 5, 5}, 0.312, rubber);
  loaded.rigid({0.3f, 0.3f, 0.3f}, 0.935, 432);
  add(loaded.settle("432 kg on a soft cube"));
  Stack tower(settings);
  for (int i = 0; i < 3; ++i) tower.rigid({0.3f, 0.2f, 0.3f}, 0.2 + 0.4 * i, 100);
  tower.soft(half, {4, 4, 4}, 1.462, rubber);
  add(tower.settle("a soft cube on a tower"));
  return figures;
}

}  // namespace

std::vector<Line> softLines() {
  std::vector<Line> lines{
      {"S", "free_fall", freeFall, ""},    {"S", "soft_spin", spin, ""},       {"S", "bar", bar, ""},
      {"S", "cantilever", cantilever, ""}, {"S", "poisson", poisson, ""},      {"S", "independence", independence, ""},
      {"S", "inverted", inverted, ""},     {"S", "stack_soft", stackSoft, ""}, {"S", "corotational", corotational, ""}};
  const std::vector<Line> more = materialLines();
  lines.insert(lines.end(), more.begin(), more.end());
  return lines;
}

}  // namespace avbd::scenes
