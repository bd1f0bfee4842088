#include "sim/motion/motion_scenario.h"

#include <cmath>
#include <numbers>
#include <string>

#include "base/errors.h"
#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab::sim;
using namespace glidelab;
using tests::body;
using tests::kGravity;

namespace {

const std::string kGood = R"(format = 1
name = "bench"
[[configuration]]
name = "m1"
mass_kg = 0.4
incline_deg = 4.3
stated_incline_deg = 4.0
stated_incline_sd_deg = 0.3
group = "track"
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.5
[[configuration.force]]
law = "coulomb"
mu = 0.01
mu_static = 0.015
[[configuration.clip]]
name = "m1-up"
launched = "up"
x0_m = 0.6
v0_m_s = -1.1
duration_s = 1.8
[[configuration.clip]]
name = "m1-down"
launched = "down"
x0_m = -0.6
v0_m_s = 1.2
duration_s = 1.7
)";

// kGood with one line (1-based) replaced; an empty text removes it.
std::string with_line(int line, const std::string& text) {
  std::string result;
  std::size_t begin = 0;
  for (int i = 1; begin < kGood.size(); ++i) {
    const std::size_t end = kGood.find('\n', begin);
    const std::string old = kGood.substr(begin, end - begin);
    result += (i == line ? text : old) + "\n";
    begin = end + 1;
  }
  return result;
}

