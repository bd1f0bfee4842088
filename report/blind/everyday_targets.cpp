#include "report/blind/everyday_targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text/number_text.h"

namespace glidelab::report {

using validate::BlindShare;
using validate::EverydayScore;
using validate::ProportionInterval;

namespace {

/// 95 % interval of the rms of so many normal errors: chi-square by Wilson and Hilferty (1931).
ProportionInterval rms_interval(double rms, std::size_t of) {
  const double n = static_cast<double>(of), spread = 2.0 / (9.0 * n);
  const auto factor = [&](double z) {  // the root of a quantile of chi-square over n
    const double root = 1.0 - spread + z * std::sqrt(spread);
    return root > 0.0 ? std::pow(root, 1.5) : 0.0;
  };
  const double least = factor(-1.96);
  return {rms / factor(1.96), least > 0.0 ? rms / least : std::numeric_limits<double>::infinity()};
}

/// A bound on the calibration error from below and from above: by how much the right ones differ from what was stated,
/// within their interval, and what chance alone would give (twice its mean is seldom exceeded).
ProportionInterval calibration_interval(const validate::EverydayCalibration& of) {
  const BlindShare right{of.of, static_cast<std::size_t>(std::lround(of.right * static_cast<double>(of.of)))};
  const ProportionInterval in = right.interval95();
  const double nearest = std::max({0.0, in.low - of.stated, of.stated - in.high});
  const double farthest = std::max(in.high - of.stated, of.stated - in.low);
  return {std::max(nearest, of.error - 2.0 * of.by_chance), std::max(farthest, of.error)};
}

}  // namespace

std::string share_and_interval(const BlindShare& share) {
  if (share.of == 0) return "–";
  const validate::ProportionInterval interval = share.interval95();
  return fmt::format("{:.0f} % ({} of {}; 95 %: {:.0f} to {:.0f} %)", 100.0 * share.share(), share.yes, share.of,
                     100.0 * interval.low, 100.0 * interval.high);
}

BlindShare covered_of(const EverydayScore& score, const std::string& of_class, const std::string& quantity) {
  BlindShare sum;
  for (const auto& [kind, by_quantity] : score.covered) {
    if (!of_class.empty() && kind != of_class) continue;
    for (const auto& [key, share] : by_quantity) {
      if (!quantity.empty() && key != quantity) continue;
      sum.of += share.of;
      sum.yes += share.yes;
    }
  }
  return sum;
}

std::string found_text(const EverydayTarget& target) {
  if (!bears(target)) return "–";
  return target.value ? base::number_text(*target.value, 2) : share_and_interval(target.share);
}

std::string limits_text(const EverydayTarget& target) {
  const auto text = [&](double limit) {
    return target.number ? base::number_text(limit, 2) : fmt::format("{:.0f} %", 100.0 * limit);
  };
  if (target.low > 0.0 && target.high < 1.0) return text(target.low) + " to " + text(target.high);
  return target.low > 0.0 ? "at least " + text(target.low) : "at most " + text(target.high);
}

std::string words_of_class(const std::string& kind) {
  if (kind == "one") return "one cause";
  if (kind == "two") return "two causes";
  if (kind == "dirt") return "small imperfections alone";
  if (kind == "outside") return "a cause not on the list";
  return "all";
}

std::vector<EverydayTarget> everyday_targets(const EverydayScore& score) {
  const validate::EverydayMethod& diagnosis = score.methods.front();
  std::vector<EverydayTarget> targets = {
      {"the main cause is named first", sum_of(diagnosis.main_first), {}, 0.85, 1.0},
      {"two causes: both are named", sum_of(diagnosis.both), {}, 0.70, 1.0},
      {"small imperfections alone: a cause with half of the excess is claimed",
       sum_of(diagnosis.false_claim),
       {},
       0.0,
       0.05},
      {"a cause not on the list: a wrong one is named, with a probability above 0.8",
       sum_of(diagnosis.wrong_name),
       {},
       0.0,
       0.03},
      {"recovered intervals contain the true value", covered_of(score, "", ""), {}, 0.90, 0.98}};
  EverydayTarget shares{"rms error of the shares of named causes", {}, {}, 0.0, 0.1, true};
  if (diagnosis.share_error.of > 0) {
    shares.value = diagnosis.share_error.rms();
    shares.interval = rms_interval(*shares.value, diagnosis.share_error.of);
  }
  targets.push_back(std::move(shares));
  for (const char* kind : {"one", "two", "dirt", "outside"}) {
    EverydayTarget calibration{
        "expected calibration error, " + words_of_class(kind), {}, {}, 0.0, kWantedCalibration, true};
    const auto found = score.calibration.find(kind);
    if (found != score.calibration.end()) {
      calibration.value = found->second.error;
      calibration.interval = calibration_interval(found->second);
    }
    targets.push_back(std::move(calibration));
  }
  return targets;
}

bool bears(const EverydayTarget& target) {
  return target.value.has_value() || target.share.of > 0;
}

TargetVerdict verdict_of(const EverydayTarget& target) {
  const ProportionInterval in = target.interval.value_or(target.share.interval95());
  if (in.low >= target.low && in.high <= target.high) return TargetVerdict::met;
  return in.high < target.low || in.low > target.high ? TargetVerdict::missed : TargetVerdict::open;
}

}  // namespace glidelab::report
