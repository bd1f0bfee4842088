#include "diagnose/fit/linearised_motion.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

using Global = ParameterLayout::Global;

/// As the fit wants it: what each parameter is changed by for a derivative.
double step_of(const Global& global, double at) {
  switch (global.kind) {
    case Global::Kind::k:
      return 1e-5 * std::max(0.05, std::abs(at));
    case Global::Kind::mu:
    case Global::Kind::alpha:
      return 1e-6;
    case Global::Kind::mass:
      return 1e-3;
    case Global::Kind::effect:
      return global.step;
    default:
      return 1e-3;
  }
}

Moved moved(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t i,
            const Lateness& late) {
  const TrackModel model = model_of(set, layout, at, i);
  return move(model, set.motions[i].t_s, late.empty() ? std::span<const double>() : std::span(late[i]));
}

}  // namespace

FitMotion linearise(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t i,
                    const Lateness& late, Derivatives derivatives) {
  const TrackedMotion& data = set.motions[i];
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  FitMotion of;
  Moved base = moved(set, layout, at, i, late);
  of.v_m_s = base.v_m_s;
  const auto& globals = layout.globals();
  const std::vector<double> shared = shared_errors(set, layout, at, i, base.x_m);
  std::vector<double> weight(data.t_s.size());
  for (std::size_t p = 0; p < weight.size(); ++p) weight[p] = data.outlier[p] ? 0.0 : 1.0 / data.sd_of(p);
  of.plain.resize(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(p);
    of.plain[p] = weight[q] * (data.x_m[q] - base.x_m[q] - shared[q]);
  }
  of.residual = whitened(data, of.plain);
  if (derivatives == Derivatives::none) return of;
  of.global = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(globals.size()));
  of.own = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(2 + layout.own().size()));
  FitPoint near = at;
  const bool central = derivatives == Derivatives::central;
  const auto fill = [&](double& parameter, double step, auto column) {
    const double kept = parameter;
    parameter = kept + step;
    const Moved above = moved(set, layout, near, i, late);
    parameter = kept - step;
    const Moved below = central ? moved(set, layout, near, i, late) : base;
    parameter = kept;
    const double apart = central ? 2.0 * step : step;
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      column[p] = weight[q] * (above.x_m[q] - below.x_m[q]) / apart;
    }
  };
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (!touches(set, globals[g], i)) continue;
    const auto column = static_cast<Eigen::Index>(g);
    if (globals[g].kind == Global::Kind::mode || globals[g].kind == Global::Kind::scale) {
      for (Eigen::Index p = 0; p < n; ++p) {
        const auto q = static_cast<std::size_t>(p);
        of.global(p, column) = weight[q] * (globals[g].kind == Global::Kind::mode ? data.shared_m[globals[g].index][q]
                                                                                  : data.scale_sd * base.x_m[q]);
      }
      continue;
    }
    fill(near.global[column], step_of(globals[g], near.global[column]), of.global.col(column));
  }
  for (Eigen::Index o = 0; o < of.own.cols(); ++o) {
    fill(near.own[i][o], o < 2 ? 1e-6 : layout.own()[static_cast<std::size_t>(o - 2)]->step, of.own.col(o));
  }
  of.global = whitened(data, std::move(of.global));
  of.own = whitened(data, std::move(of.own));
  return of;
}

}  // namespace glidelab::diagnose