std::string message_of(const std::string& text) {
  const base::TomlFile file = base::TomlFile::parse(text, "s.toml");
  sim::read_motions(file.root());
  try {
    file.finish();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

// One error, and only one, that starts with "s.toml:LINE: KEY: found FOUND".
void check_error(const std::string& text, const std::string& start) {
  const std::string message = message_of(text);
  INFO(message);
  CHECK(message.rfind("s.toml:" + start, 0) == 0);
  CHECK(message.find("s.toml", 1) == std::string::npos);
  CHECK(message.find("expected") != std::string::npos);
}

sim::MotionScenario read(const std::string& text) {
  const base::TomlFile file = base::TomlFile::parse(text, "s.toml");
  sim::MotionScenario scenario = sim::read_motions(file.root());
  file.finish();
  return scenario;
}

}  // namespace

TEST_CASE("a scenario's motions are read with units converted") {
  const sim::MotionScenario scenario = read(kGood);
  CHECK(scenario.name == "bench");
  CHECK(scenario.gravity_m_s2 == 9.80665);
  REQUIRE(scenario.configurations.size() == 1);
  const sim::ConfigurationSetup& setup = scenario.configurations[0];
  CHECK(setup.name == "m1");
  CHECK(setup.group == "track");
  CHECK(setup.body.mass_kg == 0.4);
  CHECK(setup.body.gravity_m_s2 == 9.80665);
  CHECK(std::abs(setup.body.incline_rad - 4.3 * std::numbers::pi / 180.0) < 1e-16);
  CHECK(std::abs(setup.stated_incline_rad - 4.0 * std::numbers::pi / 180.0) < 1e-16);
  CHECK(std::abs(setup.stated_incline_sd_rad - 0.3 * std::numbers::pi / 180.0) < 1e-16);
  REQUIRE(sim::linear_law(setup.body));
  CHECK(std::abs(sim::linear_law(setup.body)->k_over_m_1_s - 2.5) < 1e-15);
  CHECK(sim::linear_law(setup.body)->mu == 0.01);
  CHECK(std::abs(sim::holding_n(setup.body) - 0.015 * sim::contact_of(setup.body).normal_n) < 1e-16);
  REQUIRE(setup.motions.size() == 2);
  CHECK(setup.motions[0].name == "m1-up");
  CHECK(setup.motions[0].launched == sim::Launched::up);
  CHECK(setup.motions[0].x0_m == 0.6);
  CHECK(setup.motions[0].v0_m_s == -1.1);
  CHECK(setup.motions[0].duration_s == 1.8);
  CHECK(setup.motions[1].launched == sim::Launched::down);
}

TEST_CASE("a name has letters, digits, a hyphen, an underscore and a full stop, and does not begin with one") {
  for (const char* const good : {"a", "Z9", "m-1", "m_1", "m.1", "_a"}) {
    CHECK(read(with_line(4, "name = \"" + std::string(good) + "\"")).configurations.at(0).name == good);
  }
  for (const char* const bad : {"", ".a", "a b", "a/b", "a:b", "\xC3\xA4"}) {
    check_error(with_line(4, "name = \"" + std::string(bad) + "\""), "4: configuration[1].name: found text");
  }
}

TEST_CASE("what may be left out has the default that the documentation states") {
  const sim::MotionScenario scenario = read(R"(format = 1
name = "least"
gravity_m_s2 = 1.62
[[configuration]]
name = "a"
mass_kg = 1
incline_deg = -3
[[configuration.clip]]
name = "a-1"
launched = "released"
x0_m = 0
v0_m_s = 0
duration_s = 1
)");
  const sim::ConfigurationSetup& setup = scenario.configurations.at(0);
  CHECK(setup.group == "a");
  CHECK(setup.stated_incline_rad == setup.body.incline_rad);
  CHECK(setup.stated_incline_sd_rad == 0.0);
  CHECK(setup.body.gravity_m_s2 == 1.62);
  CHECK(setup.body.forces.empty());
  CHECK(setup.motions.at(0).launched == sim::Launched::released);
}

TEST_CASE("every law is read with its own keys") {
  const auto force = [](const std::string& keys) {
    const sim::MotionScenario scenario = read(
        "format = 1\nname = \"s\"\n[[configuration]]\nname = \"a\"\nmass_kg = 0.5\nincline_deg = 0\n"
        "[[configuration.force]]\n" +
        keys + "\n[[configuration.clip]]\nname = \"c\"\nlaunched = \"up\"\nx0_m = 0\nv0_m_s = -1\nduration_s = 1\n");
    return scenario.configurations.at(0).body.forces.at(0);
  };
  const sim::Contact contact{.mass_kg = 0.5, .normal_n = 5.0};
  const auto at_half = [&](const std::string& keys) { return force(keys)->force_n(0.5, +1, contact); };
  CHECK(at_half("law = \"viscous\"\nk_n_s_m = 3") == -1.5);
  CHECK(at_half("law = \"viscous\"\nk_over_m_1_s = 3") == -0.75);
  CHECK(at_half("law = \"coulomb\"\nmu = 0.25") == -1.25);
  CHECK(force("law = \"coulomb\"\nmu = 0.25")->holding_n(contact) == 1.25);
  CHECK(at_half("law = \"quadratic\"\nc_kg_m = 2") == -0.5);
  CHECK(at_half("law = \"power_law\"\nk_n_s_m = 2\nn = 3") == -0.25);
  CHECK(std::abs(at_half("law = \"stribeck\"\nmu = 0.1\ns = 3\nv_s_m_s = 0.5") + 0.5 * (1.0 + 2.0 / std::exp(1.0))) <
        1e-15);
  CHECK(at_half("law = \"eddy_rolloff\"\nk_n_s_m = 4\nv_c_m_s = 0.5") == -1.0);
  CHECK(at_half("law = \"eddy_rolloff\"\nk_over_m_1_s = 8\nv_c_m_s = 0.5") == -1.0);
  CHECK(at_half("law = \"constant\"\nforce_n = -0.125") == -0.125);
}

TEST_CASE("every wrong key is one error with file, line and key") {
  REQUIRE(message_of(kGood).empty());
  // Missing: the line is that of the table.
  check_error(with_line(1, ""), "1: format: found nothing");
  check_error(with_line(2, ""), "1: name: found nothing");
  check_error(with_line(4, ""), "3: configuration[1].name: found nothing");
  check_error(with_line(5, ""), "3: configuration[1].mass_kg: found nothing");
  check_error(with_line(6, ""), "3: configuration[1].incline_deg: found nothing");
  check_error(with_line(11, ""), "10: configuration[1].force[1].law: found nothing");
  check_error(with_line(12, ""), "10: configuration[1].force[1].k_n_s_m: found nothing");
  check_error(with_line(15, ""), "13: configuration[1].force[2].mu: found nothing");
  check_error(with_line(18, ""), "17: configuration[1].clip[1].name: found nothing");
  check_error(with_line(19, ""), "17: configuration[1].clip[1].launched: found nothing");
  check_error(with_line(20, ""), "17: configuration[1].clip[1].x0_m: found nothing");
  check_error(with_line(21, ""), "17: configuration[1].clip[1].v0_m_s: found nothing");
  check_error(with_line(22, ""), "17: configuration[1].clip[1].duration_s: found nothing");
  // Misspelt.
  check_error(with_line(9, "grup = \"track\""), "9: configuration[1].grup: found an unknown key");
  check_error(with_line(16, "mu_satic = 0.02"), "16: configuration[1].force[2].mu_satic: found an unknown key");
  check_error(with_line(11, "law = \"viscos\""), "11: configuration[1].force[1].law: found text \"viscos\"");
  check_error(with_line(19, "launched = \"upp\""), "19: configuration[1].clip[1].launched: found text \"upp\"");
  // A key of another law.
  check_error(with_line(16, "k_n_s_m = 1"), "16: configuration[1].force[2].k_n_s_m: found an unknown key");
  // Of the wrong type, or not finite.
  check_error(with_line(1, "format = \"1\""), "1: format: found text \"1\"");
  check_error(with_line(5, "mass_kg = \"heavy\""), "5: configuration[1].mass_kg: found text \"heavy\"");
  check_error(with_line(11, "law = 3"), "11: configuration[1].force[1].law: found 3");
  check_error(with_line(20, "x0_m = nan"), "20: configuration[1].clip[1].x0_m: found nan");
  check_error(with_line(21, "v0_m_s = -inf"), "21: configuration[1].clip[1].v0_m_s: found -inf");
  // Out of range.
  check_error(with_line(1, "format = 2"), "1: format: found 2");
  check_error(with_line(2, "name = \"s\"\ngravity_m_s2 = -9.8"), "3: gravity_m_s2: found -9.8");
  check_error(with_line(5, "mass_kg = 0"), "5: configuration[1].mass_kg: found 0");
  check_error(with_line(6, "incline_deg = 91"), "6: configuration[1].incline_deg: found 91");
  check_error(with_line(7, "stated_incline_deg = -91"), "7: configuration[1].stated_incline_deg: found -91");
  check_error(with_line(8, "stated_incline_sd_deg = -0.1"), "8: configuration[1].stated_incline_sd_deg: found -0.1");
  check_error(with_line(12, "k_over_m_1_s = -2"), "12: configuration[1].force[1].k_over_m_1_s: found -2");
  check_error(with_line(15, "mu = -0.01"), "15: configuration[1].force[2].mu: found -0.01");
  check_error(with_line(22, "duration_s = 0"), "22: configuration[1].clip[1].duration_s: found 0");
  // What does not go together.
  check_error(with_line(12, "k_over_m_1_s = 2\nk_n_s_m = 1"),
              "12: configuration[1].force[1].k_over_m_1_s: found both k_n_s_m and k_over_m_1_s");
  check_error(with_line(16, "mu_static = 0.005"), "16: configuration[1].force[2].mu_static: found 0.005");
  check_error(with_line(21, "v0_m_s = 1.1"), "21: configuration[1].clip[1].v0_m_s: found 1.1");
  check_error(with_line(21, "v0_m_s = 0"), "21: configuration[1].clip[1].v0_m_s: found 0");
  check_error(with_line(19, "launched = \"released\""), "21: configuration[1].clip[1].v0_m_s: found -1.1");
}

TEST_CASE("names that cannot be names of files, or stand twice, are rejected") {
  for (const std::string bad : {"up/down", ".hidden", "a b", "m1-\\u00fc", "a\\n"}) {
    INFO(bad);
    CHECK(message_of(with_line(18, "name = \"" + bad + "\"")).rfind("s.toml:18: configuration[1].clip[1].name", 0) ==
          0);
    CHECK(message_of(with_line(9, "group = \"" + bad + "\"")).rfind("s.toml:9: configuration[1].group", 0) == 0);
  }
  check_error(with_line(24, "name = \"m1-up\""),
              "24: configuration[1].clip[2].name: found text \"m1-up\", expected another name than in line 18");
  const std::string second = R"([[configuration]]
name = "m1"
mass_kg = 0.5
incline_deg = 4.3
[[configuration.clip]]
name = "m1-down"
launched = "up"
x0_m = 0
v0_m_s = -1
duration_s = 1
)";
  const std::string message = message_of(kGood + second);
  CHECK(message.find("s.toml:30: configuration[2].name: found text \"m1\", expected another name than in line 4") !=
        std::string::npos);
  CHECK(
      message.find(
          "s.toml:34: configuration[2].clip[1].name: found text \"m1-down\", expected another name than in line 24") !=
      std::string::npos);
}

