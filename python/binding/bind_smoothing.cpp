/// The smoother and the bandwidth rules on their own. Times and values are read in numpy's memory.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "core/math/quantile.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/motion/smoothing/noise.h"
#include "core/motion/smoothing/smoother_list.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/watched_work.h"
#include "report/analysis/note_words.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

constexpr std::array<std::pair<const char*, core::Kernel>, 5> kKernels = {{{"gaussian", core::Kernel::gaussian},
                                                                           {"epanechnikov", core::Kernel::epanechnikov},
                                                                           {"tricube", core::Kernel::tricube},
                                                                           {"uniform", core::Kernel::uniform},
                                                                           {"bimodal", core::Kernel::bimodal}}};
constexpr int kLeastOrder = 1, kMostOrder = 5;  // of core::PolynomialOptions

[[noreturn]] void refuse(std::string key, std::string found, std::string expected) {
  throw base::InputError(base::Issue{"", 0, std::move(key), std::move(found), std::move(expected)});
}

core::Kernel kernel_of(const std::string& name) {
  for (const auto& [known, kernel] : kKernels) {
    if (name == known) return kernel;
  }
  std::vector<std::string> names;
  for (const auto& [known, kernel] : kKernels) names.emplace_back(known);
  refuse("kernel", fmt::format("\"{}\"", name),
         fmt::format("one of {}{}", fmt::join(names, ", "), base::did_you_mean(name, names)));
}

/// Checks what the smoother asserts about the times and the values that belong to them.
void check_series(std::span<const double> t_s, std::span<const double> values) {
  if (values.size() != t_s.size()) {
    refuse("x_m", fmt::format("{} numbers", values.size()), fmt::format("as many as times, {}", t_s.size()));
  }
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (!std::isfinite(t_s[i])) refuse(fmt::format("t_s[{}]", i), fmt::format("{}", t_s[i]), "a finite number");
    if (!std::isfinite(values[i])) refuse(fmt::format("x_m[{}]", i), fmt::format("{}", values[i]), "a finite number");
    if (i > 0 && t_s[i] <= t_s[i - 1]) {
      refuse(fmt::format("t_s[{}]", i), fmt::format("{}", t_s[i]), fmt::format("a time above {}", t_s[i - 1]));
    }
  }
}

core::PolynomialOptions options_of(double bandwidth_s, int order, const std::string& kernel) {
  if (!(std::isfinite(bandwidth_s) && bandwidth_s > 0.0)) {
    refuse("bandwidth_s", fmt::format("{}", bandwidth_s), "a time in seconds above 0");
  }
  if (order < kLeastOrder || order > kMostOrder) {
    refuse("order", fmt::format("{}", order), fmt::format("{} to {}", kLeastOrder, kMostOrder));
  }
  core::PolynomialOptions options;
  options.order = order;
  options.kernel = kernel_of(kernel);
  options.bandwidth_s = bandwidth_s;
  return options;
}

