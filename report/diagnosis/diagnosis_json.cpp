#include "report/diagnosis/diagnosis_json.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "base/math/distributions.h"
#include "core/result/quantity.h"
#include "report/analysis/camera_plots.h"
#include "report/analysis/left_out_clips.h"
#include "report/diagnosis/line_report.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/diagnosis/words/image_words.h"
#include "report/diagnosis/words/line_words.h"
#include "report/diagnosis/words/next_step_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/text/json_numbers.h"
#include "report/text/why_words.h"

namespace glidelab::report {

Json parameters_json(const std::vector<diagnose::DiagnosedParameter>& parameters) {
  Json object = Json::object();
  for (const diagnose::DiagnosedParameter& parameter : parameters) {
    Json value;
    if (!parameter.text.empty()) {
      value["value"] = parameter.text;
    } else if (!parameter.why) {
      put(value, "value", parameter.value);
      put(value, "sd", parameter.sd);
      if (parameter.at_end) value["at_end"] = true;
    } else {
      put(value, "value", std::optional<double>(), why_words(parameter.why));
      value["sd"] = nullptr;
    }
    object[parameter.key] = std::move(value);
  }
  return object;
}

Json recovered_json(const std::vector<diagnose::RecoveredConfiguration>& recovered) {
  Json list = Json::array();
  for (const diagnose::RecoveredConfiguration& of : recovered) {
    Json one;
    one["group"] = of.group;
    put(one, "mass_kg", of.mass_kg);
    put(one, "incline_deg", of.incline_deg);
    one["with"] = of.with;
    for (const core::QuantityName& name : core::kQuantities) {
      put(one, std::string(name.key), core::value_of(of, name.which));
    }
    list.push_back(std::move(one));
  }
  return list;
}

namespace {

Json effect_json(const diagnose::DiagnosedEffect& effect) {
  Json object;
  object["id"] = effect.id;
  object["stage"] = to_text(effect.stage);
  put(object, "probability", effect.probability);
  object["equivalent_to"] = effect.equivalent_to;
  put(object, "joint_probability", effect.joint_probability);
  object["parameters"] = parameters_json(effect.parameters);
  return object;
}

Json regions_json(const std::vector<diagnose::GapRegion>& regions) {
  Json list = Json::array();
  for (const diagnose::GapRegion& region : regions) {
    Json object;
    object["variable"] = to_text(region.variable);
    put(object, "from", region.from);
    put(object, "to", region.to);
    put(object, "excess", region.excess);
    if (!region.clip.empty()) object["clip"] = region.clip;
    object["what"] = to_text(region.what);
    put(object, "size", region.size);
    object["unit"] = region.unit;
    if (region.size_sd) put(object, "size_sd", *region.size_sd);
    if (region.at) put(object, "at", *region.at);
    if (region.direction != 0) object["direction"] = region.direction;
    if (region.lacking) put(object, "lacking", *region.lacking);
    list.push_back(std::move(object));
  }
  return list;
}

Json where_json(const diagnose::Diagnosis& diagnosis) {
  Json where;
  where["stage"] = diagnosis.stage ? Json(to_text(*diagnosis.stage)) : Json(nullptr);
  where["regions"] = regions_json(diagnosis.regions);
  return where;
}

/// Null with its reason if there is none.
void put_interval(Json& object, const char* key, const std::optional<diagnose::GapInterval>& interval,
                  const std::string& why) {
  if (interval) {
    object[key] = {interval->low, interval->high};
    return;
  }
  object[key] = nullptr;
  object["why"][key] = why;
}

Json intervals_json(const diagnose::GapIntervals& of) {
  const auto why = [&](const char* otherwise) { return of.too_few ? too_few_words(of) : std::string(otherwise); };
  Json object;
  put_interval(object, "before", of.before, why("fewer than three clips have a gap"));
  put_interval(object, "after", of.after, why("fewer than three clips have a gap"));
  put_interval(object, "shrink", of.shrink, why("the gap, or that without one of the clips, is not above the floor"));
  object["method"] = "jackknife over clips";
  return object;
}

Json acceleration_intervals_json(const diagnose::GapIntervals& of) {
  const std::string why =
      of.too_few ? too_few_words(of) : "fewer than three clips have accelerations that could be compared";
  Json object;
  put_interval(object, "before", of.acceleration_before, why);
  put_interval(object, "after", of.acceleration_after, why);
  return object;
}

Json difference_json(const diagnose::GapValue& of) {
  Json object;
  put(object, "value", of.value);
  put(object, "sd", of.sd);
  object["interval95"] = {of.value - base::kNormal95 * of.sd, of.value + base::kNormal95 * of.sd};
  return object;
}

Json phase_json(const diagnose::PhaseGap& gap) {
  Json object;
  put(object, "mass_kg", gap.mass_kg, "all masses together");
  object["bins"] = Json::array();
  for (const diagnose::PhaseBin& bin : gap.bins) {
    Json one;
    put(one, "from_m_s", bin.from_m_s);
    put(one, "to_m_s", bin.to_m_s);
    put(one, "v_m_s", bin.v_m_s);
    one["points"] = bin.points;
    one["before_m_s2"] = difference_json(bin.before);
    one["after_m_s2"] = difference_json(bin.after);
    object["bins"].push_back(std::move(one));
  }
  return object;
}

Json gap_json(const diagnose::GapSizes& gap) {
  Json object;
  put(object, "before", gap.before);
  put(object, "after", gap.after);
  object["floor"] = gap.floor;
  put(object, "shrink", gap.shrink, "the gap is not above the floor by more than its standard error");
  put(object, "standard_error", gap.standard_error);
  object["interval95"] = intervals_json(gap.interval95);
  object["held_out"] = gap.held_out;
  object["by_clip"] = {{"before", gap.before_by_clip}, {"after", gap.after_by_clip}};
  Json acceleration;
  const char* none = "there is no motion whose accelerations could be compared";
  put(acceleration, "before", gap.acceleration_before, none);
  put(acceleration, "after", gap.acceleration_after, none);
  acceleration["interval95"] = acceleration_intervals_json(gap.interval95);
  object["acceleration_m_s2"] = std::move(acceleration);
  object["parameters"] = Json::array();
  for (const diagnose::GapOfParameter& parameter : gap.parameters) {
    Json one;
    one["quantity"] = parameter.quantity;
    one["against"] = to_text(parameter.against);
    one["group"] = parameter.group;
    put(one, "z_before", parameter.z_before, "this part of the data hardly constrains it");
    put(one, "z_after", parameter.z_after, "no effect is named, or this part of the data hardly constrains it");
    for (const auto& [key, of] : {std::pair("alone", &parameter.alone), std::pair("together", &parameter.together)}) {
      if (!*of) continue;
      put(one[key], "value", (*of)->value);
      put(one[key], "sd", (*of)->sd);
    }
    object["parameters"].push_back(std::move(one));
  }
  object["phase_plane"] = Json::array();
  for (const diagnose::PhaseGap& of : gap.phase_plane) object["phase_plane"].push_back(phase_json(of));
  object["domains"] = Json::array();
  for (const diagnose::GapDomain& of : gap.domains) {
    Json one;
    one["domain"] = to_text(of.domain);
    put(one, "before", of.before);
    put(one, "after", of.after, "it cannot be determined");
    object["domains"].push_back(std::move(one));
  }
  return object;
}

Json noise_json(const diagnose::ImageCurve& curve) {
  Json one;
  one["level_code"] = curve.at;
  one["variance_code2"] = curve.value;
  one["sd_code2"] = curve.sd;
  one["linear_code2"] = curve.fitted;
  put(one, "excess", curve_excess(curve));
  return one;
}

Json rests_json(const diagnose::CalibrationRests& of) {
  Json one;
  one["experiment"] = of.experiment;
  put(one, "excess", of.rests.excess);
  one["cells"] = Json::array();
  for (const core::CornerCell& cell : of.rests.cells) {
    one["cells"].push_back({{"u_px", cell.u_px},
                            {"v_px", cell.v_px},
                            {"du_px", cell.du_px},
                            {"dv_px", cell.dv_px},
                            {"sd_px", cell.sd_px},
                            {"corners", cell.corners}});
  }
  return one;
}

Json explained_json(const diagnose::Diagnosis& diagnosis) {
  const bool few = diagnosis.gap && diagnosis.gap->interval95.too_few;
  const std::string why =
      few ? too_few_words(diagnosis.gap->interval95)
          : fmt::format("the gap without one of the {} is not above the floor", diagnosis.lines ? "lines" : "clips");
  Json list = Json::array();
  for (const diagnose::ExplainedCause& cause : diagnosis.explained) {
    Json one;
    one["id"] = cause.id;
    put(one, "share", cause.share);
    put_interval(one, "share_interval95", cause.share_interval95, why);
    put(one, "gap_after", cause.gap_after);
    list.push_back(std::move(one));
  }
  return list;
}

Json remainder_json(const diagnose::GapRemainder& remainder) {
  Json object;
  put(object, "share", remainder.share);
  put(object, "gap", remainder.gap);
  put(object, "acceleration_m_s2", remainder.acceleration_m_s2);
  put(object, "clip_scatter_m_s2", remainder.clip_scatter_m_s2);
  put(object, "drag_scatter", remainder.drag_scatter);
  object["where"]["regions"] = regions_json(remainder.regions);
  return object;
}

Json levels_json(const diagnose::GapLevels& levels) {
  Json object;
  put(object, "clip", levels.clip, "there is one clip alone");
  put(object, "configuration", levels.configuration, "there is one configuration alone");
  put(object, "all", levels.all);
  object["holds_within"] = levels.holds_within;
  return object;
}

}  // namespace

std::string diagnosis_json(const diagnose::Diagnosis& diagnosis) {
  Json document;
  document["format"] = 1;
  document["verdict"] = diagnose::verdict_id(diagnosis.verdict);
  document["points"] = diagnosis.points;
  document["clips_left_out"] = left_out_json(diagnosis.left_out);
  document["summary"] = verdict_words(diagnosis);
  document["effects"] = Json::array();
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) document["effects"].push_back(effect_json(effect));
  put(document["probability"], "none", diagnosis.none);
  put(document["probability"], "unknown", diagnosis.unknown);
  document["ranking"] = Json::array();
  for (const diagnose::RankedExplanation& ranked : diagnosis.ranking) {
    Json one;
    one["id"] = explanation_id(ranked.explanation);
    put(one, "probability", ranked.probability);
    if (!ranked.left_out) {
      put(one, "log_evidence_gain", ranked.log_evidence_gain);
      put(one, "log_likelihood_gain", ranked.log_likelihood_gain);
    } else {
      const std::string why = impossible_words(*ranked.left_out);
      put(one, "log_evidence_gain", std::optional<double>(), why);
      put(one, "log_likelihood_gain", std::optional<double>(), why);
    }
    one["parameters"] = ranked.parameters;
    one["converged"] = ranked.converged;
    if (ranked.gap_after) put(one, "gap_after", *ranked.gap_after);
    document["ranking"].push_back(std::move(one));
  }
  if (diagnosis.lines) document["lines"] = lines_json(*diagnosis.lines);
  document["where"] = where_json(diagnosis);
  document["gap"] = diagnosis.gap ? gap_json(*diagnosis.gap) : Json(nullptr);
  document["explained"] = explained_json(diagnosis);
  document["remainder"] = diagnosis.remainder ? remainder_json(*diagnosis.remainder) : Json(nullptr);
  document["traces"] = diagnosis.traces;
  document["levels"] = diagnosis.levels ? levels_json(*diagnosis.levels) : Json(nullptr);
  document["recovered"] = recovered_json(diagnosis.recovered);
  document["next_experiment"] = next_step_words(diagnosis.next);
  document["isolability"] = {{"effects", diagnosis.isolability.ids}, {"cosine", diagnosis.isolability.cosine}};
  document["pictures"] = Json::array();
  for (const diagnose::ImageFinding& finding : diagnosis.images) {
    Json one;
    one["id"] = finding.id;
    one["stage"] = to_text(finding.stage);
    one["seen"] = finding.seen;
    put(one, "log_evidence", finding.log_evidence);
    one["parameters"] = parameters_json(finding.parameters);
    one["words"] = image_words(finding.fact);
    document["pictures"].push_back(std::move(one));
  }
  document["pixel_noise"] = Json::array();
  for (const diagnose::ImageCurve& curve : diagnosis.image_curves) {
    if (curve.what == "noise") document["pixel_noise"].push_back(noise_json(curve));
  }
  document["calibration_rests"] = Json::array();
  for (const diagnose::CalibrationRests& of : diagnosis.calibrations) {
    document["calibration_rests"].push_back(rests_json(of));
  }
  document["notes"] = notes_words(diagnosis);
  return json_text(document);
}

}  // namespace glidelab::report
