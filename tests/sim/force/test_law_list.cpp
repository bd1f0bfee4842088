/// Every law of the list, whatever it is: a law that is added passes these tests or names what it lacks.
#include "sim/force/law_list.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "sim/sensitivity/sensitivity.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;
using namespace glidelab::sim;

namespace {

const Contact kContact{.mass_kg = 0.4, .normal_n = 3.9};

std::vector<double> examples(const ForceLaw& law) {
  std::vector<double> values;
  for (const ForceParameter& parameter : law.parameters) values.push_back(parameter.example);
  return values;
}

/// The lines of one [[force]] with the law's examples, one of them replaced; an empty value leaves the key out.
std::string table_of(const ForceLaw& law, const std::string& key = "", const std::string& value = "") {
  std::string text = "[[force]]\nlaw = \"" + law.id + "\"\n";
  for (const ForceParameter& parameter : law.parameters) {
    if (parameter.key != key) text += fmt::format("{} = {}\n", parameter.key, parameter.example);
  }
  return value.empty() ? text : text + fmt::format("{} = {}\n", key, value);
}

struct Reading {
  std::shared_ptr<const ForceTerm> term;
  std::string error;
};

Reading read(const std::string& text) {
  const base::TomlFile file = base::TomlFile::parse(text, "s.toml");
  Reading reading{read_force(file.root().tables("force").front(), kContact.mass_kg), ""};
  try {
    file.finish();
  } catch (const base::InputError& error) {
    reading.error = error.what();
  }
  return reading;
}

/// File, key, what was found and what is expected.
void check_refused(const std::string& text, const std::string& key, const std::string& found) {
  const std::string error = read(text).error;
  INFO(text << error);
  CHECK(error.rfind("s.toml:", 0) == 0);
  CHECK(error.find("force[1]." + key + ": found " + found) != std::string::npos);
  CHECK(error.find("expected") != std::string::npos);
}

std::string scenario_documentation() {
  return base::read_file(std::filesystem::path(tests::kSourceDir) / "docs/reference/scenario.md");
}

}  // namespace

TEST_CASE("each force law has an id of its own, and says what it is and what its parameters are") {
  std::set<std::string> ids;
  for (const ForceLaw* law : force_laws()) {
    INFO(law->id);
    CHECK(ids.insert(law->id).second);
    CHECK_FALSE(law->force.empty());
    CHECK_FALSE(law->parameters.empty());
    std::set<std::string> keys = {"law"};
    for (const ForceParameter& parameter : law->parameters) {
      INFO(parameter.key);
      CHECK_FALSE(parameter.help.empty());
      CHECK(parameter.range.contains(parameter.example));
      CHECK(keys.insert(parameter.key).second);
      if (!parameter.over_mass.empty()) CHECK(keys.insert(parameter.over_mass).second);
      if (!parameter.not_below.empty()) CHECK(keys.count(parameter.not_below) == 1);
    }
    const bool holds = law->make(examples(*law))->holding_n(kContact) > 0.0;
    CHECK(holds == !law->holds.empty());
  }
}

TEST_CASE("the derivatives of each law, by the speed and by each parameter, agree with differences") {
  for (const ForceLaw* law : force_laws()) {
    const std::vector<double> values = examples(*law);
    const auto term = law->make(values);
    for (const double speed : {0.03, 0.2, 1.1}) {
      for (const int direction : {-1, +1}) {
        const double v = direction * speed;
        INFO(law->id << " at " << v << " m/s");
        // Central differences with a step of 1e-6: truncation 1e-12 of the third derivative (< 1e4 here), rounding
        // 1e-16 / 1e-8.
        const double dv = 1e-6 * speed;
        const double slope =
            (term->force_n(v + dv, direction, kContact) - term->force_n(v - dv, direction, kContact)) / (2.0 * dv);
        CHECK(std::abs(term->slope_n_s_m(v, direction, kContact) - slope) < 1e-7);
        const std::vector<double> by = term->by_parameter(v, direction, kContact);
        REQUIRE(by.size() == values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
          INFO(law->parameters[i].key);
          std::vector<double> more = values, less = values;
          const double step = 1e-6 * std::abs(values[i]);
          more[i] += step;
          less[i] -= step;
          const double difference =
              (law->make(more)->force_n(v, direction, kContact) - law->make(less)->force_n(v, direction, kContact)) /
              (2.0 * step);
          CHECK(std::abs(by[i] - difference) < 1e-6 * (1.0 + std::abs(difference)));
        }
      }
    }
  }
}