void check_noise(const std::optional<double>& noise_m) {
  if (noise_m && !(std::isfinite(*noise_m) && *noise_m >= 0.0)) {
    refuse("noise_m", fmt::format("{}", *noise_m), "a number of metres of 0 or more");
  }
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// An array of `count` rows x, v, a, each of n numbers.
py::array_t<double> rows(std::size_t count, std::size_t n) {
  return py::array_t<double>({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(n)});
}

void put(const std::optional<core::SmoothedPoint>& point, std::size_t i, std::size_t n, double* out) {
  out[i] = point ? point->x_m : kNone;
  out[n + i] = point ? point->v_m_s : kNone;
  out[2 * n + i] = point ? point->a_m_s2 : kNone;
}

/// work(stop_check) without the interpreter's lock, ended by Ctrl-C.
template <typename Work>
auto watched(const Work& work) {
  WatchedWork watch{py::none()};
  return watch.run([&](const base::Progress&) { return work([&] { watch.throw_if_stopped(); }); });
}

/// The same for the local polynomial, whose work for few points takes less time than a person needs to press Ctrl-C.
template <typename Work>
void watched(std::size_t points, const Work& work) {
  constexpr std::size_t kFew = 4000;  // at most 1.6e7 weights, 0.2 s
  if (points > kFew) return watched(work);
  const py::gil_scoped_release without_lock;
  work(base::never_stop);
}

/// x, v and a at the times of the points, and below these their standard deviations if the noise is stated.
py::array_t<double> smooth(const Vector& times, const Vector& positions, double bandwidth_s, int order,
                           const std::string& kernel, std::optional<double> noise_m) {
  const std::span<const double> t_s = span_of(times), x_m = span_of(positions);
  check_series(t_s, x_m);
  const core::PolynomialOptions options = options_of(bandwidth_s, order, kernel);
  check_noise(noise_m);
  const std::size_t n = t_s.size();
  py::array_t<double> result = rows(noise_m ? 6 : 3, n);
  double* const out = result.mutable_data();
  watched(n, [&](const base::StopCheck& stop_check) {
    const core::LocalPolynomial smoother(t_s, options);
    const std::vector<std::optional<core::SmoothedPoint>> points = smoother.smooth(x_m, stop_check);
    for (std::size_t i = 0; i < n; ++i) put(points[i], i, n, out);
    if (!noise_m) return;
    core::RowVariance variance({*noise_m * *noise_m});
    for (std::size_t i = 0; i < n; ++i) {
      stop_check();
      const std::optional<core::KernelRow> row = smoother.row_of_point(i);
      out[3 * n + i] = row ? std::sqrt(variance.of_x(*row)) : kNone;
      out[4 * n + i] = row ? std::sqrt(variance.of_v(*row)) : kNone;
      out[5 * n + i] = row && order > 1 ? std::sqrt(variance.of_a(*row)) : kNone;
    }
  });
  return result;
}

/// x, v and a at any times.
py::array_t<double> smooth_at(const Vector& times, const Vector& positions, const Vector& at, double bandwidth_s,
                              int order, const std::string& kernel) {
  const std::span<const double> t_s = span_of(times), x_m = span_of(positions), at_s = span_of(at);
  check_series(t_s, x_m);
  const core::PolynomialOptions options = options_of(bandwidth_s, order, kernel);
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    if (!std::isfinite(at_s[i])) refuse(fmt::format("at_s[{}]", i), fmt::format("{}", at_s[i]), "a finite number");
  }
  py::array_t<double> result = rows(3, at_s.size());
  double* const out = result.mutable_data();
  watched(std::max(t_s.size(), at_s.size()), [&](const base::StopCheck& stop_check) {
    const core::LocalPolynomial smoother(t_s, options);
    for (std::size_t i = 0; i < at_s.size(); ++i) {
      stop_check();
      const std::optional<core::KernelRow> row = smoother.row(at_s[i]);
      put(row ? std::optional(core::weighted_sums(*row, x_m)) : std::nullopt, i, at_s.size(), out);
    }
  });
  return result;
}

void check_rising(const char* key, std::span<const double> times_s, std::span<const double> t_s) {
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const std::string at = fmt::format("{}[{}]", key, i), found = fmt::format("{}", times_s[i]);
    if (!std::isfinite(times_s[i])) refuse(at, found, "a finite number");
    if (i > 0 && times_s[i] <= times_s[i - 1]) refuse(at, found, fmt::format("a time above {}", times_s[i - 1]));
    if (t_s.empty() || times_s[i] < t_s.front() || times_s[i] > t_s.back()) {
      refuse(at, found, "a time between the first and the last of t_s");
    }
  }
}

