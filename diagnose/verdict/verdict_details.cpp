#include "diagnose/verdict/verdict_details.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "diagnose/effects/effect_library.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/gap/size_uncertainty.h"
#include "diagnose/verdict/own_sizes.h"
#include "diagnose/weigh/fit_odds.h"

namespace glidelab::diagnose {
namespace {

constexpr double kMostScaleRatio = 1.05;  // of two clips that count as of one scale
constexpr std::string_view kLineTime = "line_s";

/// For each set-up, the position at `share` of the distance from the set-up's own middle to the middle of all.
std::vector<DiagnosedParameter> middles(const TrackSet& set, double share, double share_sd) {
  std::vector<DiagnosedParameter> parameters;
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    const double to_middle_m = set.x_mid_m - set.groups[g].x_mid_m;
    parameters.push_back({set.groups.size() == 1 ? "x_mid_m" : "x_mid_m." + own_name(set, g),
                          set.groups[g].x_mid_m + share * to_middle_m,
                          to_middle_m == 0.0 ? 0.0 : std::abs(to_middle_m) * share_sd});
  }
  return parameters;
}

/// Pixels per metre along the motion; 0 if the clips do not agree on it.
double px_per_m(const ImageEvidence& images) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const FilmedClip& clip : images.clips) {
    least = std::min(least, clip.px_per_m);
    most = std::max(most, clip.px_per_m);
  }
  return most > 0.0 && most < kMostScaleRatio * least ? 0.5 * (least + most) : 0.0;
}

}  // namespace

std::vector<DiagnosedParameter> fitted_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                  double stated_line_s) {
  std::vector<DiagnosedParameter> parameters;
  const SizeUncertainty uncertainty(set, fit);
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const EffectParameter* parameter = globals[g].parameter;
    if (parameter == nullptr || globals[g].effect != effect || parameter->key.empty()) continue;
    if (shown_together(parameter->shown_as)) continue;
    const auto at = static_cast<Eigen::Index>(g);
    ShownValue value = shown(*parameter, fit.at.global[at]);
    if (parameter->shown_as == ShownAs::beside_stated) {
      if (parameter->key != kLineTime) throw std::logic_error("only a line time is shown beside the stated one");
      value.value += stated_line_s;
    }
    parameters.push_back({std::string(parameter->key), value.value, uncertainty.sd(at) * std::abs(value.by_fitted)});
    parameters.back().at_end = is_at_end(globals[g].range, fit.at.global[at], parameter->absent);
  }
  return parameters;
}

std::vector<DiagnosedParameter> derived_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                   const ImageEvidence& images,
                                                   const std::vector<DiagnosedParameter>& known) {
  if (std::vector<DiagnosedParameter> own = own_sizes(set, fit, effect); !own.empty()) return own;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter == nullptr || globals[g].effect != effect) continue;
    const auto at = static_cast<Eigen::Index>(g);
    if (globals[g].parameter->shown_as == ShownAs::itself_and_middle) return middles(set, 0.0, 0.0);
    if (globals[g].parameter->shown_as == ShownAs::place_of_middle) {
      return middles(set, fit.at.global[at], SizeUncertainty(set, fit).sd(at));
    }
  }
  const auto in_metres = std::find_if(known.begin(), known.end(), [](const auto& p) { return p.key == "amplitude_m"; });
  const bool in_pixels = std::any_of(known.begin(), known.end(), [](const auto& p) { return p.key == "amplitude_px"; });
  const double scale = px_per_m(images);
  if (in_metres == known.end() || in_pixels || scale == 0.0) return {};
  return {{"amplitude_px", in_metres->value * scale, in_metres->sd * scale}};
}

