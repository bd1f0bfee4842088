#include "report/requirement/requirement_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "base/text/number_text.h"
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

namespace {

using validate::Candidate;
using validate::Requirement;
using validate::Target;
using validate::Verdict;

/// "raspberry v1, 640x480 at 90 fps" without the mode, which the answer gives separately.
std::string model_of(const std::string& camera) {
  for (std::size_t at = camera.find(", "); at != std::string::npos; at = camera.find(", ", at + 1)) {
    const std::size_t size = at + 2, cross = camera.find('x', size);
    if (cross == std::string::npos || cross == size || cross + 1 == camera.size()) continue;
    const bool number = std::all_of(camera.begin() + static_cast<std::ptrdiff_t>(size),
                                    camera.begin() + static_cast<std::ptrdiff_t>(cross),
                                    [](unsigned char c) { return std::isdigit(c) != 0; });
    if (number && std::isdigit(static_cast<unsigned char>(camera[cross + 1])) != 0) return camera.substr(0, at);
  }
  return camera;
}

std::string mode_words(const Candidate& candidate) {
  return fmt::format("{} x {} pixels, {} frames/s, exposure {}, {}", candidate.mode.width_px, candidate.mode.height_px,
                     base::number_text(candidate.frame_rate_hz, 4), base::size_text(candidate.mode.exposure_s, 2, "s"),
                     codec_words(candidate.mode.codec));
}

/// The expected error: from runs, or the bound if nothing was run.
std::optional<double> expected(const validate::TargetResult& result) {
  return result.found ? result.found : result.bound;
}

/// ", at most 0.000072": the upper limit, on which the verdict rests; empty if nothing was run or there is none.
std::string at_most_words(const Target& target, const validate::TargetResult& result) {
  if (!result.found || !std::isfinite(result.high)) return {};
  return ", at most " + base::number_text(result.high, 2) + unit_suffix(unit_of(target.quantity));
}

std::string expected_words(const Requirement& requirement, const Candidate& candidate) {
  std::string text;
  for (std::size_t t = 0; t < requirement.targets.size(); ++t) {
    const std::optional<double> value = expected(candidate.results[t]);
    if (!value || !std::isfinite(*value)) continue;
    text += (text.empty() ? "" : ", ") + error_words(requirement.targets[t], base::number_text(*value, 2)) +
            at_most_words(requirement.targets[t], candidate.results[t]);
  }
  return text;
}

std::string asked_words(const Requirement& requirement) {
  std::string text;
  for (const Target& target : requirement.targets) {
    text += (text.empty() ? "" : " and ") + error_words(target, base::number_text(target.value, 4));
  }
  return text;
}

std::string judged_words(const Requirement& requirement, const Candidate& candidate) {
  const validate::TargetResult& first = candidate.results.front();
  if (candidate.judged_by == validate::Confirm::none) return "judged by the bound alone; nothing was run";
  const std::string part = requirement.targets.front().measure == Target::Measure::error95 ? "95 % of " : "";
  const std::string by =
      first.estimator.empty() ? "" : fmt::format(", analysed with the {}", estimator_name(first.estimator));
  return candidate.judged_by == validate::Confirm::clips
             ? fmt::format("{}{} rendered experiments{}", part, first.runs, by)
             : fmt::format("{}{} experiments as tracks, without lens, codec and calibration{}", part, first.runs, by);
}

/// Among the judged candidates, the one with the smallest error over target, for the hardest target.
const Candidate* nearest(const Requirement& requirement) {
  const Candidate* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& candidate : requirement.candidates) {
    if (candidate.verdict == Verdict::refused || candidate.results.empty()) continue;
    double need = 0.0;
    for (std::size_t t = 0; t < requirement.targets.size(); ++t) {
      need = std::max(need, expected(candidate.results[t]).value_or(std::numeric_limits<double>::infinity()) /
                                requirement.targets[t].value);
    }
    if (need < least) {
      least = need;
      best = &candidate;
    }
  }
  return best;
}

}  // namespace

std::string error_words(const Target& target, const std::string& value) {
  const std::string symbol = symbol_of(target.quantity), number = value + unit_suffix(unit_of(target.quantity));
  switch (target.measure) {
    case Target::Measure::error95:
      return fmt::format("{} within {}", symbol, number);
    case Target::Measure::sd:
      return fmt::format("an rms error of {} of {}", symbol, number);
    default:
      return fmt::format("a bias of {} of {}", symbol, number);
  }
}

std::string requirement_answer(const Requirement& requirement) {
  if (const Candidate* const first = requirement.first_reached()) {
    const std::string what =
        first->price_class.empty()
            ? fmt::format("Choose {}; set it to {}", first->name, mode_words(*first))
            : fmt::format("Buy: {}, {}; set it to {}", model_of(first->name), first->price_class, mode_words(*first));
    std::string text = fmt::format("{}; expect {} ({}; the target was {}).", what, expected_words(requirement, *first),
                                   judged_words(requirement, *first), asked_words(requirement));
    const auto undecided = std::count_if(requirement.candidates.data(), first, [](const Candidate& candidate) {
      return candidate.verdict == Verdict::undecided;
    });
    if (undecided > 0) {
      text +=
          fmt::format(" {} cheaper {} may be good enough too; more runs would decide.",
                      undecided == 1 ? "One" : std::to_string(undecided), undecided == 1 ? "candidate" : "candidates");
    }
    if (!first->price_class.empty()) text += " Prices are rough, and exclude the computer.";
    return text;
  }
  const Candidate* const near = nearest(requirement);
  if (near == nullptr) return fmt::format("None of these can be judged for {}.", asked_words(requirement));
  if (near->verdict == Verdict::unconfirmed) {
    return fmt::format("By its bound, {} can reach {} ({}), but nothing was run.", near->name, asked_words(requirement),
                       expected_words(requirement, *near));
  }
  std::string text =
      fmt::format("{} {}. {} comes nearest: expect {}{} ({}).",
                  near->verdict == Verdict::undecided ? "Nothing here is certain to reach" : "Nothing here reaches",
                  asked_words(requirement), near->name, near->judged_by == validate::Confirm::none ? "at best " : "",
                  expected_words(requirement, *near), judged_words(requirement, *near));
  if (!near->limits.empty() && near->limits.front().gain >= kLeastNamedGain) {
    text += fmt::format(" Its main limitation: {}.", limitation_words(near->limits.front().what));
  }
  return text;
}

std::string enough_words(const Requirement& requirement) {
  const Candidate* const first = requirement.first_reached();
  if (first == nullptr || !first->enough) return {};
  const validate::Enough& enough = *first->enough;
  std::vector<std::string> ways;
  if (enough.frame_rate_hz) ways.push_back(fmt::format("{} frames/s", base::number_text(*enough.frame_rate_hz, 2)));
  if (enough.noise_m) {
    ways.push_back(fmt::format("a position noise of {} in place of {}", base::size_text(*enough.noise_m, 2, "m"),
                               base::size_text(first->noise_m, 2, "m")));
  }
  std::string text = fmt::format("This is {} times better than needed", base::number_text(enough.times, 2));
  if (ways.empty()) return text + ".";
  return fmt::format("{}: {} would do.", text, fmt::join(ways, ", or "));
}

}  // namespace glidelab::report
