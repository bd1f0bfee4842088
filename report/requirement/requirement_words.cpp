#include "report/requirement/requirement_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report/text/display_text.h"

namespace glidelab::report {

std::string candidate_verdict(const validate::Candidate& candidate) {
  using validate::Verdict;
  const char* by = candidate.judged_by == validate::Confirm::clips ? "clips" : "tracks";
  switch (candidate.verdict) {
    case Verdict::reached:
      return fmt::format("reached, by {}", by);
    case Verdict::by_bound:
      return "reached: the bound is well below the target";
    case Verdict::unconfirmed:
      return candidate.judged_by == validate::Confirm::none ? "possible, not run" : "possible, not filmed";
    case Verdict::undecided:
      return fmt::format("undecided, by {}", by);
    case Verdict::missed:
      return fmt::format("missed, by {}", by);
    case Verdict::impossible:
      return "impossible";
    case Verdict::refused:
      return "refused";
  }
  return {};
}

std::string judging_estimators(const validate::Candidate& candidate) {
  std::vector<std::string> names;
  for (const validate::TargetResult& result : candidate.results) {
    const std::string name = estimator_name(result.estimator);
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names.empty() ? "–" : list_of(names, ", ");
}

std::string unanswered_words(const validate::Requirement& requirement, const validate::Candidate& candidate) {
  std::string text;
  for (std::size_t t = 0; t < candidate.results.size(); ++t) {
    for (const validate::Unanswered& one : candidate.results[t].unanswered) {
      text += fmt::format("{}{}: no answer {} in {} of {} runs", text.empty() ? "" : "; ",
                          symbol_of(requirement.targets[t].quantity), by_estimator(one.estimator), one.runs,
                          candidate.results[t].runs);
    }
  }
  return text;
}

std::string limitation_words(validate::Limitation limitation) {
  using validate::Limitation;
  switch (limitation) {
    case Limitation::frame_rate:
      return fmt::format("frame rate ({:.0f} Hz, same exposure)", validate::kFast_hz);
    case Limitation::light:
      return "light (no shot noise)";
    case Limitation::camera_noise:
      return "the camera's own noise (without it)";
    case Limitation::motion_blur:
      return "motion blur (without it)";
    case Limitation::resolution:
      return fmt::format("resolution ({:.0f} times finer)", validate::kFiner);
    case Limitation::clock:
      return "clock (no lost frames, even frame times; by runs)";
    case Limitation::rolling_shutter:
      return "rolling shutter (global; by runs)";
    case Limitation::codec:
      return "codec (lossless; by runs)";
    case Limitation::calibration:
      return "calibration (the true camera; by runs)";
    case Limitation::imaging:
      return "lens, calibration and tracking (true positions with the expected noise, by runs)";
  }
  return {};
}

std::string codec_words(const validate::CodecSetting& codec) {
  using Kind = validate::CodecSetting::Kind;
  switch (codec.kind) {
    case Kind::lossless:
      return "frames without loss";
    case Kind::mjpeg:
      return fmt::format("MJPEG of quality {:.0f}", codec.value);
    case Kind::h264_quality:
      return fmt::format("H.264 at crf {:.3g}", codec.value);
    case Kind::h264_bitrate:
      return fmt::format("H.264 at {:.3g} Mbit/s", codec.value / 1000.0);
  }
  return {};
}

std::string target_words(const validate::Target& target) {
  using Measure = validate::Target::Measure;
  const char* const measure = target.measure == Measure::sd        ? "sd"
                              : target.measure == Measure::error95 ? "95 % error"
                                                                   : "bias";
  return fmt::format("{} {} {}", target.quantity, measure, target.value);
}

}  // namespace glidelab::report
