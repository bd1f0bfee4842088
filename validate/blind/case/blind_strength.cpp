#include "validate/blind/case/blind_strength.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/math/dense.h"
#include "diagnose/effects/effect_list.h"

namespace glidelab::validate {
namespace {

constexpr double kLeastOfWantedGain = 0.9;  // part that is enough where the largest size is too small for it
constexpr int kBisections = 24;

using Seen = std::vector<std::vector<double>>;

std::vector<double> clip_with(const BlindDesign& design, std::size_t clip, const std::vector<BlindPut>& puts,
                              std::size_t* steps = nullptr) {
  BlindFilm film = nominal_film(design, design.clips[clip]);
  for (const BlindPut& put : puts) put.effect->put(put.size, clip, film);
  return seen_positions(design.clips[clip], film, steps);
}

Seen seen_with(const BlindDesign& design, const std::vector<BlindPut>& puts, std::size_t* steps = nullptr) {
  Seen seen;
  for (std::size_t c = 0; c < design.clips.size(); ++c) seen.push_back(clip_with(design, c, puts, steps));
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

/// The nominal law of a design with effects in it.
struct FittedLaw {
  BlindDesign design;
  std::vector<BlindPut> puts;
};

/// What a fit of a law may change, with what is stated of it.
struct Nuisance {
  std::function<void(FittedLaw&, double)> change;
  double step = 0.0;
  double most = 0.0;                                      // that it may change by at once
  double sd = std::numeric_limits<double>::infinity();    // as it is stated
  std::optional<std::size_t> clip = {};                   // of one clip only
  std::function<double(const FittedLaw&)> positive = {};  // stays so: the law has no friction or drag that drives
};

std::vector<Nuisance> nuisances(const BlindDesign& design, const std::vector<BlindPut>& puts) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  std::vector<Nuisance> list;
  list.push_back(
      {[](FittedLaw& l, double by) { l.design.k_n_s_m += by; }, 1e-4 * design.k_n_s_m, 0.4 * design.k_n_s_m});
  list.back().positive = [](const FittedLaw& l) { return l.design.k_n_s_m; };
  list.push_back({[](FittedLaw& l, double by) { l.design.mu += by; }, 1e-6, 0.02});
  list.back().positive = [](const FittedLaw& l) { return l.design.mu; };
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    list.push_back({[g](FittedLaw& l, double by) { l.design.groups[g].true_rad += by; }, 1e-6, 0.03,
                    design.groups[g].stated_sd_rad.value_or(0.35)});
  }
  for (std::size_t m = 0; m < design.masses.size(); ++m) {
    if (!(design.masses[m].sd_kg > 0.0)) continue;
    list.push_back(
        {[m](FittedLaw& l, double by) { l.design.masses[m].true_kg += by; }, 1e-5, 0.01, design.masses[m].sd_kg});
  }
  const BlindCalibration& open = design.calibration;
  if (open.scale_sd > 0.0) {
    list.push_back({[](FittedLaw& l, double by) { l.design.calibration.scale += by; }, 1e-5, 0.1, open.scale_sd});
    list.push_back({[](FittedLaw& l, double by) { l.design.calibration.bend_1_m += by; }, 1e-5, 0.1, open.bend_sd_1_m});
    list.push_back(
        {[](FittedLaw& l, double by) { l.design.calibration.cubic_1_m2 += by; }, 1e-5, 0.1, open.cubic_sd_1_m2});
  }
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    list.push_back({[c](FittedLaw& l, double by) { l.design.clips[c].x0_m += by; }, 1e-5, 0.1, kFree, c});
    list.push_back({[c](FittedLaw& l, double by) { l.design.clips[c].v0_m_s += by; }, 1e-5, 0.3, kFree, c});
  }
  for (std::size_t p = 0; p < puts.size(); ++p) {
    // Whole frames are missing or not: positions have no derivative by their share, which stays as it is.
    if (puts[p].effect->id == diagnose::ids::dropped_frames) continue;
    const double size = puts[p].size;
    list.push_back({[p](FittedLaw& l, double by) { l.puts[p].size += by; }, 1e-3 * size, 0.3 * size});
    list.back().positive = [p](const FittedLaw& l) { return l.puts[p].size; };
  }
  return list;
}

