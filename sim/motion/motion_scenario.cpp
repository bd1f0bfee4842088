#include "sim/motion/motion_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "base/math/angles.h"
#include "sim/force/law_list.h"

namespace glidelab::sim {

std::optional<LinearLaw> linear_law(const Body& body) {
  LinearLaw law;
  for (const auto& term : body.forces) {
    const std::optional<LinearShare> share = term->linear();
    if (!share) return std::nullopt;
    law.k_over_m_1_s += share->k_n_s_m / body.mass_kg;
    law.mu += share->mu;
  }
  return law;
}

std::optional<double> limit_speed_m_s(const Body& body) {
  const auto drives = [&](double v) { return net_force_n(body, v, +1) > 0.0; };
  constexpr int kPerDecade = 64;
  constexpr int kDecades = 12;
  constexpr double kLowest = 1e-9;  // m/s
  double low = 0.0;
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(weight_along_track_n(body));
  bool drives_low = net_force_n(body, 0.0, +1) > rounding;
  for (int i = 0; i <= kDecades * kPerDecade; ++i) {
    double high = kLowest * std::pow(10.0, static_cast<double>(i) / kPerDecade);
    const bool drives_high = drives(high);
    if (drives_low && !drives_high) {
      while (true) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) return high;
        (drives(middle) ? low : high) = middle;
      }
    }
    low = high;
    drives_low = drives_high;
  }
  return std::nullopt;
}

namespace {

using base::TomlTable;

std::string as_text(const std::string& text) {
  return "text \"" + text + "\"";
}

// Names become names of files and keys.
bool is_name(const std::string& text) {
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
  };
  return !text.empty() && text.front() != '.' && std::all_of(text.begin(), text.end(), good);
}

// Where each name was first used.
using Names = std::map<std::string, int>;

std::string read_name(const TomlTable& table, std::string_view key) {
  std::string name = table.text(key);
  if (!name.empty() && !is_name(name)) {
    table.reject(key, as_text(name), "letters, digits, '-', '_' and '.', not starting with '.'");
  }
  return name;
}

std::string read_unique_name(const TomlTable& table, Names& names) {
  std::string name = read_name(table, "name");
  if (name.empty()) return name;
  const auto [first, is_new] = names.emplace(name, table.line("name"));
  if (!is_new) {
    table.reject("name", as_text(name), fmt::format("another name than in line {}", first->second));
  }
  return name;
}

Launched read_launched(const TomlTable& table, double v0_m_s) {
  const std::optional<std::string> word = table.one_of("launched", {"up", "down", "released"});
  if (!word) return Launched::released;
  const bool up = *word == "up";
  const bool down = *word == "down";
  const bool agree = up ? v0_m_s < 0.0 : down ? v0_m_s > 0.0 : v0_m_s == 0.0;
  if (!agree && !std::isnan(v0_m_s)) {
    table.reject("v0_m_s", fmt::format("{}", v0_m_s),
                 std::string(up     ? "a number below 0"
                             : down ? "a number above 0"
                                    : "0") +
                     " where launched = \"" + *word + "\"");
  }
  return up ? Launched::up : down ? Launched::down : Launched::released;
}

MotionSetup read_clip(const TomlTable& table, Names& clip_names) {
  MotionSetup motion;
  motion.name = read_unique_name(table, clip_names);
  motion.x0_m = table.number("x0_m", base::between(-1000.0, 1000.0));
  motion.v0_m_s = table.number("v0_m_s", base::between(-100.0, 100.0));
  motion.launched = read_launched(table, motion.v0_m_s);
  motion.duration_s = table.number("duration_s", {.low = 0.0, .high = 3600.0, .low_open = true});
  return motion;
}

ConfigurationSetup read_configuration(const TomlTable& table, double gravity_m_s2, Names& names, Names& clip_names) {
  const base::Range incline = base::between(-90.0, 90.0);
  ConfigurationSetup setup;
  setup.name = read_unique_name(table, names);
  setup.group = table.has("group") ? read_name(table, "group") : setup.name;
  setup.body.gravity_m_s2 = gravity_m_s2;
  setup.body.mass_kg = table.number("mass_kg", {.low = 0.0, .high = 1000.0, .low_open = true});
  const double incline_deg = table.number("incline_deg", incline);
  setup.body.incline_rad = incline_deg * base::kRadPerDegree;
  setup.stated_incline_rad = table.number_or("stated_incline_deg", incline_deg, incline) * base::kRadPerDegree;
  setup.stated_incline_sd_rad =
      table.number_or("stated_incline_sd_deg", 0.0, base::between(0.0, 90.0)) * base::kRadPerDegree;
  for (const TomlTable& force : table.tables_or_none("force")) {
    setup.body.forces.push_back(read_force(force, setup.body.mass_kg));
  }
  for (const TomlTable& clip : table.tables("clip")) setup.motions.push_back(read_clip(clip, clip_names));
  return setup;
}

// One set-up of the track has one inclination and one reading of it.
void check_groups(const std::vector<TomlTable>& tables, const std::vector<ConfigurationSetup>& setups) {
  std::map<std::string, std::size_t> first_of;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const std::size_t first_index = first_of.emplace(setups[i].group, i).first->second;
    if (first_index == i) continue;
    const ConfigurationSetup& first = setups[first_index];
    const auto compare = [&](const char* key, double value, double first_value) {
      if (std::isnan(value) || std::isnan(first_value) || value == first_value) return;
      tables[i].reject(key, fmt::format("{:.10g}", value / base::kRadPerDegree),
                       fmt::format("{:.10g} as in line {}, for group \"{}\" is one set-up of the track",
                                   first_value / base::kRadPerDegree, tables[first_index].line(key), first.group));
    };
    compare("incline_deg", setups[i].body.incline_rad, first.body.incline_rad);
    compare("stated_incline_deg", setups[i].stated_incline_rad, first.stated_incline_rad);
    compare("stated_incline_sd_deg", setups[i].stated_incline_sd_rad, first.stated_incline_sd_rad);
  }
}

}  // namespace

MotionScenario read_motions(const TomlTable& root) {
  MotionScenario scenario;
  root.integer("format", 1, 1);
  scenario.name = root.text("name");
  scenario.gravity_m_s2 = root.number_or("gravity_m_s2", scenario.gravity_m_s2, base::between(0.0, 100.0));
  const std::vector<TomlTable> tables = root.tables("configuration");
  Names names;
  Names clip_names;
  for (const TomlTable& table : tables) {
    scenario.configurations.push_back(read_configuration(table, scenario.gravity_m_s2, names, clip_names));
  }
  check_groups(tables, scenario.configurations);
  return scenario;
}

}  // namespace glidelab::sim