namespace {

// Standard deviations below 0 at which a drag or friction counts as negative: of the nominal model, as in an analysis,
// and beside named causes, whose sizes may be off by their shapes.
constexpr double kLeastNegativeSds = 3.0, kLeastNegativeBesideSds = 5.0;
constexpr double kLeastPullSds = 5.0;     // standard deviations between a statement and everything else
constexpr double kLeastPartToTell = 0.1;  // of the motion: from here on the reader must be told that it is set aside

std::vector<ContradictedIncline> contradicted_statements(const TrackSet& set, const MotionFit& fit) {
  std::vector<ContradictedIncline> found;
  for (const StatementPull& pull : statement_pulls(set, fit)) {
    if (!pull.z || std::abs(*pull.z) < kLeastPullSds) continue;
    found.push_back({pull.group, pull.against, pull.stated_rad, pull.stated_sd_rad, pull.else_rad, pull.else_sd_rad,
                     !fit.effects.empty(), std::abs(*pull.z)});
  }
  return found;
}

/// Positions that no explanation covers: those that look like a hand or a stop, or that lie far off.
std::optional<SetAside> set_aside(const TrackSet& set) {
  double points = 0.0, outliers = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    points += static_cast<double>(motion.t_s.size());
    outliers +=
        static_cast<double>(std::count_if(motion.outlier.begin(), motion.outlier.end(), [](char o) { return o != 0; }));
  }
  const auto moving = static_cast<double>(set.moving), left_out = static_cast<double>(set.left_out);
  if (!(moving > 0.0 && points > 0.0)) return {};
  const double part = (left_out + (moving - left_out) * outliers / points) / moving;
  if (part < kLeastPartToTell) return {};
  return SetAside{set.moving, part};
}

}  // namespace

namespace {

std::vector<NegativeLoss> negative_of(const Eigen::VectorXd& values, const Eigen::VectorXd& variances, bool named) {
  const double sds = named ? kLeastNegativeBesideSds : kLeastNegativeSds;
  std::vector<NegativeLoss> found;
  for (Eigen::Index g = 0; g < 2; ++g) {  // K, mu
    const double sd = std::sqrt(std::max(0.0, variances[g]));
    if (!(values[g] < -sds * sd)) continue;
    found.push_back({g == 0 ? NegativeLoss::Of::drag : NegativeLoss::Of::friction, values[g], sd});
  }
  return found;
}

}  // namespace

std::vector<NegativeLoss> what_drives(const MotionFit& fit) {
  return negative_of(fit.at.global, common_covariance(fit).diagonal(), !fit.effects.empty());
}

void count_remainder(const TrackSet& set, const MotionFit& fit, const RemainderSizes& sizes, Diagnosis& diagnosis) {
  const RemainderSpace::Solution solution = RemainderSpace(set, fit).solve(sizes);
  diagnosis.limits.driving =
      negative_of(fit.at.global + solution.change,
                  solution.covariance.diagonal().cwiseMax(solution.between_clips.diagonal()), !fit.effects.empty());
  std::erase_if(diagnosis.notes, [](const Note& note) { return std::holds_alternative<NegativeLoss>(note); });
  for (const NegativeLoss& one : diagnosis.limits.driving) diagnosis.notes.emplace_back(one);
}

std::optional<ImpossibleSizes> impossible_sizes(const MotionFit& fit) {
  ImpossibleSizes found{{}, what_drives(fit), {}};
  for (const std::size_t e : effects_at_end(fit)) found.at_end.emplace_back(effect_list()[e].id);
  if (found.negative.empty() && found.at_end.empty()) return {};
  for (const std::size_t e : fit.effects) found.effects.emplace_back(effect_list()[e].id);
  return found;
}

VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit) {
  return {what_drives(fit), contradicted_statements(set, fit), {}, set_aside(set)};
}

