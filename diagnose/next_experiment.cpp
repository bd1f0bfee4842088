#include "diagnose/next_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/dense.h"
#include "diagnose/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDecides = 5.0;  // expected log likelihood at which a clip is worth recording
constexpr double kSlowest = 0.2;  // launch that is suggested, of the fastest one that there is

struct Candidate {
  std::string words;
  std::size_t group = 0;
  double mass_kg = 0.0;
  double v0_m_s = 0.0;
  double rate_hz = 0.0;
};

std::string speed_words(double v) {
  return fmt::format("{} at {:.2g} m/s", v < 0.0 ? "uphill" : "downhill", std::abs(v));
}

std::vector<Candidate> candidates_of(const TrackSet& set, const MotionFit& fit) {
  double slow = 1e9, fast = 0.0, rate = 0.0, light = 1e9, heavy = 0.0;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const double v = std::abs(fit.at.own[i][1]);
    slow = std::min(slow, v);
    fast = std::max(fast, v);
    rate = std::max(rate, set.clips[set.motions[i].clip].frame_rate_hz);
    light = std::min(light, set.masses[set.motions[i].mass].mass_kg);
    heavy = std::max(heavy, set.masses[set.motions[i].mass].mass_kg);
  }
  std::vector<Candidate> candidates;
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    const std::string where =
        set.groups.size() > 1 ? fmt::format(" on set-up \"{}\"", set.groups[g].name) : std::string();
    for (const int direction : {-1, 1}) {
      for (const double mass : {light, heavy, 1.6 * heavy, 0.6 * light}) {
        // Where a motion was released, half of the slowest launch is no launch.
        for (const double v : {std::max(0.5 * slow, kSlowest * fast), fast, 1.8 * fast}) {
          const bool new_mass = mass != light && mass != heavy;
          candidates.push_back({fmt::format("a launch {}{} with {}{:.0f} g", speed_words(direction * v), where,
                                            new_mass ? "the mass changed to " : "", 1000.0 * mass),
                                g, mass, direction * v, rate});
        }
      }
    }
  }
  return candidates;
}

/// Expected difference in log likelihood of one clip made by `a`, explained by `b` as well as it can.
double decides(const TrackSet& set, const MotionFit& a, const MotionFit& b, const Eigen::MatrixXd& covariance_b,
               const Candidate& candidate) {
  TrackSet one = set;
  one.motions.clear();
  one.clips = {{"next", candidate.rate_hz, 0.0, 0, 0.0}};
  one.masses.push_back({candidate.mass_kg, 0.0});
  TrackedMotion motion;
  motion.group = candidate.group;
  motion.mass = one.masses.size() - 1;
  motion.sd_m = set.motions.front().sd_m;
  motion.scale_sd = set.motions.front().scale_sd;
  const double span = set.motions.front().t_s.back() - set.motions.front().t_s.front();
  const auto frames = static_cast<std::size_t>(std::clamp(span * candidate.rate_hz, 20.0, 2000.0));
  for (std::size_t k = 0; k < frames; ++k) motion.t_s.push_back(static_cast<double>(k) / candidate.rate_hz);
  motion.outlier.assign(frames, 0);
  motion.x_m.assign(frames, 0.0);
  one.motions.push_back(motion);
  const double x0 = set.groups[candidate.group].x_mid_m + (candidate.v0_m_s < 0.0 ? 0.4 : -0.4);
  const auto point = [&](const MotionFit& fit) {
    FitPoint at{fit.at.global, {Eigen::VectorXd::Zero(fit.at.own.front().size())}};
    at.own[0][0] = x0;
    at.own[0][1] = candidate.v0_m_s;
    return at;
  };
  const TrackModel made = model_of(one, *a.layout, point(a), 0);
  one.motions[0].x_m = move(made, motion.t_s).x_m;
  const MotionFit seen = linearise_at(one, b.effects, point(b));
  const FitMotion& by = seen.motions.front();
  if (!by.residual.allFinite() || !by.global.allFinite() || !by.own.allFinite()) return 0.0;
  Eigen::MatrixXd normal = base::transposed_product(by.own, by.own);
  for (Eigen::Index o = 0; o < normal.rows(); ++o) normal(o, o) = normal(o, o) * (1.0 + 1e-12) + 1e-9;
  const Eigen::MatrixXd gain = base::solve_positive(normal, by.own.transpose());
  const Eigen::VectorXd u = by.residual - base::product(by.own, base::product(gain, by.residual));
  const Eigen::MatrixXd g = by.global - base::product(by.own, base::product(gain, by.global));
  // u'(1 + G C G')^-1 u with C = L L': by Woodbury.
  const base::SymmetricEigen eigen = base::symmetric_eigen(covariance_b);
  const Eigen::VectorXd root = eigen.values.cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXd gl = base::product(g, Eigen::MatrixXd(eigen.vectors * root.asDiagonal()));
  Eigen::MatrixXd inner = base::transposed_product(gl, gl);
  inner.diagonal().array() += 1.0;
  const Eigen::VectorXd along = base::transposed_product(gl, u);
  const Eigen::VectorXd taken = base::solve_positive(inner, along);
  return std::max(0.0, 0.5 * (u.squaredNorm() - along.dot(taken)));
}

