#include "validate/blind/case/blind_strength.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/math/dense.h"

namespace glidelab::validate {
namespace {

constexpr double kReached = 0.9;  // of the wanted gain, where the largest size is too small for it
constexpr int kBisections = 24;

using Seen = std::vector<std::vector<double>>;

Seen seen_with(const BlindDesign& design, const std::vector<BlindPut>& puts) {
  Seen seen;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    BlindFilm film = nominal_film(design, design.clips[c]);
    for (const BlindPut& put : puts) put.effect->put(put.size, c, film);
    seen.push_back(seen_positions(design.clips[c], film));
  }
  return seen;
}

/// Positions that count, one after the other, over the noise; where one of the two rests, both say nothing.
Eigen::VectorXd difference(const Seen& a, const Seen& b, double sd) {
  std::vector<double> d;
  for (std::size_t c = 0; c < a.size(); ++c) {
    for (std::size_t k = 0; k < a[c].size(); ++k) {
      const double off = (a[c][k] - b[c][k]) / sd;
      d.push_back(std::isfinite(off) ? off : 0.0);
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(d.data(), std::ssize(d));
}

/// What a fit of the nominal law may change, with what is stated of it.
struct Nuisance {
  std::function<void(BlindDesign&, double)> change;
  double step = 0.0;
  double most = 0.0;                                    // that it may change by at once
  double sd = std::numeric_limits<double>::infinity();  // as it is stated
  std::optional<std::size_t> clip = {};                 // of one clip only
  double BlindDesign::*positive = nullptr;              // stays so: the law has no friction or drag that drives
};

std::vector<Nuisance> nuisances(const BlindDesign& design) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  std::vector<Nuisance> list;
  list.push_back({[](BlindDesign& d, double by) { d.k_n_s_m += by; }, 1e-4 * design.k_n_s_m, 0.4 * design.k_n_s_m});
  list.back().positive = &BlindDesign::k_n_s_m;
  list.push_back({[](BlindDesign& d, double by) { d.mu += by; }, 1e-6, 0.02});
  list.back().positive = &BlindDesign::mu;
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    list.push_back({[g](BlindDesign& d, double by) { d.groups[g].true_rad += by; }, 1e-6, 0.03,
                    design.groups[g].stated_sd_rad.value_or(0.35)});
  }
  for (std::size_t m = 0; m < design.masses.size(); ++m) {
    if (!(design.masses[m].sd_kg > 0.0)) continue;
    list.push_back({[m](BlindDesign& d, double by) { d.masses[m].true_kg += by; }, 1e-5, 0.01, design.masses[m].sd_kg});
  }
  const BlindCalibration& open = design.calibration;
  if (open.scale_sd > 0.0) {
    list.push_back({[](BlindDesign& d, double by) { d.calibration.scale += by; }, 1e-5, 0.1, open.scale_sd});
    list.push_back({[](BlindDesign& d, double by) { d.calibration.bend_1_m += by; }, 1e-5, 0.1, open.bend_sd_1_m});
    list.push_back({[](BlindDesign& d, double by) { d.calibration.cubic_1_m2 += by; }, 1e-5, 0.1, open.cubic_sd_1_m2});
  }
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    list.push_back({[c](BlindDesign& d, double by) { d.clips[c].x0_m += by; }, 1e-5, 0.1, kFree, c});
    list.push_back({[c](BlindDesign& d, double by) { d.clips[c].v0_m_s += by; }, 1e-5, 0.3, kFree, c});
  }
  return list;
}

/// The nominal law's fit to positions that something else made: Gauss and Newton's steps from the true values.
class NominalFit {
 public:
  explicit NominalFit(const BlindDesign& design)
      : design_(design), list_(nuisances(design)), without_(seen_with(design, {})) {}