TEST_CASE("configurations of one group have one inclination") {
  const auto second = [](const std::string& incline, const std::string& stated) {
    return kGood + "[[configuration]]\nname = \"m2\"\ngroup = \"track\"\nmass_kg = 0.5\nincline_deg = " + incline +
           "\nstated_incline_deg = " + stated +
           "\nstated_incline_sd_deg = 0.3\n[[configuration.clip]]\nname = \"m2-up\"\nlaunched = \"up\"\nx0_m = 0\n"
           "v0_m_s = -1\nduration_s = 1\n";
  };
  CHECK(message_of(second("4.3", "4.0")).empty());
  check_error(second("4.2", "4.0"), "33: configuration[2].incline_deg: found 4.2");
  check_error(second("4.3", "4.1"), "34: configuration[2].stated_incline_deg: found 4.1");
}

TEST_CASE("a scenario without configurations, or a configuration without clips, is rejected") {
  check_error("format = 1\nname = \"s\"\n", "1: configuration: found nothing");
  check_error("format = 1\nname = \"s\"\n[[configuration]]\nname = \"a\"\nmass_kg = 1\nincline_deg = 0\n",
              "3: configuration[1].clip: found nothing");
}

TEST_CASE("K/m and mu are given where the law is viscous and Coulomb, and only there") {
  const auto law = linear_law(
      body(0.5, 0.1, laws::viscous().with({1.5}), laws::coulomb().with({0.01, 0.02}), laws::viscous().with({0.5})));
  REQUIRE(law);
  CHECK(law->k_over_m_1_s == 4.0);
  CHECK(law->mu == 0.01);
  REQUIRE(linear_law(body(0.5, 0.1)));
  CHECK(linear_law(body(0.5, 0.1))->mu == 0.0);
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::viscous().with({1.5}), laws::constant().with({0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::stribeck().with({0.1, 1.0, 0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::quadratic().with({0.1}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::power_law().with({0.1, 1.0}))));
  CHECK_FALSE(linear_law(body(0.5, 0.1, laws::eddy_rolloff().with({0.1, 1.0}))));
}

TEST_CASE("the limit speed is equation (9) for viscous and Coulomb friction, to rounding") {
  const double incline = 0.075;
  const double expected = (0.335 * kGravity * (std::sin(incline) - 0.0071 * std::cos(incline))) / 0.927;
  const auto v_lim =
      limit_speed_m_s(body(0.335, incline, laws::viscous().with({0.927}), laws::coulomb().with({0.0071})));
  REQUIRE(v_lim);
  CHECK(std::abs(*v_lim - expected) < 1e-15);
}

TEST_CASE("the limit speed of every other law is where its force balances gravity") {
  const double weight = 0.4 * kGravity * std::sin(0.1);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::quadratic().with({0.7}))) - std::sqrt(weight / 0.7)) < 1e-15);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::power_law().with({0.7, 0.5}))) - weight / 0.7 * weight / 0.7) <
        1e-15);
  // v / (1 + v²/v_c²) = w has v = v_c (v_c - sqrt(v_c² - 4 w²)) / (2 w) as its stable root.
  const double w = weight / 2.0;
  const double stable = (1.0 - std::sqrt(1.0 - 4.0 * w * w)) / (2.0 * w);
  CHECK(std::abs(*limit_speed_m_s(body(0.4, 0.1, laws::eddy_rolloff().with({2.0, 1.0}))) - stable) < 1e-15);
  // Stribeck and viscous: the net force vanishes there and a glider comes to it.
  const Body stribeck = body(0.4, 0.1, laws::stribeck().with({0.05, 1.8, 0.1}), laws::viscous().with({0.5}));
  const double v_lim = *limit_speed_m_s(stribeck);
  CHECK(std::abs(net_force_n(stribeck, v_lim, +1)) < 1e-15);
  for (const double v0 : {0.0, 0.3, 1.5}) {
    CHECK(std::abs(simulate(stribeck, 0.0, v0, std::vector<double>{60.0}).states[0].v_m_s - v_lim) < 1e-10);
  }
}