bool holds(const std::vector<std::string>& ids, const char* id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Pairs that no further clip of the same kind can split.
std::string known_pair(const Diagnosis& diagnosis) {
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    std::vector<std::string> set = effect.equivalent_to;
    set.push_back(effect.id);
    if (holds(set, "scale_error") && holds(set, "frame_rate_error")) {
      return "Film a running stop-watch (it shows the frame rate) and measure a length on the track with a ruler (it "
             "shows "
             "the scale): no further clip of the glider tells a wrong scale from a wrong frame rate.";
    }
    if (holds(set, "camera_motion") && holds(set, "base_vibration")) {
      return "Keep a mark that is fixed to the table in the picture: it moves with the camera if the camera shakes, "
             "and "
             "stays if only the track does.";
    }
    if (holds(set, "direction_asymmetry") && (holds(set, "scale_error") || holds(set, "frame_rate_error"))) {
      return "Turn the track round (or the glider on it) and record the same launches again: an asymmetry of the "
             "glider "
             "turns with it, a wrong scale does not.";
    }
  }
  return {};
}

std::string for_unknown(const Diagnosis& diagnosis) {
  const std::string variable = diagnosis.regions.empty() ? "" : diagnosis.regions.front().variable;
  if (variable == "x_m") {
    return "Move the camera along the track by a third of the view and record the same launches again: what belongs to "
           "the track stays at its place on it, what belongs to the picture moves.";
  }
  if (variable == "v_m_s") {
    return "Record launches at two further speeds, with one mass and on one inclination: the force that is missing "
           "depends on the speed, and its shape tells what it is.";
  }
  if (variable == "mass_kg") return "Record a further mass, half way between two others, launched both ways.";
  return "Repeat one of the launches three times without changing anything: what differs between the repetitions is no "
         "law of motion.";
}

}  // namespace

std::string next_experiment(const TrackSet& set, const Comparison& comparison, const Diagnosis& diagnosis) {
  if (diagnosis.verdict == "unknown") return for_unknown(diagnosis);
  const std::string pair = known_pair(diagnosis);
  if (!pair.empty()) return pair;
  // The leading explanation that has a fit, and its strongest rival of other effects.
  const Hypothesis* first = nullptr;
  const Hypothesis* rival = nullptr;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed || hypothesis.fit < 0) continue;
    if (first == nullptr) {
      first = &hypothesis;
    } else if (rival == nullptr && hypothesis.effects.size() <= 1) {
      rival = &hypothesis;
    }
  }
  if (first == nullptr || rival == nullptr) return "Repeat one launch of each kind: the more clips, the surer.";
  const auto motion_of = [&](const Hypothesis& one) {
    return comparison.fits[static_cast<std::size_t>(one.fit)].effects;
  };
  if (!first->effects.empty() && motion_of(*first).empty() && motion_of(*rival).empty()) {
    return "It shows in single frames: no other launch tells more of it. Record the same launch once more with less "
           "for "
           "the camera to do (fewer pixels, more light, its own time stamps written), and see whether it goes.";
  }
  const MotionFit& a = comparison.fits[static_cast<std::size_t>(first->effects.empty() ? rival->fit : first->fit)];
  const MotionFit& b = comparison.fits[static_cast<std::size_t>(first->effects.empty() ? first->fit : rival->fit)];
  const Eigen::MatrixXd covariance = common_covariance(b);
  double best = 0.0;
  const Candidate* choice = nullptr;
  const std::vector<Candidate> candidates = candidates_of(set, comparison.fits.front());
  for (const Candidate& candidate : candidates) {
    const double gain = decides(set, a, b, covariance, candidate);
    if (std::isfinite(gain) && gain > best) {
      best = gain;
      choice = &candidate;
    }
  }
  const auto name = [](const MotionFit& fit) {
    return fit.effects.empty() ? std::string("nothing") : std::string(effect_list()[fit.effects.front()].id);
  };
  if (choice == nullptr || best < kDecides) {
    return fmt::format(
        "One more clip would hardly split {} from {}: a lower noise (a longer lens, a larger marker, more frames a "
        "second) "
        "would.",
        name(a), name(b));
  }
  return fmt::format(
      "Record {}: of {} possible clips this one would tell {} from {} best (expected log likelihood {:.3g}).",
      choice->words, candidates.size(), name(a), name(b), best);
}

}  // namespace glidelab::diagnose
