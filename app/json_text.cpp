// The only place that knows the JSON library.
#include "app/json_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

// Names may hold bytes that are no UTF-8.
std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json boundsJson(const Bounds& bounds, Vec3d corner) {
  return bounds.empty() ? Json() : Json::array({corner.x, corner.y, corner.z});
}

// JSON has no infinity.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json coordinatesJson(const ModelInfo& info) {
  Json out = Json::array();
  for (const CoordinateInfo& c : info.coordinates) {
    out.push_back({{"name", c.name},
                   {"joint", c.joint},
                   {"unit", c.isAngle ? "rad" : "m"},
                   {"position", c.position},
                   {"lower", finite(c.lower)},
                   {"upper", finite(c.upper)},
                   {"max_velocity", finite(c.maxVelocity)}});
  }
  return out;
}

Json actuatorsJson(const ModelInfo& info) {
  Json out = Json::array();
  for (size_t i = 0; i < info.actuators.size(); ++i) {
    const Actuator& a = info.actuators[i];
    Json json{{"name", a.name}, {"coordinate", info.moved[i]}, {"gear", a.gear}, {"gain", a.gain}, {"bias", a.bias}};
    json["max_force"] = finite(a.maxForce);
    json["control"] = a.control;
    json["control_range"] =
        a.controlRange ? Json::array({finite((*a.controlRange)[0]), finite((*a.controlRange)[1])}) : Json();
    out.push_back(std::move(json));
  }
  return out;
}

Json probesJson(const ModelInfo& info) {
  Json out = Json::array();
  for (const ProbeInfo& p : info.probes) {
    out.push_back({{"name", p.name}, {"kind", p.kind}, {"dimension", p.dimension}, {"unit", p.unit}});
  }
  return out;
}

Json softsJson(const std::vector<SoftFigures>& softs) {
  Json out = Json::array();
  for (const SoftFigures& soft : softs) {
    out.push_back({{"name", soft.name},
                   {"cloth", soft.cloth},
                   {"particles", soft.particles},
                   {"elements", soft.elements},
                   {"volume", soft.volume},
                   {"strain_max", soft.strainMax}});
  }
  return out;
}

}  // namespace

std::string jsonText(const RunFigures& f) {
  Json json{{"scene", f.scene},
            {"bodies", f.bodies},
            {"statics", f.statics},
            {"shapes", f.shapes},
            {"joints", f.joints},
            {"probes", f.probes},
            {"contact_points", f.contactPoints},
            {"steps", f.steps},
            {"dt", f.dt},
            {"workers", f.workers},
            {"ms_median", f.msMedian},
            {"ms_p95", f.msP95},
            {"realtime_factor", f.realtimeFactor},
            {"penetration_max", f.penetrationMax},
            {"penetration_mean", f.penetrationMean},
            {"joint_gap_max", f.jointGapMax},
            {"joint_angle_max", f.jointAngleMax},
            {"limit_excess_max", f.limitExcessMax},
            {"limit_excess_angle_max", f.limitExcessAngleMax},
            {"kinetic_energy", f.kineticEnergy},
            {"finite", f.finite},
            {"hash", hashText(f.hash)}};
  if (!f.softs.empty()) {
    json["soft_bodies"] = softsJson(f.softs);
    json["soft_overlap_max"] = f.softContacts.overlapMax;
    json["soft_crossings"] = f.softContacts.crossings;
  }
  return text(json);
}

std::string jsonText(const bench::BenchRecord& r) {
  return text({{"scene", r.scene},
               {"engine", r.engine},
               {"workers", r.workers},
               {"ratio", r.ratio},
               {"bodies", r.bodies},
               {"iterations", r.iterations},
               {"steps", r.steps},
               {"ms_median", r.msMedian},
               {"ms_p95", r.msP95},
               {"penetration_max", r.penetrationMax},
               {"penetration_mean", r.penetrationMean},
               {"displacement_max", r.displacementMax},
               {"joint_gap_max", r.jointGapMax},
               {"check", r.check}});
}