/// The last step of a fit: derivatives over `scale`, what is left of the positions and of what is stated, and chi².
struct SettledFit {
  Eigen::MatrixXd columns;
  Eigen::VectorXd left;
  double chi2 = 0.0;
};

/// A law's fit to positions that something else made: Gauss and Newton's steps from the true values.
class LawFit {
 public:
  /// The nominal law with the effects of `puts` in it.
  explicit LawFit(const BlindDesign& design, const std::vector<BlindPut>& puts = {})
      : design_(design), puts_(puts), list_(nuisances(design, puts)), without_(seen_with(design, puts)) {}

  /// Half of chi² that is left; a size of `more` is fitted as well. 0 where the fit does not settle.
  double misfit(const Seen& seen, const std::optional<Eigen::VectorXd>& more = {}) const {
    const std::optional<SettledFit> settled = fit(seen, more);
    return settled ? 0.5 * settled->chi2 : 0.0;
  }

  /// Nothing where the fit does not settle: how strong the effect is cannot be told, and another is drawn.
  std::optional<SettledFit> fit(const Seen& seen, const std::optional<Eigen::VectorXd>& more = {}) const {
    constexpr int kMostFitSteps = 60;              // of which a glider that comes to rest elsewhere takes some ten
    constexpr std::size_t kMostWork = 20'000'000;  // steps of motions: a hundred times what a fit takes
    constexpr double kMostRelativeChange =
        0.01;  // of chi² where it has settled: far less than the classes of strength are wide
    constexpr double kMostChangeOfChi2 = 0.01;  // where the nominal law takes up all of it
    constexpr double kMostDecrease = 0.9;       // part that one step may take of what must stay positive
    const Eigen::Index many = std::ssize(list_) + (more ? 1 : 0);
    FittedLaw fitted{design_, puts_};
    Eigen::VectorXd at = Eigen::VectorXd::Zero(many);
    double last = 0.0;
    bool whole = true;  // the last step was
    std::size_t work = 0;
    for (int step = 0; step < kMostFitSteps; ++step) {
      const Seen now = step == 0 ? without_ : seen_with(fitted.design, fitted.puts, &work);
      const Eigen::VectorXd d = difference(seen, now, design_.noise_sd_m);
      Eigen::MatrixXd columns = derivatives(fitted, now, many, &work);
      if (work > kMostWork) return std::nullopt;
      Eigen::VectorXd left = Eigen::VectorXd::Zero(columns.rows()), scale = Eigen::VectorXd::Ones(many);
      left.head(d.size()) = d;
      for (Eigen::Index n = 0; n < std::ssize(list_); ++n) {
        const double sd = list_[static_cast<std::size_t>(n)].sd;
        if (std::isfinite(sd)) left[d.size() + n] = -at[n] / sd;
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
      if (!std::isfinite(chi2)) return std::nullopt;
      if (step > 0 && whole && std::abs(chi2 - last) <= std::max(kMostChangeOfChi2, kMostRelativeChange * chi2)) {
        return SettledFit{std::move(columns), std::move(left), chi2};
      }
      last = chi2;
      const Eigen::VectorXd change = by.cwiseQuotient(scale);
      double part = 1.0;  // of a step that would leave the neighbourhood in which it was found
      for (std::size_t n = 0; n < list_.size(); ++n) {
        const double by_one = change[static_cast<Eigen::Index>(n)];
        part = std::min(part, list_[n].most / std::max(1e-300, std::abs(by_one)));
        const auto& positive = list_[n].positive;
        if (positive && by_one < 0.0) part = std::min(part, kMostDecrease * positive(fitted) / -by_one);
      }
      whole = part == 1.0;
      at += part * change;
      fitted = {design_, puts_};
      for (std::size_t n = 0; n < list_.size(); ++n) list_[n].change(fitted, at[static_cast<Eigen::Index>(n)]);
      if (is_lost(fitted.design)) return std::nullopt;
    }
    return std::nullopt;
  }

  /// The first step alone, to first order in all that acts; a size of each of `more` is fitted as well.
  SettledFit first_step(const Seen& seen, const std::vector<Eigen::VectorXd>& more) const {
    const Eigen::VectorXd d = difference(seen, without_, design_.noise_sd_m);
    const Eigen::Index own = std::ssize(list_), many = own + std::ssize(more);
    if (at_start_.size() == 0) at_start_ = derivatives({design_, puts_}, without_, own, nullptr);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(at_start_.rows(), many);
    columns.leftCols(own) = at_start_;
    for (std::size_t m = 0; m < more.size(); ++m) {
      columns.col(own + static_cast<Eigen::Index>(m)).head(d.size()) = more[m];
    }
    for (Eigen::Index n = 0; n < many; ++n) columns.col(n) /= std::max(columns.col(n).norm(), 1e-12);
    Eigen::VectorXd left = Eigen::VectorXd::Zero(columns.rows());
    left.head(d.size()) = d;
    left -= base::product(columns, base::least_squares(columns, left));
    const double chi2 = left.squaredNorm();
    return {std::move(columns), std::move(left), chi2};
  }

  const Seen& without() const { return without_; }
  const std::vector<Nuisance>& parameters() const { return list_; }

 private:
  /// A mass of another glider: what the fit is after then is no law of this one.
  bool is_lost(const BlindDesign& fitted) const {
    constexpr double kLeft = 0.5;  // of a mass
    for (std::size_t m = 0; m < fitted.masses.size(); ++m) {
      if (!(fitted.masses[m].true_kg > kLeft * design_.masses[m].true_kg)) return true;
    }
    return false;
  }

  /// By each of the list, and what is stated of it in rows below; `many` columns, the rest 0.
  Eigen::MatrixXd derivatives(const FittedLaw& at, const Seen& now, Eigen::Index many, std::size_t* work) const {
    Eigen::Index points = 0;
    for (const auto& clip : now) points += std::ssize(clip);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(points + many, many);
    for (Eigen::Index n = 0; n < std::ssize(list_); ++n) {
      const Nuisance& one = list_[static_cast<std::size_t>(n)];
      columns.col(n).head(points) = derivative(at, one, now, work);
      if (std::isfinite(one.sd)) columns(points + n, n) = 1.0 / one.sd;
    }
    return columns;
  }

  Eigen::VectorXd derivative(const FittedLaw& at, const Nuisance& one, const Seen& now, std::size_t* work) const {
    FittedLaw changed = at;
    one.change(changed, one.step);
    Seen seen = now;
    for (std::size_t c = 0; c < at.design.clips.size(); ++c) {
      if (!one.clip || *one.clip == c) seen[c] = clip_with(changed.design, c, changed.puts, work);
    }
    return difference(seen, now, design_.noise_sd_m) / one.step;
  }

  const BlindDesign& design_;
  std::vector<BlindPut> puts_;
  std::vector<Nuisance> list_;
  Seen without_;
  mutable Eigen::MatrixXd at_start_;  // derivatives there, once they are asked for
};

std::size_t finite_positions(const Seen& seen) {
  std::size_t finite = 0;
  for (const auto& clip : seen) {
    finite +=
        static_cast<std::size_t>(std::count_if(clip.begin(), clip.end(), [](double x) { return std::isfinite(x); }));
  }
  return finite;
}

/// Sum over clips of e' (I - H)^-1 e, e what is left of a clip and H its own block of the projector on all parameters:
/// what is left of it when it is held out, its own start fitted to it, over the covariance of that prediction.
double held_out_chi2(const BlindDesign& design, const LawFit& law, const SettledFit& fit) {
  constexpr double kRidge = 1e-9;  // of columns of length 1: what no other clip knows of
  std::vector<Eigen::Index> shared;
  std::vector<std::vector<Eigen::Index>> starts(design.clips.size());
  for (Eigen::Index n = 0; n < fit.columns.cols(); ++n) {
    std::optional<std::size_t> clip;
    if (n < std::ssize(law.parameters())) clip = law.parameters()[static_cast<std::size_t>(n)].clip;
    (clip ? starts[*clip] : shared).push_back(n);
  }
  Eigen::Index points = 0;
  for (const BlindClip& clip : design.clips) points += static_cast<Eigen::Index>(clip.frames);
  const Eigen::MatrixXd stated = fit.columns.bottomRows(fit.columns.rows() - points)(Eigen::all, shared);
  std::vector<Eigen::MatrixXd> inform;
  std::vector<Eigen::VectorXd> pull;
  Eigen::MatrixXd all = base::transposed_product(stated, stated);
  all.diagonal().array() += kRidge;
  double chi2 = 0.0;
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    const auto frames = static_cast<Eigen::Index>(design.clips[c].frames);
    const Eigen::MatrixXd rows = fit.columns.middleRows(row, frames);
    const Eigen::VectorXd left = fit.left.segment(row, frames);
    const Eigen::MatrixXd own = base::orthonormal_columns(rows(Eigen::all, starts[c]), 1e-12);
    Eigen::MatrixXd of_all = rows(Eigen::all, shared);
    of_all -= base::product(own, base::transposed_product(own, of_all));
    inform.push_back(base::transposed_product(of_all, of_all));
    pull.emplace_back(base::transposed_product(of_all, left));
    all += inform.back();
    chi2 += left.squaredNorm();
    row += frames;
  }
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    const Eigen::MatrixXd others = all - inform[c];
    chi2 += pull[c].dot(base::solve_positive(others, pull[c]).col(0));
  }
  return chi2;
}

}  // namespace

