// Masses of MJCF bodies: from geoms or inertial, then the compiler's bounds.
#include <algorithm>
#include <cmath>

#include "io/mjcf_mass.h"
#include "io/mjcf_parser.h"

namespace avbd::mjcf {

namespace {

// Those of the only geom that counts; what several together, or a mesh, have is a choice among equals.
std::optional<Quatd> axesOf(const Body& body, double groupFirst, double groupLast) {
  const Geom* only = nullptr;
  for (const Geom& geom : body.geoms) {
    if (geom.group < groupFirst || geom.group > groupLast) continue;
    if (only) return {};
    only = &geom;
  }
  if (!only) return Quatd{};
  return only->kind == GeomKind::Mesh ? std::nullopt : std::optional(only->pose.rotation);
}

}  // namespace

void Parser::finishMasses() {
  for (size_t i = 1; i < out_.bodies.size(); ++i) {
    finishMass(i);
    limitMass(i);
  }
  if (compiler_.setTotalMass > 0) scaleTotalMass();
}

void Parser::finishMass(size_t index) {
  Body& body = out_.bodies[index];
  const Inertial& inertial = inertials_[index];
  std::vector<Mass> parts;
  bool known = true, any = false;
  for (const Geom& geom : body.geoms) {
    if (geom.group < compiler_.groupFirst || geom.group > compiler_.groupLast) continue;
    parts.push_back(massOf(geom, out_.meshes));
    known = known && geom.massKnown;
    any = true;
  }
  const bool fromGeoms = compiler_.inertiaFromGeom == FromGeoms::Yes
                             ? any || !inertial.given
                             : compiler_.inertiaFromGeom == FromGeoms::Auto && !inertial.given;
  if (fromGeoms) {
    body.mass = sum(parts);
    body.massKnown = known;
    body.inertialAxes = axesOf(body, compiler_.groupFirst, compiler_.groupLast);
  } else if (inertial.given) {
    body.mass = inertial.mass;
    body.inertialAxes = inertial.axes;
  }
}

void Parser::limitMass(size_t index) {
  Body& body = out_.bodies[index];
  Mass& mass = body.mass;
  mass.mass = std::max(mass.mass, compiler_.boundMass);
  const bool checked = inertials_[index].given || compiler_.boundInertia > 0 || compiler_.balanceInertia;
  if (!checked) return;
  Principal p = principal(mass.inertia);
  for (double& value : p.values) value = std::max(value, compiler_.boundInertia);
  std::array<double, 3> v = p.values;
  std::sort(v.begin(), v.end());
  // Rounding may break a flat body's equality.
  if (v[0] + v[1] < v[2] * (1 - 1e-6)) {
    if (!compiler_.balanceInertia) {
      const Elem elem = inertials_[index].given ? inertials_[index].elem : bodyElems_[index];
      source_.fail(elem,
                   "inertia of the body: principal values A, B, C must satisfy A + B >= C "
                   "(or set balanceinertia in compiler)");
    }
    p.values.fill((v[0] + v[1] + v[2]) / 3);
  }
  mass.inertia = fromPrincipal(p.values, p.axes);
}

void Parser::scaleTotalMass() {
  double total = 0;
  for (const Body& body : out_.bodies) total += body.mass.mass;
  if (!(total > 0)) return;
  const double scale = compiler_.setTotalMass / total;
  for (Body& body : out_.bodies) {
    body.mass.mass *= scale;
    body.mass.inertia = body.mass.inertia * scale;
  }
}

}  // namespace avbd::mjcf