namespace {

constexpr double kLeastEvidenceOfRegion = 3.0;  // log evidence from which a function without a name is worth a region
constexpr std::size_t kMostRegions = 6;
constexpr std::size_t kMostCurves = 4;
constexpr double kMostOverLacking = 2.0;  // times what the accelerations lack: a larger size is not believed

/// The largest residual of a motion's positions and its largest first and second time derivative, these by the parabola
/// through nine neighbours at even times, none of them set aside.
struct LargestRest {
  double x_m = 0.0, v_m_s = 0.0, a_m_s2 = 0.0;
};

LargestRest largest_rest(const TrackedMotion& motion, const std::vector<double>& rest_m) {
  constexpr std::size_t kEachSide = 4;
  constexpr double kMean = 20.0 / 3.0, kSquares = 60.0, kFourths = 308.0;  // sums of k², and of (k² - mean)², k to 4
  constexpr double kMostUnevenStep = 0.2;
  LargestRest largest;
  for (std::size_t p = 0; p < rest_m.size(); ++p) {
    if (motion.outlier[p] == 0) largest.x_m = std::max(largest.x_m, std::abs(rest_m[p]));
  }
  for (std::size_t p = kEachSide; p + kEachSide < motion.t_s.size(); ++p) {
    const double before = motion.t_s[p] - motion.t_s[p - kEachSide], behind = motion.t_s[p + kEachSide] - motion.t_s[p];
    if (std::abs(behind - before) > kMostUnevenStep * before) continue;
    const double step = (before + behind) / (2.0 * kEachSide);
    double first = 0.0, second = 0.0;
    bool aside = false;
    for (std::size_t j = 0; j <= 2 * kEachSide; ++j) {
      const double k = static_cast<double>(j) - static_cast<double>(kEachSide);
      first += k * rest_m[p - kEachSide + j];
      second += (k * k - kMean) * rest_m[p - kEachSide + j];
      aside = aside || motion.outlier[p - kEachSide + j] != 0;
    }
    if (aside) continue;
    largest.v_m_s = std::max(largest.v_m_s, std::abs(first / (kSquares * step)));
    largest.a_m_s2 = std::max(largest.a_m_s2, std::abs(2.0 * second / (kFourths * step * step)));
  }
  return largest;
}

}  // namespace

Lacking most_lacking(const TrackSet& set, const MotionFit& nominal) {
  Lacking most;
  double slowest_m_s = std::numeric_limits<double>::infinity(), shortest_m = slowest_m_s;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    const TrackModel model = model_of(set, *nominal.layout, nominal.at, i);
    const Moved moved =
        move(model, motion.t_s, nominal.late.empty() ? std::span<const double>() : std::span(nominal.late[i]));
    std::vector<double> rest_m = shared_errors(set, *nominal.layout, nominal.at, i, moved.x_m);
    double fastest = 0.0;
    for (std::size_t p = 0; p < rest_m.size(); ++p) {
      rest_m[p] = motion.x_m[p] - moved.x_m[p] - rest_m[p];
      fastest = std::max(fastest, std::abs(moved.v_m_s[p]));
    }
    const LargestRest rest = largest_rest(motion, rest_m);
    const auto [low, high] = std::minmax_element(moved.x_m.begin(), moved.x_m.end());
    if (low != high) shortest_m = std::min(shortest_m, *high - *low);
    slowest_m_s = std::min(slowest_m_s, fastest);
    most.position_m = std::max(most.position_m, rest.x_m);
    most.force_n = std::max(most.force_n, model.mass_kg * rest.a_m_s2 + std::abs(model.k_n_s_m) * rest.v_m_s);
  }
  most.drag_n_s_m = most.force_n / slowest_m_s;
  most.scale = most.position_m / shortest_m;
  most.time_s = most.position_m / slowest_m_s;
  for (const TrackedMass& mass : set.masses) {
    most.acceleration_m_s2 = std::max(most.acceleration_m_s2, most.force_n / mass.mass_kg);
  }
  return most;
}

double Lacking::in(const std::string& unit) const {
  return unit == "N"       ? force_n
         : unit == "m/s²"  ? acceleration_m_s2
         : unit == "N s/m" ? drag_n_s_m
         : unit == "m"     ? position_m
         : unit == "s"     ? time_s
                           : scale;
}