  /// Half of chi² that is left; a size of `more` is fitted as well. 0 where the fit does not settle.
  double misfit(const Seen& seen, const std::optional<Eigen::VectorXd>& more = {}) const {
    constexpr int kMostFitSteps = 60;  // of which a glider that comes to rest elsewhere takes some ten
    constexpr double kSettled = 0.01;  // of chi²: far less than the classes of strength are wide
    constexpr double kNothing = 0.01;  // chi²: the nominal law takes up all of it
    constexpr double kDown = 0.9;      // of what must stay positive, in one step
    const Eigen::Index many = std::ssize(list_) + (more ? 1 : 0);
    BlindDesign fitted = design_;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(many);
    double last = 0.0;
    bool whole = true;  // the last step was
    for (int step = 0; step < kMostFitSteps; ++step) {
      const Seen now = step == 0 ? without_ : seen_with(fitted, {});
      const Eigen::VectorXd d = difference(seen, now, design_.noise_sd_m);
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(d.size() + many, many);
      Eigen::VectorXd left = Eigen::VectorXd::Zero(columns.rows()), scale = Eigen::VectorXd::Ones(many);
      left.head(d.size()) = d;
      for (Eigen::Index n = 0; n < std::ssize(list_); ++n) {
        const Nuisance& one = list_[static_cast<std::size_t>(n)];
        columns.col(n).head(d.size()) = derivative(fitted, one, now);
        if (!std::isfinite(one.sd)) continue;
        columns(d.size() + n, n) = 1.0 / one.sd;
        left[d.size() + n] = -at[n] / one.sd;
      }
      if (more) {
        columns.col(many - 1).head(d.size()) = *more;
        left.head(d.size()) -= at[many - 1] * *more;
      }
      // Columns in units of what the data know of them: least squares are then well conditioned.
      for (Eigen::Index n = 0; n < many; ++n) {
        scale[n] = std::max(columns.col(n).norm(), 1e-12);
        columns.col(n) /= scale[n];
      }
      const Eigen::VectorXd by = base::least_squares(columns, left);
      left -= base::product(columns, by);
      const double chi2 = left.squaredNorm();
      if (!std::isfinite(chi2)) return 0.0;
      if (step > 0 && whole && std::abs(chi2 - last) <= std::max(kNothing, kSettled * chi2)) return 0.5 * chi2;
      last = chi2;
      const Eigen::VectorXd change = by.cwiseQuotient(scale);
      double part = 1.0;  // of a step that would leave the neighbourhood in which it was found
      for (std::size_t n = 0; n < list_.size(); ++n) {
        const double by_one = change[static_cast<Eigen::Index>(n)];
        part = std::min(part, list_[n].most / std::max(1e-300, std::abs(by_one)));
        const auto positive = list_[n].positive;
        if (positive != nullptr && by_one < 0.0) part = std::min(part, kDown * fitted.*positive / -by_one);
      }
      whole = part == 1.0;
      at += part * change;
      fitted = design_;
      for (std::size_t n = 0; n < list_.size(); ++n) list_[n].change(fitted, at[static_cast<Eigen::Index>(n)]);
      if (is_lost(fitted)) return 0.0;
    }
    return 0.0;  // the fit does not settle: how strong the effect is cannot be told, and another is drawn
  }

  const Seen& without() const { return without_; }

 private:
  /// A mass of another glider: what the fit is after then is no law of this one.
  bool is_lost(const BlindDesign& fitted) const {
    constexpr double kLeft = 0.5;  // of a mass
    for (std::size_t m = 0; m < fitted.masses.size(); ++m) {
      if (!(fitted.masses[m].true_kg > kLeft * design_.masses[m].true_kg)) return true;
    }
    return false;
  }

  Eigen::VectorXd derivative(const BlindDesign& at, const Nuisance& one, const Seen& now) const {
    BlindDesign changed = at;
    one.change(changed, one.step);
    Seen seen = now;
    for (std::size_t c = 0; c < at.clips.size(); ++c) {
      if (!one.clip || *one.clip == c) {
        seen[c] = seen_positions(changed.clips[c], nominal_film(changed, changed.clips[c]));
      }
    }
    return difference(seen, now, design_.noise_sd_m) / one.step;
  }

  const BlindDesign& design_;
  std::vector<Nuisance> list_;
  Seen without_;
};

}  // namespace

struct BlindDetection::Fit {
  explicit Fit(const BlindDesign& design) : nominal(design) {}
  NominalFit nominal;
};

BlindDetection::BlindDetection(const BlindDesign& design) : design_(design), fit_(std::make_unique<Fit>(design)) {
  for (const BlindClip& clip : design.clips) {
    const BlindFilm film = nominal_film(design, clip);
    speed_m_s_.emplace_back();
    for (const BlindSample& s : blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s)) {
      speed_m_s_.back().push_back(s.v_m_s);
    }
  }
}

BlindDetection::~BlindDetection() = default;

double BlindDetection::gain(const BlindEffect& effect, double size) const {
  if (effect.gain) return effect.gain(size, design_.noise_sd_m, speed_m_s_);
  return fit_->nominal.misfit(seen_with(design_, {{&effect, size}}));
}

double BlindDetection::gain_beside(const BlindPut& mine, const BlindPut& other) const {
  const Eigen::VectorXd of_other = difference(seen_with(design_, {other}), fit_->nominal.without(), design_.noise_sd_m);
  return fit_->nominal.misfit(seen_with(design_, {mine, other}), of_other);
}

std::optional<BlindStrength> size_for(const BlindDetection& detection, const BlindEffect& effect, double wanted) {
  constexpr double kNear = 0.05;
  double low = 0.0, high = effect.largest;
  BlindStrength at{high, detection.gain(effect, high)};
  if (!(at.gain > kReached * wanted)) return std::nullopt;
  BlindStrength best = at;
  for (int i = 0; i < kBisections && std::abs(at.gain / wanted - 1.0) > kNear; ++i) {
    double size = at.size * std::sqrt(wanted / std::max(at.gain, 1e-6 * wanted));
    if (!(size > low) || !(size < high) || i % 4 == 3) size = 0.5 * (low + high);
    at = {size, detection.gain(effect, size)};
    if (at.gain < wanted) {
      low = size;
    } else {
      high = size;
      best = at;
    }
  }
  return std::abs(at.gain / wanted - 1.0) <= kNear ? at : best;
}

}  // namespace glidelab::validate