TEST_CASE("a stable speed that a resting glider never reaches is the limit speed of a moving one") {
  // Held at rest by 1.2 tan(alpha), driven above the dip of the Stribeck curve.
  const double mu = 0.4 * std::tan(0.1);
  const Body glider = body(0.4, 0.1, laws::stribeck().with({mu, 3.0, 0.1}), laws::viscous().with({0.2}));
  const double v_lim = *limit_speed_m_s(glider);
  CHECK(mode_at_rest(glider) == Mode::stick);
  CHECK(std::abs(simulate(glider, 0.0, 0.8, std::vector<double>{60.0}).states[0].v_m_s - v_lim) < 1e-10);
}

TEST_CASE("there is no limit speed on a level track, uphill, without a drag, or where friction holds") {
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.0, laws::viscous().with({1.0}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, -0.1, laws::viscous().with({1.0}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::coulomb().with({0.01}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::viscous().with({1.0}), laws::coulomb().with({0.2}))));
  CHECK_FALSE(limit_speed_m_s(body(0.4, 0.1, laws::viscous().with({1.0}), laws::coulomb().with({std::tan(0.1)}))));
  CHECK_FALSE(
      limit_speed_m_s(body(0.4, 0.4, laws::eddy_rolloff().with({1.0, 0.5}))));  // stronger than the brake's peak
}
