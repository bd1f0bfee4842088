#include "core/motion/smoothing/smoother_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <cassert>
#include <cmath>
#include <span>

#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "core/motion/smoothing/noise.h"
#include "core/motion/smoothing/wiener_smoother.h"

namespace glidelab::core {

const std::vector<const Smoother*>& smoothers() {
  static const std::vector<const Smoother*> all{&cubic_smoother(), &kalman_smoother(), &spline_smoother()};
  return all;
}

std::vector<std::string> smoother_names() {
  std::vector<std::string> names;
  for (const Smoother* smoother : smoothers()) names.emplace_back(smoother->name());
  return names;
}

const Smoother* find_smoother(std::string_view name) {
  for (const Smoother* smoother : smoothers()) {
    if (smoother->name() == name) return smoother;
  }
  return nullptr;
}

void check_smoother(const std::string& name, bool bandwidth_asked_for) {
  const Smoother* smoother = find_smoother(name);
  if (smoother == nullptr) {
    const std::vector<std::string> names = smoother_names();
    throw base::InputError(
        base::Issue{"", 0, "smoother", fmt::format("\"{}\"", name),
                    fmt::format("one of {}{}", fmt::join(names, ", "), base::did_you_mean(name, names))});
  }
  if (bandwidth_asked_for && !smoother->takes_bandwidth()) {
    throw base::InputError(
        base::Issue{"", 0, "smoother", fmt::format("\"{}\" and a bandwidth", name),
                    fmt::format("one of them: only \"{}\" has a bandwidth, and this smoother finds its own strength",
                                kLocalPolynomial)});
  }
}

namespace {

class LocalCubicSmoother final : public Smoother {
 public:
  std::string_view name() const override { return kLocalPolynomial; }
  std::string_view words() const override { return "local cubic with a Gaussian kernel"; }
  bool takes_bandwidth() const override { return true; }

  SmoothedSeries smooth(const SmoothingInput& input) const override {
    assert(input.bandwidth_s && *input.bandwidth_s > 0.0 && input.t_s.size() == input.x_m.size());
    SmoothedSeries made;
    made.strength.smoother = name();
    made.strength.method = chosen_by::User{};
    made.strength.bandwidth_s = *input.bandwidth_s;
    made.strength.noise_sd_m = input.noise_sd_m ? *input.noise_sd_m : pilot_noise(input.t_s, input.x_m);
    made.points.resize(input.t_s.size());
    made.at.resize(input.at_s.size());
    if (input.rows) made.rows.resize(input.t_s.size());
    const bool along = !input.along_m.empty();
    if (along) {
      made.along.resize(input.t_s.size());
      made.along_at.resize(input.at_s.size());
    }
    const std::vector<double> factor =
        input.noise_factor.empty() ? std::vector<double>(input.t_s.size(), 1.0) : input.noise_factor;
    const SeriesNoise noise{{std::pow(made.strength.noise_sd_m, 2)}, factor};
    std::size_t a = 0;
    for (const SeriesPart& part : parts_of(input)) {
      const std::span t = std::span(input.t_s).subspan(part.first, part.count);
      const LocalCubic cubic(t, *input.bandwidth_s);
      const auto of_all = [&](std::optional<KernelRow> row) {
        if (row) row->first += part.first;
        return row;
      };
      const auto state = [&](const std::optional<KernelRow>& row,
                             const std::vector<double>& series_m) -> std::optional<SmoothedState> {
        if (!row) return {};
        const SmoothedPoint of = weighted_sums(*row, series_m);
        const Eigen::Matrix3d covariance = point_covariance(*row, *row, noise);
        return SmoothedState{of.x_m,
                             of.v_m_s,
                             of.a_m_s2,
                             std::sqrt(covariance(0, 0)),
                             std::sqrt(covariance(1, 1)),
                             std::sqrt(covariance(2, 2))};
      };
      for (std::size_t j = 0; j < part.count; ++j) {
        input.stop_check();
        const auto row = of_all(cubic.row_of_point(j));
        if (row) made.strength.parameters += row->weights->x[part.first + j - row->first];
        made.points[part.first + j] = state(row, input.x_m);
        if (along) made.along[part.first + j] = state(row, input.along_m);
        if (input.rows) made.rows[part.first + j] = row;
      }
      while (a < input.at_s.size() && input.at_s[a] < t.front()) ++a;
      for (; a < input.at_s.size() && input.at_s[a] <= t.back(); ++a) {
        const auto row = of_all(cubic.row(input.at_s[a]));
        made.at[a] = state(row, input.x_m);
        if (along) made.along_at[a] = state(row, input.along_m);
      }
    }
    return made;
  }
};

}  // namespace

const Smoother& cubic_smoother() {
  static const LocalCubicSmoother smoother;
  return smoother;
}

}  // namespace glidelab::core