std::string jsonText(const VerifyRecord& r) {
  Json json{{"list", r.list}, {"line", r.line}, {"figure", r.figure.name}, {"params", r.figure.params}};
  const bool skipped = r.status == "skipped";
  const auto value = [&](double v) { return skipped ? Json() : Json(v); };
  json["measured"] = value(r.figure.measured);
  json["lower"] = value(r.figure.lower);
  json["upper"] = value(r.figure.upper);
  json["unit"] = r.figure.unit;
  json["status"] = r.status;
  if (skipped) json["reason"] = r.reason;
  return text(json);
}

std::string jsonText(const ModelInfo& info) {
  const auto counts = [](const auto& all, const char* (*name)(size_t)) {
    Json json = Json::object();
    for (size_t i = 0; i < all.size(); ++i) {
      if (all[i] > 0) json[name(i)] = all[i];
    }
    return json;
  };
  return text({{"model", info.name},
               {"dynamic", info.dynamic},
               {"kinematic", info.kinematic},
               {"static", info.fixed},
               {"shapes", counts(info.shapes, shapeKindName)},
               {"coloured_shapes", info.coloredShapes},
               {"hull_vertices", info.hullVertices},
               {"mesh_triangles", info.meshTriangles},
               {"heights", info.heightSamples},
               {"particles", info.particles},
               {"tetrahedra", info.tetrahedra},
               {"cloth_triangles", info.triangles},
               {"joints", counts(info.joints, jointKindName)},
               {"soft_bodies", softsJson(info.softs)},
               {"mass", info.mass},
               {"lower", boundsJson(info.bounds, info.bounds.lower)},
               {"upper", boundsJson(info.bounds, info.bounds.upper)},
               {"dt", info.dt},
               {"gravity", Json::array({info.gravity.x, info.gravity.y, info.gravity.z})},
               {"up", Json::array({info.up.x, info.up.y, info.up.z})},
               {"keyframes", info.keyframes},
               {"coordinates", coordinatesJson(info)},
               {"actuators", actuatorsJson(info)},
               {"probes", probesJson(info)},
               {"notes", info.notes}});
}

std::string jsonText(const MeshInfo& info) {
  Json json{{"mesh", info.name},
            {"vertices", info.vertices},
            {"triangles", info.triangles},
            {"degenerate", info.report.degenerate},
            {"duplicate", info.report.duplicate},
            {"lower", boundsJson(info.bounds, info.bounds.lower)},
            {"upper", boundsJson(info.bounds, info.bounds.upper)},
            {"closed", info.closed},
            {"boundary_edges", info.report.boundaryEdges},
            {"non_manifold_edges", info.report.nonManifoldEdges},
            {"area", info.area}};
  json["volume"] = info.closed ? Json(info.volume) : Json();
  json["hull_vertices"] = info.hullVertices ? Json(*info.hullVertices) : Json();
  json["hull_volume"] = info.hullVertices ? Json(info.hullVolume) : Json();
  json["hull_error"] = info.hullVertices ? Json(info.hullError) : Json();
  if (!info.hullVertices) json["hull_refused"] = info.hullRefused;
  json["bytes"] = info.report.bytes;
  json["notes"] = info.notes;
  return text(json);
}

std::string jsonText(const SoftMeshInfo& info) {
  const auto json = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  return text({{"soft_mesh", info.name},
               {"points", info.points},
               {"tetrahedra", info.tets},
               {"triangles", info.triangles},
               {"surface_triangles", info.surface},
               {"inverted", info.report.inverted},
               {"degenerate", info.report.degenerate},
               {"duplicate", info.report.duplicate},
               {"unused", info.report.unused},
               {"pieces", info.quality.pieces},
               {"lower", json(info.lower)},
               {"upper", json(info.upper)},
               {"volume", info.volume},
               {"surface_volume", info.surfaceVolume ? Json(*info.surfaceVolume) : Json()},
               {"area", info.area},
               {"least_angle", info.quality.leastAngle},
               {"greatest_angle", info.quality.greatestAngle},
               {"least_radius_ratio", info.quality.leastRadiusRatio},
               {"least_height", info.quality.leastHeight},
               {"notes", info.notes}});
}

std::string jsonText(const ReportLines& lines) {
  Json json = Json::object();
  for (const auto& [label, value] : lines) {
    // Labels such as "note" may stand more than once.
    if (!json.contains(label)) {
      json[label] = value;
    } else {
      if (!json[label].is_array()) json[label] = Json::array({json[label]});
      json[label].push_back(value);
    }
  }
  return text(json);
}

}  // namespace avbd::cli
