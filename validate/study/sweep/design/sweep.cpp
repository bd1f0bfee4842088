#include "validate/study/sweep/design/sweep.h"

#include <fmt/format.h>
#include <boost/random/sobol.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/errors.h"
#include "base/math/distributions.h"
#include "render/random/random_numbers.h"

namespace glidelab::validate {

std::string Analysis::name() const {
  if (bandwidth_s) return fmt::format("{} h={} s", estimator, *bandwidth_s);
  return bandwidth_rule.empty() ? estimator : fmt::format("{} {}", estimator, bandwidth_rule);
}

namespace {

std::uint64_t words(std::uint64_t key, std::uint64_t index, std::uint32_t axis, render::RandomPurpose purpose) {
  const render::PhiloxCounter drawn =
      render::random_words(purpose, {static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), axis},
                           {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)});
  return static_cast<std::uint64_t>(drawn[0]) << 32 | drawn[1];
}

/// In [0, 1), 53 bits.
double unit(std::uint64_t word) {
  return static_cast<double>(word >> 11) * 0x1p-53;
}

double sobol(std::size_t axis, std::size_t axes, std::uint64_t point, std::uint64_t shift) {
  // Boost omits the sequence's first point, the origin, without which 2^m points are not a net.
  if (point == 0) return unit(shift);
  boost::random::sobol_engine<std::uint64_t, 64> engine(axes);
  engine.seed(point - 1);
  engine.discard(axis);
  return unit(engine() ^ shift);
}

}  // namespace

std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key) {
  // Four rounds of a Feistel cipher on the smallest even number of bits that holds count, iterated until the result
  // falls inside.
  const int half = std::max(1, (static_cast<int>(std::bit_width(count - 1)) + 1) / 2);
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  std::uint64_t value = index;
  do {
    std::uint64_t left = value >> half, right = value & mask;
    for (std::uint32_t round = 0; round < 4; ++round) {
      const std::uint64_t mixed = left ^ (words(key, right, round, render::RandomPurpose::sweep_permute) & mask);
      left = right;
      right = mixed;
    }
    value = left << half | right;
  } while (value >= count);
  return value;
}

std::vector<base::TomlScalar> all_values(const AxisSource& source) {
  if (source.kind == AxisSource::Kind::list) return source.values;
  std::vector<base::TomlScalar> values;
  for (std::size_t i = 0; i < source.count; ++i) {
    if (i + 1 == source.count && i > 0) {
      values.push_back(source.to);  // exact to the last bit
    } else {
      const double part = source.count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(source.count - 1);
      const double value = source.kind == AxisSource::Kind::linear
                               ? source.from + (source.to - source.from) * part
                               : source.from * std::pow(source.to / source.from, part);
      values.push_back(source.whole ? std::round(value) : value);
    }
  }
  return values;
}

base::TomlScalar value_at(const AxisSource& source, double u) {
  using Kind = AxisSource::Kind;
  switch (source.kind) {
    case Kind::list:
      return source.values.at(static_cast<std::size_t>(u * static_cast<double>(source.values.size())));
    case Kind::linear:
    case Kind::uniform:
      return source.whole ? source.from + std::floor((source.to - source.from + 1.0) * u)
                          : source.from + (source.to - source.from) * u;
    case Kind::logarithmic:
    case Kind::log_uniform: {
      const double value = source.from * std::pow(source.to / source.from, u);
      return source.whole ? std::round(value) : value;
    }
    case Kind::normal:
      return source.mean + source.sd * base::normal_quantile(std::max(u, 0x1p-54));
    case Kind::log_normal:
      return source.mean * std::exp(source.sd * base::normal_quantile(std::max(u, 0x1p-54)));
  }
  return 0.0;  // not reached: all kinds are above
}

std::uint64_t point_count(const Sweep& sweep) {
  constexpr double kMost = 9007199254740992.0;  // 2^53
  double points = 1.0;
  if (sweep.design != Design::factorial) {
    points = static_cast<double>(sweep.samples);
  } else {
    for (const Axis& axis : sweep.axes) {
      if (axis.source.drawn()) continue;
      points *= static_cast<double>(axis.source.kind == AxisSource::Kind::list ? axis.source.values.size()
                                                                               : axis.source.count);
    }
  }
  if (points * static_cast<double>(sweep.replicates) > kMost) {
    throw base::InputError(base::Issue{sweep.file.string(), 0, "vary",
                                       fmt::format("{:.3g} runs", points * static_cast<double>(sweep.replicates)),
                                       "fewer values, or a Latin hypercube or Sobol design of some samples"});
  }
  return static_cast<std::uint64_t>(points);
}

std::uint64_t run_count(const Sweep& sweep) {
  return point_count(sweep) * sweep.replicates;
}

std::uint64_t seed_of(const Sweep& sweep, std::uint64_t run) {
  return words(sweep.seed, run, 0, render::RandomPurpose::sweep_seed) >> 1;  // fits a signed number, as used in files
}

std::vector<base::TomlScalar> values_of(const Sweep& sweep, std::uint64_t run) {
  const std::uint64_t point = run / sweep.replicates;
  std::vector<base::TomlScalar> values(sweep.axes.size());
  std::uint64_t rest = point;
  std::size_t designed = 0;
  for (const Axis& axis : sweep.axes) designed += axis.source.drawn() ? 0 : 1;
  std::size_t dimension = designed;
  for (std::size_t i = sweep.axes.size(); i-- > 0;) {  // the last axis varies fastest
    const AxisSource& source = sweep.axes[i].source;
    const auto number = static_cast<std::uint32_t>(i);
    if (source.drawn()) {
      values[i] = value_at(source, unit(words(sweep.seed, run, number, render::RandomPurpose::sweep_draw)));
      continue;
    }
    --dimension;
    if (sweep.design == Design::factorial) {
      const std::vector<base::TomlScalar> all = all_values(source);
      values[i] = all[rest % all.size()];
      rest /= all.size();
    } else if (sweep.design == Design::latin_hypercube) {
      const std::uint64_t stratum =
          permuted(point, sweep.samples, words(sweep.seed, 0, number, render::RandomPurpose::sweep_permute));
      const double within = unit(words(sweep.seed, point, number, render::RandomPurpose::sweep_stratum));
      values[i] = value_at(source, (static_cast<double>(stratum) + within) / static_cast<double>(sweep.samples));
    } else {
      values[i] = value_at(
          source, sobol(dimension, designed, point, words(sweep.seed, 0, number, render::RandomPurpose::sweep_shift)));
    }
  }
  return values;
}

}  // namespace glidelab::validate