void add_regions(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families,
                 Diagnosis& diagnosis) {
  const Lacking most = most_lacking(set, nominal);
  std::vector<const UnnamedFamily*> sorted;
  for (const UnnamedFamily& family : families) sorted.push_back(&family);
  // The evidence holds in a linear neighbourhood. Where it is large it is not known to a hundredth, and a function that
  // clips share goes before curves of each clip's own.
  const auto weight = [](const UnnamedFamily* family) {
    return (family->variable == GapVariable::clip ? 0.99 : 1.0) * family->log_evidence;
  };
  std::sort(sorted.begin(), sorted.end(), [&](const auto* a, const auto* b) { return weight(a) > weight(b); });
  const double notable =
      kLeastEvidenceOfRegion + std::log(static_cast<double>(families.size()));  // corrected for as many looks
  std::set<std::pair<GapVariable, GapKind>> shown;                              // variables and what acts there
  for (const UnnamedFamily* family : sorted) {
    // The function on which a verdict rests has its place named, however many looks there were.
    const bool rests = diagnosis.verdict == Verdict::unknown && diagnosis.regions.empty() && family == sorted.front();
    if (family->log_evidence < (rests ? 0.0 : notable)) break;
    const auto what = std::pair(family->variable, family->what);
    if (shown.contains(what)) continue;  // the same at another width
    if (family->names.empty() && !family->at.empty() && diagnosis.curves.size() < kMostCurves) {
      diagnosis.curves.push_back(
          {family->variable, family->what, family->unit, family->log_evidence, family->at, family->size, family->sd});
      shown.insert(what);
    }
    if (!family->regions.empty()) shown.insert(what);
    std::vector<UnnamedRegion> regions = family->regions;
    std::sort(regions.begin(), regions.end(), [](const auto& a, const auto& b) { return a.excess > b.excess; });
    for (std::size_t r = 0; r < regions.size() && r < 2 && diagnosis.regions.size() < kMostRegions; ++r) {
      GapRegion region{family->variable, regions[r].from, regions[r].to, regions[r].excess,
                       regions[r].size,  family->unit,    family->what,  ""};
      const double lacking = most.in(region.unit);
      if (std::abs(region.size) > kMostOverLacking * lacking) region.lacking = lacking;
      if (family->names.empty()) {
        region.size_sd = regions[r].sd;
        region.at = regions[r].at;
      }
      if (family->variable == GapVariable::clip) {  // a clip as a whole
        const auto& clip = set.clips[static_cast<std::size_t>(std::lround(regions[r].from))];
        const bool named = std::any_of(diagnosis.regions.begin(), diagnosis.regions.end(),
                                       [&](const GapRegion& other) { return other.clip == clip.name; });
        if (named) continue;  // by a function that explains it better
        region.variable = GapVariable::time;
        region.clip = clip.name;
        region.from = 0.0;
        region.to = clip.duration_s;
      }
      diagnosis.regions.push_back(region);
    }
  }
}

bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis) {
  double most = kLeastEvidenceOfRegion;
  for (const UnnamedFamily& family : families) most = std::max(most, family.log_evidence);
  bool any = false;
  for (const FrameEffect& frame : frames) {
    if (!frame.run || frame.in_runs < kLeastEvidenceOfRegion || frame.log_evidence + frame.in_runs < most) continue;
    const std::string clip = frame.run->clip ? set.clips[*frame.run->clip].name : "";
    diagnosis.regions.push_back({GapVariable::time, frame.run->from_s, frame.run->to_s, frame.run->excess,
                                 frame.run->size_m, "m", GapKind::displacement, clip});
    any = true;
  }
  return any;
}

void add_image_regions(const ImageEvidence& images, Diagnosis& diagnosis) {
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    const std::optional<InImages>& where = effect_of(effect.id).in_images;
    for (const ImageFinding& finding : images.findings) {
      if (finding.id != effect.id || !finding.seen || !where || finding.parameters.empty()) continue;
      GapRegion region;
      region.variable = where->along_track && images.clips.front().down ? GapVariable::row : where->over;
      region.what = where->what;
      const core::ImageRecord& record = *images.clips.front().record;
      region.to = region.variable == GapVariable::column ? record.width_px
                  : region.variable == GapVariable::row  ? record.height_px
                  : record.scene.empty()                 ? 0.0
                                                         : record.scene.back().t_s;
      if (region.variable == GapVariable::speed && images.clips.front().px_per_m > 0.0) {
        region.to = images.fastest_px_s / images.clips.front().px_per_m;
      }
      const DiagnosedParameter& size = finding.parameters.front();
      region.size = size.value;
      region.unit = size.key;
      region.excess = std::sqrt(2.0 * finding.log_evidence);
      diagnosis.regions.push_back(region);
    }
  }
}

}  // namespace glidelab::diagnose