/// x, v, a and their standard deviations at the requested times, by a smoother that finds its own strength; and its
/// choices: method, smoothing time, noise, breaks, standard deviation of the jumps, factor of the simultaneous band.
py::tuple smooth_by(const std::string& name, const Vector& times, const Vector& positions,
                    const std::optional<Vector>& at, const Vector& breaks, std::optional<double> noise_m) {
  const std::span<const double> t_s = span_of(times), x_m = span_of(positions);
  check_series(t_s, x_m);
  core::check_smoother(name, false);
  const core::Smoother& smoother = *core::find_smoother(name);
  if (t_s.size() < core::kFewestSmoothed) {
    refuse("t_s", fmt::format("{} points", t_s.size()), fmt::format("at least {}", core::kFewestSmoothed));
  }
  if (noise_m && !(std::isfinite(*noise_m) && *noise_m > 0.0)) {
    refuse("noise_m", fmt::format("{}", *noise_m), "a number of metres above 0");
  }
  core::SmoothingInput input;
  input.t_s.assign(t_s.begin(), t_s.end());
  input.x_m.assign(x_m.begin(), x_m.end());
  input.noise_sd_m = noise_m;
  check_rising("breaks_s", span_of(breaks), t_s);
  input.breaks_s.assign(span_of(breaks).begin(), span_of(breaks).end());
  if (at) {
    check_rising("at_s", span_of(*at), t_s);
    input.at_s.assign(span_of(*at).begin(), span_of(*at).end());
  }
  input.simultaneous = true;
  const core::SmoothedSeries series = watched([&](const base::StopCheck& stop_check) {
    input.stop_check = stop_check;
    return smoother.smooth(input);
  });
  const std::vector<std::optional<core::SmoothedState>>& states = at ? series.at : series.points;
  const std::size_t n = states.size();
  if (n > 0 && std::ranges::none_of(states, [](const auto& state) { return state.has_value(); })) {
    refuse("x_m", "positions in which the smoother finds neither motion nor noise", "a motion");
  }
  py::array_t<double> values = rows(6, n);
  double* const out = values.mutable_data();
  for (std::size_t i = 0; i < n; ++i) {
    const core::SmoothedState of = states[i].value_or(core::SmoothedState{kNone, kNone, kNone, kNone, kNone, kNone});
    const std::array<double, 6> column{of.x_m, of.v_m_s, of.a_m_s2, of.sd_x_m, of.sd_v_m_s, of.sd_a_m_s2};
    for (std::size_t row = 0; row < column.size(); ++row) out[row * n + i] = column[row];
  }
  const core::SmoothingStrength& strength = series.strength;
  return py::make_tuple(std::move(values), strength.bandwidth_s, report::strength_words(strength.method),
                        strength.time_s, strength.noise_sd_m, vector_of(strength.breaks_s), strength.jump_sd_m_s2,
                        strength.simultaneous_a.value_or(kNone));
}

/// The rule's choice for one stretch of motion: (bandwidth, method, times and bandwidths of a local rule), or None if
/// the motion is too short.
py::object choose_bandwidth(const Vector& times, const Vector& positions, const std::string& name,
                            std::optional<double> noise_m) {
  const std::span<const double> t_s = span_of(times), x_m = span_of(positions);
  check_series(t_s, x_m);
  check_noise(noise_m);
  const core::BandwidthRule* rule = core::find_bandwidth_rule(name);
  if (rule == nullptr) {
    std::vector<std::string> names;
    for (const core::BandwidthRule& known : core::bandwidth_rules()) names.emplace_back(known.name);
    refuse("rule", fmt::format("\"{}\"", name),
           fmt::format("one of {}{}", fmt::join(names, ", "), base::did_you_mean(name, names)));
  }
  if (t_s.size() < core::kFewestTrackPoints) {
    refuse("t_s", fmt::format("{} points", t_s.size()), fmt::format("at least {}", core::kFewestTrackPoints));
  }
  const std::optional<core::BandwidthPick> pick = watched([&](const base::StopCheck& stop_check) {
    core::BandwidthProblem problem;
    problem.stop_check = stop_check;
    problem.parts = {{t_s, x_m}};
    problem.noise.sd_m = noise_m ? *noise_m : core::pilot_noise(t_s, x_m);
    problem.noise.autocovariance = {problem.noise.sd_m * problem.noise.sd_m};
    problem.step_s = core::median_step(t_s);
    return rule->choose(problem);
  });
  if (!pick) return py::none();
  std::vector<double> at_s, local_s;
  for (const core::LocalBandwidth& one : pick->local) {
    at_s.push_back(one.t_s);
    local_s.push_back(one.bandwidth_s);
  }
  return py::make_tuple(pick->bandwidth_s, report::strength_words(pick->by), vector_of(at_s), vector_of(local_s));
}

py::list rules() {
  py::list list;
  for (const core::BandwidthRule& rule : core::bandwidth_rules()) {
    list.append(py::make_tuple(std::string(rule.name), std::string(rule.words), std::string(rule.assumes)));
  }
  return list;
}

double position_noise(const Vector& times, const Vector& positions) {
  const std::span<const double> t_s = span_of(times), x_m = span_of(positions);
  check_series(t_s, x_m);
  if (t_s.size() < core::kFewestTrackPoints) {
    refuse("t_s", fmt::format("{} points", t_s.size()), fmt::format("at least {}", core::kFewestTrackPoints));
  }
  return core::pilot_noise(t_s, x_m);
}

}  // namespace

void bind_smoothing(py::module_& module) {
  module.def("smooth", &smooth);
  module.def("smooth_at", &smooth_at);
  module.def("smooth_by", &smooth_by);
  module.def("choose_bandwidth", &choose_bandwidth);
  module.def("bandwidth_rules", &rules);
  module.def("position_noise", &position_noise);
}

}  // namespace glidelab::python
