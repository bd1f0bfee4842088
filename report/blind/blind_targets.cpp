#include "report/blind/blind_targets.h"

#include <fmt/format.h>

#include "base/text/number_text.h"
#include "report/html/html.h"

namespace glidelab::report {
namespace {

using validate::BlindShare;

BlindShare all_of(const std::map<std::string, BlindShare>& shares) {
  BlindShare sum;
  for (const auto& [key, share] : shares) {
    sum.of += share.of;
    sum.yes += share.yes;
  }
  return sum;
}

/// "in 96 % (122 of 127; 95 %: 91 to 99 %)"
std::string with_interval(const BlindShare& share) {
  const validate::ProportionInterval interval = share.interval95();
  return fmt::format("in {:.0f} % ({} of {}; 95 %: {:.0f} to {:.0f} %)", 100.0 * share.share(), share.yes, share.of,
                     100.0 * interval.low, 100.0 * interval.high);
}

/// By how much more is stated than is right, on average over the cases.
double over_stated(const validate::BlindScore& score) {
  double sum = 0.0, cases = 0.0;
  for (const validate::ReliabilityBin& bin : score.reliability) {
    const auto of = static_cast<double>(bin.right.of);
    sum += of * (bin.stated - bin.right.share());
    cases += of;
  }
  return cases > 0.0 ? sum / cases : 0.0;
}

}  // namespace

BlindShare share_of(const std::map<std::string, BlindShare>& shares, const std::string& key) {
  const auto found = shares.find(key);
  return found == shares.end() ? BlindShare{} : found->second;
}

std::string blind_percent(const BlindShare& share) {
  if (share.of == 0) return "–";
  return fmt::format("{:.0f} % ({} of {})", 100.0 * share.share(), share.yes, share.of);
}

std::vector<BlindTarget> blind_targets(const validate::BlindScore& score) {
  const auto& single = score.methods.front().single;
  return {{"one strong effect: named first", share_of(single, "strong"), 0.95, false},
          {"one moderate effect: named first", share_of(single, "moderate"), 0.80, false},
          {"one effect, moderate or strong: among those named",
           {share_of(score.in_set, "strong").of + share_of(score.in_set, "moderate").of,
            share_of(score.in_set, "strong").yes + share_of(score.in_set, "moderate").yes},
           0.97,
           false},
          {"nothing wrong: a verdict other than none", score.false_alarm, 0.05, true},
          {"not in the list, strong: unknown", share_of(score.recognised, "strong"), 0.85, false},
          {"not in the list, all: unknown", all_of(score.recognised), 0.85, false},
          {"not in the list: a name with probability over 0.8", score.wrong_name, 0.03, true},
          {"two effects: both named", score.methods.front().pair, 0.75, false},
          {"gap shrinks by 0.95 or more of what a fit of the true effect reaches", score.shrunk, 0.95, false}};
}

bool is_met(const BlindTarget& target) {
  return target.at_most ? target.share.share() <= target.wanted : target.share.share() >= target.wanted;
}

std::string wanted_text(const BlindTarget& target) {
  return fmt::format("{} {:.0f} %", target.at_most ? "at most" : "at least", 100.0 * target.wanted);
}

std::string blind_meaning(const validate::BlindScore& score) {
  const auto& single = score.methods.front().single;
  std::string text;
  const auto add = [&](const BlindShare& share, const char* when, const char* what) {
    if (share.of > 0) text += fmt::format("<li>{}: {} {}.</li>\n", when, what, with_interval(share));
  };
  add(share_of(single, "strong"), "One strong effect",
      "its name, or that of an effect that is the same on such data, comes first");
  add(share_of(single, "moderate"), "One moderate effect", "its name comes first");
  add(score.methods.front().pair, "Two effects at once", "both are named");
  add(score.false_alarm, "Nothing wrong", "the verdict is other than none");
  add(all_of(score.recognised), "A cause that is not in the list", "it is called unknown");
  add(score.wrong_name, "A cause that is not in the list", "some name gets a probability over 0.8");
  text = meaning_section("<p>How far a verdict on an experiment like these can be trusted:</p>\n<ul>\n" + text +
                         "</ul>\n");
  const bool calibrated = score.calibration_error < kWantedCalibration;
  text += fmt::format("<p>A stated probability is off by {} on average: it can{} be taken at face value{}.",
                      base::number_text(score.calibration_error, 2), calibrated ? "" : "not",
                      calibrated                 ? ""
                      : over_stated(score) > 0.0 ? ", it is too sure of itself"
                                                 : ", it is too modest");
  std::string missed = calibrated ? "" : "the expected calibration error";
  std::size_t weighed = 1;  // with that of the calibration
  for (const BlindTarget& target : blind_targets(score)) {
    if (target.share.of == 0) continue;
    ++weighed;
    if (!is_met(target)) missed += (missed.empty() ? "" : "; ") + escape(target.what);
  }
  if (weighed == 1) return text + " No case bears on the targets.</p>\n";
  return text + (missed.empty() ? fmt::format(" All {} targets that these cases bear on are met.</p>\n", weighed)
                                : fmt::format(" Missed: {}.</p>\n", missed));
}

}  // namespace glidelab::report
