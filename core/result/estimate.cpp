#include "core/result/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math/angles.h"
#include "base/math/distributions.h"
#include "core/math/quantile.h"

namespace glidelab::core {

double student_t975(double degrees) {
  if (!std::isfinite(degrees)) return kNormal95;
  return base::student_t_quantile(degrees, 0.975);
}

KnownVariance sum_of(const KnownVariance& one, const KnownVariance& other) {
  const double total = one.value + other.value;
  const auto spread = [](const KnownVariance& of) { return of.value > 0.0 ? of.value * of.value / of.degrees : 0.0; };
  const double per_degree = spread(one) + spread(other);
  return {total,
          per_degree > 0.0 ? std::max(1.0, total * total / per_degree) : std::numeric_limits<double>::infinity()};
}

Estimate estimate(double value, double sd, double degrees) {
  const double half = student_t975(degrees) * sd;
  return {value, sd, value - half, value + half};
}

Estimate estimate(double value, const KnownVariance& random, double known) {
  const double of_random = student_t975(random.degrees),
               of_known = student_t975(std::numeric_limits<double>::infinity());
  const double half = std::sqrt(of_random * of_random * random.value + of_known * of_known * known);
  return {value, std::sqrt(random.value + known), value - half, value + half};
}

double chi2_ratio_limit(double degrees) {
  const double variance = 2.0 / (9.0 * std::max(1.0, degrees));
  return std::pow(1.0 - variance + 3.0 * std::sqrt(variance), 3);
}

Quantity determined(const Estimate& estimate, std::optional<double> noise_sd) {
  Quantity quantity{estimate, {}};
  quantity.noise_sd = noise_sd;
  return quantity;
}

Quantity undetermined(AnyReason why) {
  return {std::nullopt, WhyUnknown{std::move(why)}};
}

std::optional<AnyReason> why_no_limit_velocity(const Estimate& k_over_m_1_s, unknown::RateNotPositive rate,
                                               const Estimate& a0_m_s2) {
  if (k_over_m_1_s.value - kNormal95 * k_over_m_1_s.sd <= 0.0) return rate;
  if (a0_m_s2.value - kNormal95 * a0_m_s2.sd <= 0.0) return unknown::InterceptNotPositive{};
  return {};
}

namespace {

constexpr double kLeastOff_deg = 0.5;  // of a reading without an uncertainty: how well a track is levelled
constexpr double kLeastOffSds = 3.0;
constexpr double kLeastGross_deg = 1.0, kLeastGrossShare = 0.25, kLeastGrossSds = 5.0;

/// What the motion tells about the inclination: a value, or a bound if the motion is in one direction only.
struct FoundIncline {
  double deg = 0.0, sd_deg = 0.0;
  int bound = 0;  ///< -1: at most this, +1: at least this
};

std::optional<FoundIncline> found_incline(const ConfigurationResult& found, double gravity_m_s2) {
  if (found.alpha_deg.estimate) return FoundIncline{found.alpha_deg.estimate->value, found.alpha_deg.estimate->sd};
  if (found.lines.size() != 1) return std::nullopt;
  const LineFit& line = found.lines.front();
  const double sine = line.a0_m_s2.value / gravity_m_s2;
  if (std::abs(sine) >= 1.0) return std::nullopt;
  const double sd_deg = base::kDegreesPerRad * line.a0_m_s2.sd / (gravity_m_s2 * std::sqrt(1.0 - sine * sine));
  return FoundIncline{base::kDegreesPerRad * std::asin(sine), sd_deg, line.direction};
}

/// The acceleration at v = 0 without friction, if it is gravity or more: no inclination can produce it. A line of one
/// direction also contains friction, which may be larger.
std::optional<double> beyond_gravity(const ConfigurationResult& found, double gravity_m_s2) {
  if (found.alpha_deg.estimate || found.lines.size() != 2) return std::nullopt;
  const double mean_m_s2 = 0.5 * (found.lines[0].a0_m_s2.value + found.lines[1].a0_m_s2.value);
  const double sd_m_s2 = 0.5 * std::hypot(found.lines[0].a0_m_s2.sd, found.lines[1].a0_m_s2.sd);
  if (std::abs(mean_m_s2) < gravity_m_s2 + kLeastGrossSds * sd_m_s2) return std::nullopt;
  return mean_m_s2;
}

}  // namespace

std::optional<InclineContradiction> incline_contradiction(const ConfigurationResult& found, double gravity_m_s2,
                                                          const StatedIncline& stated) {
  if (const auto mean_m_s2 = beyond_gravity(found, gravity_m_s2)) {
    InclineContradiction beyond;
    beyond.stated = stated;
    beyond.beyond_gravity = mean_m_s2;
    beyond.gravity_m_s2 = gravity_m_s2;
    beyond.off_deg = std::numeric_limits<double>::infinity();
    beyond.gross = true;
    return beyond;
  }
  const auto incline = found_incline(found, gravity_m_s2);
  if (!incline) return std::nullopt;
  const double above_deg = stated.deg - incline->deg;
  if ((incline->bound < 0 && above_deg < 0.0) || (incline->bound > 0 && above_deg > 0.0)) return std::nullopt;
  const double off_deg = std::abs(above_deg);
  const double sd_deg = std::hypot(incline->sd_deg, stated.sd_deg.value_or(0.0));
  if (off_deg < std::max(stated.sd_deg ? 0.0 : kLeastOff_deg, kLeastOffSds * sd_deg)) return std::nullopt;
  const bool gross =
      off_deg > std::max({kLeastGross_deg, kLeastGrossShare * std::abs(stated.deg), kLeastGrossSds * sd_deg});
  return InclineContradiction{stated, incline->deg, incline->sd_deg, incline->bound, {}, gravity_m_s2, off_deg, gross};
}

StatedIncline stated_incline(const ConfigurationResult& configuration) {
  return {configuration.incline_deg, configuration.incline_sd_deg, "incline_deg"};
}

namespace {

/// By the positions, or by the speeds where nothing else was measured.
double distance_m(const ClipResult& clip) {
  double least = HUGE_VAL, most = -HUGE_VAL, along = 0.0;
  for (std::size_t i = 0; i < clip.motion.size(); ++i) {
    const MotionPoint& point = clip.motion[i];
    if (i > 0) along += std::abs(point.v_m_s) * (point.t_s - clip.motion[i - 1].t_s);
    least = std::min(least, point.measured_m.value_or(HUGE_VAL));
    most = std::max(most, point.measured_m.value_or(-HUGE_VAL));
  }
  return most > least ? most - least : clip.speed_noise_m_s ? along : 0.0;
}

}  // namespace

void note_statements(std::vector<ConfigurationResult>& results, const std::vector<ClipResult>& clips,
                     double gravity_m_s2) {
  double least_kg = std::numeric_limits<double>::infinity();
  for (const ConfigurationResult& result : results) least_kg = std::min(least_kg, result.mass_kg);
  for (ConfigurationResult& result : results) {
    std::erase_if(result.notes, [](const Note& note) {
      return std::holds_alternative<MassInGrams>(note) || std::holds_alternative<InclineContradiction>(note);
    });
    if (result.mass_kg >= kMassRatio * least_kg) {
      result.notes.emplace_back(MassInGrams{result.mass_kg, least_kg});
    }
    // A mass that stands out against the lightest gets its own remark; here all masses may be in grams.
    const bool far = std::ranges::any_of(clips, [&](const ClipResult& clip) {
      return std::ranges::count(result.clips, clip.name) > 0 && distance_m(clip) > kLongestRun_m;
    });
    if (!far && result.mass_kg >= kLargestMass_kg && result.mass_kg < kMassRatio * least_kg) {
      result.notes.emplace_back(MassInGrams{result.mass_kg, {}});
    }
    if (result.incline_assumed) continue;
    const auto contradiction = incline_contradiction(result, gravity_m_s2, stated_incline(result));
    if (contradiction && (contradiction->gross || result.incline_sd_deg)) result.notes.emplace_back(*contradiction);
  }
}

}  // namespace glidelab::core
