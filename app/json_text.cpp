// The only place that knows the JSON library.
#include "app/json_text.h"

#include <nlohmann/json.hpp>

namespace avbd::cli {
namespace {

using Json = nlohmann::ordered_json;

// Names may hold bytes that are no UTF-8.
std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string jsonText(const RunFigures& f) {
  return text({{"scene", f.scene},
               {"bodies", f.bodies},
               {"statics", f.statics},
               {"shapes", f.shapes},
               {"joints", f.joints},
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
               {"kinetic_energy", f.kineticEnergy},
               {"finite", f.finite},
               {"hash", hashText(f.hash)}});
}

std::string jsonText(const bench::BenchRecord& r) {
  return text({{"scene", r.scene},
               {"engine", r.engine},
               {"workers", r.workers},
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

}  // namespace avbd::cli