struct BlindDetection::Fit {
  explicit Fit(const BlindDesign& design) : nominal(design) {}
  LawFit nominal;
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

std::optional<double> BlindDetection::excess(const std::vector<BlindPut>& acting,
                                             const std::vector<BlindPut>& known) const {
  const Seen seen = seen_with(design_, acting);
  const std::size_t points = finite_positions(seen);
  if (points == 0) return std::nullopt;
  const LawFit with(design_, known);
  const LawFit& law = known.empty() ? fit_->nominal : with;
  const std::optional<SettledFit> settled = law.fit(seen);
  if (!settled) return std::nullopt;
  return held_out_chi2(design_, law, *settled) / static_cast<double>(points);
}

double BlindDetection::first_order_excess(const std::vector<BlindPut>& acting,
                                          const std::vector<BlindPut>& known) const {
  const LawFit& law = fit_->nominal;
  const Seen seen = seen_with(design_, acting);
  std::vector<Eigen::VectorXd> more;
  for (const BlindPut& put : known) {
    more.push_back(difference(seen_with(design_, {put}), law.without(), design_.noise_sd_m));
  }
  const auto points = static_cast<double>(std::max<std::size_t>(1, finite_positions(seen)));
  return held_out_chi2(design_, law, law.first_step(seen, more)) / points;
}

std::optional<BlindStrength> size_for(const BlindDetection& detection, const BlindEffect& effect, double wanted) {
  constexpr double kToleranceOfGain = 0.05;  // relative to the wanted one
  double low = 0.0, high = effect.largest;
  BlindStrength at{high, detection.gain(effect, high)};
  if (!(at.gain > kLeastOfWantedGain * wanted)) return std::nullopt;
  BlindStrength best = at;
  for (int i = 0; i < kBisections && std::abs(at.gain / wanted - 1.0) > kToleranceOfGain; ++i) {
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
  return std::abs(at.gain / wanted - 1.0) <= kToleranceOfGain ? at : best;
}

}  // namespace glidelab::validate
