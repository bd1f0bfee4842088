#include "report/html/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text/number_text.h"

namespace glidelab::report {
namespace {

constexpr double kRoom = 0.05;          // at each end, of the values' span
constexpr std::size_t kFewValues = 12;  // each with its own mark

/// The smallest of 1, 2, 5 times powers of ten that is not below it.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value * (1.0 - 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

/// In gnuplot's own number format.
std::string with_minus(std::string number) {
  for (std::size_t at = number.find('-'); at != std::string::npos; at = number.find('-')) number.replace(at, 1, "−");
  return number;
}

std::size_t letters_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

}  // namespace

double tick_step(double span, int most) {
  return round_up(span / most);
}

std::string even_tics(std::string_view axis, double from, double to, int most) {
  const double step = tick_step(to - from, most);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("set {0}tics {1:.9g}\nset format {0} '%.{2}f'\n", axis, step, decimals);
}

std::string tic_label(double value) {
  constexpr double kPlain = 1e-4;
  if (value == 0.0 || std::abs(value) >= kPlain) return with_minus(base::number_text(value, 4));
  const std::string label = with_minus(base::with_raised_power(fmt::format("{:.4g}", value)));
  constexpr std::string_view kOne = "1·";  // of a power of ten alone
  return label.starts_with("1·10") ? label.substr(kOne.size()) : label;
}

std::string labelled_tics(std::string_view axis, const std::vector<double>& at) {
  std::string tics;
  for (const double value : at) tics += fmt::format("{}'{}' {:.6g}", tics.empty() ? "" : ", ", tic_label(value), value);
  return fmt::format("set {}tics ({})\n", axis, tics);
}

std::vector<double> ladder_of(double from, double to) {
  std::vector<double> ladder;
  for (int power = static_cast<int>(std::floor(std::log10(from))) - 1; std::pow(10.0, power) < 10.0 * to; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double next = digit * std::pow(10.0, power);
      if (!ladder.empty() && ladder.back() >= to) break;
      if (next <= from) ladder.clear();
      ladder.push_back(next);
    }
  }
  return ladder;
}

SmallLengthUnit small_length_unit(double largest_m) {
  constexpr double kMillimetresFrom = 2e-4;  // m: below it all labels in millimetres would begin with a zero
  return largest_m < kMillimetresFrom ? SmallLengthUnit{"µm", 1e6} : SmallLengthUnit{"mm", 1e3};
}

ValueAxis::ValueAxis(std::vector<double> values, bool logarithmic)
    : values_(std::move(values)), logarithmic_(logarithmic) {
  std::sort(values_.begin(), values_.end());
  values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
  const double first = to_axis(values_.front()), last = to_axis(values_.back());
  const double span = last > first ? last - first : 1.0;
  from_ = first - kRoom * span;
  to_ = last + kRoom * span;
  least_gap_ = span;
  for (std::size_t i = 1; i < values_.size(); ++i) {
    least_gap_ = std::min(least_gap_, to_axis(values_[i]) - to_axis(values_[i - 1]));
  }
}

double ValueAxis::to_axis(double value) const {
  return logarithmic_ ? std::log(value) : value;
}
double ValueAxis::from_axis(double place) const {
  return logarithmic_ ? std::exp(place) : place;
}

double ValueAxis::beside(double value, std::size_t i, std::size_t count) const {
  constexpr double kBarWidth = 0.014;  // of the axis: the width of a bar's end
  const double step = std::min(kBarWidth * (to_ - from_), 0.7 * least_gap_ / static_cast<double>(count));
  return from_axis(to_axis(value) + step * (static_cast<double>(i) - 0.5 * (static_cast<double>(count) - 1.0)));
}

std::vector<double> ValueAxis::marks() const {
  if (values_.size() <= kFewValues) return values_;
  if (logarithmic_) {
    std::vector<double> ladder = ladder_of(values_.front(), values_.back());
    std::erase_if(ladder, [&](double value) { return to_axis(value) < from_ || to_axis(value) > to_; });
    return ladder;
  }
  const double step = round_up((values_.back() - values_.front()) / 6.0);
  std::vector<double> round;
  for (double k = std::ceil(from_ / step); k * step <= to_; ++k) round.push_back(k * step);
  return round;
}

std::string ValueAxis::script(double points) const {
  constexpr double kLetter = 10.0, kGap = 10.0;  // points
  const std::vector<double> all = marks();
  const auto half = [](double value) {
    return 0.5 * (kLetter * static_cast<double>(letters_of(tic_label(value))) + kGap);
  };
  const auto place = [&](double value) { return points * (to_axis(value) - from_) / (to_ - from_); };
  std::vector<bool> labelled(all.size(), false);
  double free_from = -points;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_last = i + 1 == all.size();
    const double left = place(all[i]) - half(all[i]);
    const bool before_last = is_last || place(all[i]) + half(all[i]) <= place(all.back()) - half(all.back());
    labelled[i] = is_last || i == 0 || (left >= free_from && before_last);
    if (labelled[i]) free_from = place(all[i]) + half(all[i]);
  }
  std::string tics;  // positions with the same digits as the data
  for (std::size_t i = 0; i < all.size(); ++i) {
    tics += fmt::format("{}'{}' {:.9g}", i == 0 ? "" : ", ", labelled[i] ? tic_label(all[i]) : "", all[i]);
  }
  return fmt::format("{}set xrange [{:.9g}:{:.9g}]\nset xtics ({})\n", logarithmic_ ? "set logscale x\n" : "",
                     from_axis(from_), from_axis(to_), tics);
}

std::vector<std::size_t> outline(std::span<const double> y, std::size_t most) {
  std::vector<std::size_t> kept;
  if (y.size() <= std::max<std::size_t>(most, 4)) {
    kept.resize(y.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t parts = std::max<std::size_t>(most / 2, 1);
  kept.push_back(0);
  for (std::size_t part = 0; part < parts; ++part) {
    const auto from = y.begin() + static_cast<std::ptrdiff_t>(y.size() * part / parts);
    const auto to = y.begin() + static_cast<std::ptrdiff_t>(y.size() * (part + 1) / parts);
    const auto [low, high] = std::minmax_element(from, to);
    const auto first = static_cast<std::size_t>(std::min(low, high) - y.begin());
    const auto second = static_cast<std::size_t>(std::max(low, high) - y.begin());
    if (first != kept.back()) kept.push_back(first);
    if (second != kept.back()) kept.push_back(second);
  }
  if (kept.back() != y.size() - 1) kept.push_back(y.size() - 1);
  return kept;
}

std::vector<std::size_t> every_nth(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept;
  if (count <= most || most < 2) {
    kept.resize(std::min(count, std::max<std::size_t>(most, 1)));
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  for (std::size_t i = 0; i < most; ++i) kept.push_back(i * (count - 1) / (most - 1));
  return kept;
}

}  // namespace glidelab::report