TEST_CASE("the sensitivities of a motion under each law agree with differences of simulated motions") {
  const std::vector<double> times = tests::times(0.4, 0.1);
  const auto glider = [](const ForceLaw& law, const std::vector<double>& values) {
    return tests::body(kContact.mass_kg, 0.05, law.make(values));
  };
  for (const ForceLaw* law : force_laws()) {
    INFO(law->id);
    const std::vector<double> values = examples(*law);
    const auto states = simulate_sensitive(BodyLaw(glider(*law, values)), 0.1, 0.9, times);
    for (std::size_t i = 0; i < values.size(); ++i) {
      INFO(law->parameters[i].key);
      std::vector<double> more = values, less = values;
      const double step = 1e-4 * std::abs(values[i]);
      more[i] += step;
      less[i] -= step;
      const Trajectory up = simulate(glider(*law, more), 0.1, 0.9, times);
      const Trajectory down = simulate(glider(*law, less), 0.1, 0.9, times);
      for (std::size_t k = 0; k < times.size(); ++k) {
        const double by_x = (up.states[k].x_m - down.states[k].x_m) / (2.0 * step);
        const double by_v = (up.states[k].v_m_s - down.states[k].v_m_s) / (2.0 * step);
        const auto column = static_cast<Eigen::Index>(i);
        // Truncation 1e-8 of the third derivative; the solver's 1e-13 m over a step of 1e-6 at least.
        CHECK(std::abs(states[k].by_parameter(0, column) - by_x) < 1e-6 * (1.0 + std::abs(by_x)));
        CHECK(std::abs(states[k].by_parameter(1, column) - by_v) < 1e-6 * (1.0 + std::abs(by_v)));
      }
    }
  }
}

TEST_CASE("each law is read with its keys, and what is wrong is refused with key, found and expected") {
  for (const ForceLaw* law : force_laws()) {
    const Reading good = read(table_of(*law));
    INFO(law->id << good.error);
    CHECK(good.error.empty());
    CHECK(good.term->force_n(0.3, +1, kContact) == law->make(examples(*law))->force_n(0.3, +1, kContact));
    check_refused(table_of(*law) + "no_such_key = 1\n", "no_such_key", "an unknown key");
    for (const ForceParameter& parameter : law->parameters) {
      if (parameter.not_below.empty()) check_refused(table_of(*law, parameter.key), parameter.key, "nothing");
      check_refused(table_of(*law, parameter.key, "\"much\""), parameter.key, "text \"much\"");
      check_refused(table_of(*law, parameter.key, "nan"), parameter.key, "nan");
      if (std::isfinite(parameter.range.low)) {
        const std::string low = fmt::format("{}", parameter.range.low - 1.0);
        check_refused(table_of(*law, parameter.key, low), parameter.key, low);
      }
      if (std::isfinite(parameter.range.high)) {
        const std::string high = fmt::format("{}", parameter.range.high + 1.0);
        check_refused(table_of(*law, parameter.key, high), parameter.key, high);
      }
      if (!parameter.over_mass.empty()) {
        const Reading over_mass =
            read(table_of(*law, parameter.key) + fmt::format("{} = {}\n", parameter.over_mass, parameter.example));
        CHECK(over_mass.error.empty());
        check_refused(table_of(*law) + parameter.over_mass + " = 1\n", parameter.over_mass, "both");
      }
    }
  }
}

TEST_CASE("a misspelt law is the one error of its table, whatever keys stand there") {
  for (const ForceLaw* law : force_laws()) {
    std::string text = table_of(*law);
    text.replace(text.find(law->id), law->id.size(), "no_such_law");
    const std::string error = read(text).error;
    INFO(error);
    CHECK(error.find("force[1].law: found text \"no_such_law\"") != std::string::npos);
    CHECK(error.find("unknown key") == std::string::npos);
    for (const ForceLaw* other : force_laws()) CHECK(error.find(other->id) != std::string::npos);
  }
}

TEST_CASE("the table of force laws in the scenario's documentation has a row for each law, with its keys") {
  const std::string text = scenario_documentation();
  REQUIRE_FALSE(text.empty());
  for (const ForceLaw* law : force_laws()) {
    INFO(law->id);
    const std::size_t start = text.find("\n| `" + law->id + "` | " + law->force + " | ");
    REQUIRE(start != std::string::npos);
    const std::string row = text.substr(start + 1, text.find('\n', start + 1) - start - 1);
    INFO(row);
    CHECK(row.find(" | " + (law->holds.empty() ? "–" : law->holds) + " |") != std::string::npos);
    for (const ForceParameter& parameter : law->parameters) {
      CHECK(row.find("`" + parameter.key + "`") != std::string::npos);
      if (!parameter.over_mass.empty()) CHECK(row.find("`" + parameter.over_mass + "`") != std::string::npos);
    }
  }
}

TEST_CASE("a term made in code has as many values as its law has parameters, in their ranges") {
  CHECK(laws::coulomb().with({0.1})->holding_n(kContact) == 0.1 * kContact.normal_n);
  CHECK_THROWS_AS(laws::viscous().with({}), std::logic_error);
  CHECK_THROWS_AS(laws::viscous().with({1.0, 2.0}), std::logic_error);
  CHECK_THROWS_AS(laws::viscous().with({-1.0}), std::logic_error);
}
