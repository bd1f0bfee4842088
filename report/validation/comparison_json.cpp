#include "report/validation/comparison_json.h"

#include "report/text/json_numbers.h"

namespace glidelab::report {

std::string comparison_json(const validate::Comparison& comparison) {
  Json document;
  document["format"] = 1;
  document["quantities"] = Json::array();
  for (const validate::QuantityComparison& quantity : comparison.quantities) {
    Json object;
    object["configuration"] = quantity.configuration;
    object["mass_kg"] = quantity.mass_kg;
    object["incline_deg"] = quantity.incline_deg;
    object["estimator"] = quantity.estimator;
    object["quantity"] = quantity.quantity;
    put(object, "truth", quantity.truth, "the scenario does not have it");
    put(object, "value", quantity.value, quantity.why);
    put(object, "sd", quantity.sd, quantity.why);
    put(object, "error", quantity.error, quantity.truth ? quantity.why : "there is no truth to compare with");
    const char* const unbounded =
        "the motion does not determine it, or the law is not viscous drag with Coulomb friction";
    put(object, "cramer_rao_sd", quantity.cramer_rao_sd, unbounded);
    put(object, "noise_sd", quantity.noise_sd, quantity.why);
    put(object, "efficiency", quantity.efficiency, quantity.cramer_rao_sd ? quantity.why : unbounded);
    document["quantities"].push_back(std::move(object));
  }
  document["lines"] = Json::array();
  for (const validate::LineComparison& line : comparison.lines) {
    Json object{{"clip", line.clip}, {"direction", line.direction}};
    put(object, "r2", line.r2);
    document["lines"].push_back(std::move(object));
  }
  const validate::RestitutionComparison& restitution = comparison.restitution;
  const bool measured = !restitution.points.empty();
  Json& positions = document["restitution"];
  put(positions, "rms_m", measured ? std::optional(restitution.rms_m) : std::nullopt, "no marker was found");
  put(positions, "max_m", measured ? std::optional(restitution.max_m) : std::nullopt, "no marker was found");
  put(positions, "field_m", restitution.field_m);
  document["frames"] = comparison.frames;
  document["detected"] = comparison.detected;
  put(document, "wall_s", comparison.wall_s);
  return json_text(document);
}

}  // namespace glidelab::report
