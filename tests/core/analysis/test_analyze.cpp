#include "core/analysis/analyze.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <string>

#include "base/errors.h"
#include "core/analysis/clip_to_track.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using core::analyze;

namespace {

const tests::Law kLaw{4.3, 0.0071, 2.77};

void write_track(const std::filesystem::path& file, const tests::SimulatedMotion& motion, unsigned seed) {
  const core::TrackData track = tests::film(motion, {200.0, 1.7, 2e-5, seed});
  std::ofstream out(file);
  out << "t_s,x_m\n";
  for (std::size_t i = 0; i < track.t_s.size(); ++i) out << fmt::format("{},{}\n", track.t_s[i], track.x_m[i]);
}

/// A folder with an "up" and a "down" of kLaw, stated as 4 degrees.
std::filesystem::path make_folder(const std::filesystem::path& folder, unsigned seed, const std::string& extra = {}) {
  std::filesystem::create_directories(folder / "tracks");
  write_track(folder / "tracks/up.csv", tests::launch(kLaw, -1.3, 1.7), seed);
  write_track(folder / "tracks/down.csv", tests::launch(kLaw, 1.2, 1.7), seed + 1);
  std::ofstream toml(folder / "experiment.toml");
  toml << "format = 1\nname = \"" << folder.filename().string() << " (test)\"\n"
       << extra << "[track]\ndownhill = \"+X\"\n";
  for (const std::string name : {"up", "down"}) {
    toml << fmt::format(
        "[[clip]]\nname = \"{0}\"\ntrack = \"tracks/{0}.csv\"\nmass_kg = 0.335\nincline_deg = 4.0\n"
        "launched = \"{0}\"\n",
        name);
  }
  return folder;
}

}  // namespace

TEST_CASE("a folder of two tracks gives the law that made them") {
  const tests::TempDir temp;
  const auto results = analyze({make_folder(temp / "one", 1)}, {});
  REQUIRE(results.clips.size() == 2);
  CHECK(results.clips[0].name == "up");
  CHECK(results.clips[0].experiment == "one (test)");
  CHECK(results.estimator == "phase-diagram");
  REQUIRE(results.configurations.size() == 1);
  const core::ConfigurationResult& found = results.configurations[0];
  CHECK(found.clips == std::vector<std::string>{"up", "down"});
  // Four standard deviations, as stated: 1 in 16,000 by chance.
  const auto close = [](const core::Quantity& quantity, double truth) {
    REQUIRE(quantity.estimate);
    INFO(quantity.estimate->value << " +- " << quantity.estimate->sd << ", truth " << truth);
    CHECK(std::abs(quantity.estimate->value - truth) < 4.0 * quantity.estimate->sd);
    CHECK(quantity.estimate->low95 < quantity.estimate->value);
    CHECK(quantity.estimate->high95 > quantity.estimate->value);
  };
  close(found.k_over_m_1_s, kLaw.k_1_s);
  close(found.mu, kLaw.mu);
  close(found.alpha_deg, kLaw.alpha_deg);
  close(found.v_lim_m_s, kLaw.v_lim());
}

TEST_CASE("a file alone that goes up and down gives mu and alpha whatever mass and inclination are stated") {
  const tests::TempDir temp;
  write_track(temp / "up.csv", tests::launch(kLaw, -1.3, 1.7), 1);
  for (const double incline_deg : {-4.0, 0.0, 4.0}) {
    core::AnalysisOptions options;
    options.bare.mass_kg = 0.2;
    options.bare.incline_deg = incline_deg;
    const auto results = analyze({temp / "up.csv"}, options);
    INFO("stated " << incline_deg);
    for (const core::LeftOutInterval& interval : results.clips.at(0).left_out) {
      CHECK(interval.reason != core::LeftOut::hand);
    }
    const core::ConfigurationResult& found = results.configurations.at(0);
    REQUIRE(found.mu.estimate);
    REQUIRE(found.alpha_deg.estimate);
    // Four standard deviations, as stated: 1 in 16,000 by chance.
    CHECK(std::abs(found.mu.estimate->value - kLaw.mu) < 4.0 * found.mu.estimate->sd);
    CHECK(std::abs(found.alpha_deg.estimate->value - kLaw.alpha_deg) < 4.0 * found.alpha_deg.estimate->sd);
  }
}

TEST_CASE("a launch stated the wrong way round is why there is no mu, with the clip and the time of the turn") {
  const tests::TempDir temp;
  const auto folder = make_folder(temp / "one", 1);
  std::ifstream in(folder / "experiment.toml");
  std::string toml((std::istreambuf_iterator<char>(in)), {});
  toml.replace(toml.find("launched = \"up\""), 15, "launched = \"down\"");
  std::ofstream(folder / "experiment.toml") << toml;
  const auto results = analyze({folder}, {});
  const core::Quantity& mu = results.configurations.at(0).mu;
  CHECK_FALSE(mu.estimate);
  REQUIRE(mu.why);
  REQUIRE(mu.why->against_launch.size() == 1);
  const core::ClipAgainstLaunch& up = mu.why->against_launch[0];
  CHECK(up.clip == "up");
  CHECK(up.motion.direction == -1);
  REQUIRE(up.motion.until_s);
  // v = 0 in closed form, give or take the first smoothing's four frames.
  const double turn_s = std::log1p(1.3 * kLaw.k_1_s / kLaw.a0(-1)) / kLaw.k_1_s;
  CHECK(std::abs(*up.motion.until_s - turn_s) < 0.02);
}

TEST_CASE("clips of one name in two folders get their folder's name, and join one configuration") {
  const tests::TempDir temp;
  const auto results = analyze({make_folder(temp / "one", 1), make_folder(temp / "two", 11)}, {});
  REQUIRE(results.clips.size() == 4);
  CHECK(results.clips[0].name == "one-up");
  CHECK(results.clips[3].name == "two-down");
  REQUIRE(results.configurations.size() == 1);
  CHECK(results.configurations[0].clips.size() == 4);
}

TEST_CASE("any number of jobs gives the same results") {
  const tests::TempDir temp;
  const auto folder = make_folder(temp / "one", 1);
  const auto alone = analyze({folder}, {}), together = analyze({folder}, {std::nullopt, 4});
  for (std::size_t i = 0; i < alone.clips.size(); ++i) {
    CHECK(alone.clips[i].bandwidth_s == together.clips[i].bandwidth_s);
    REQUIRE(alone.clips[i].segments.size() == together.clips[i].segments.size());
    for (std::size_t s = 0; s < alone.clips[i].segments.size(); ++s) {
      CHECK(alone.clips[i].segments[s].k_over_m_1_s.value == together.clips[i].segments[s].k_over_m_1_s.value);
    }
  }
}

TEST_CASE("a bandwidth given is used for all clips, and one that is no time is an input error") {
  const tests::TempDir temp;
  const auto folder = make_folder(temp / "one", 1);
  const auto results = analyze({folder}, {0.05, 1});
  for (const core::ClipResult& clip : results.clips) CHECK(clip.bandwidth_s == 0.05);
  CHECK_THROWS_AS(analyze({folder}, {0.0, 1}), base::InputError);
  CHECK_THROWS_AS(analyze({folder}, {std::numeric_limits<double>::quiet_NaN(), 1}), base::InputError);
}

TEST_CASE("folders that cannot be analysed together are input errors that name them") {
  const tests::TempDir temp;
  const auto one = make_folder(temp / "one", 1), moon = make_folder(temp / "moon", 1, "gravity_m_s2 = 1.62\n");
  CHECK_THROWS_WITH(analyze({one, moon}, {}), Contains("moon") && Contains("1.62"));
  CHECK_THROWS_WITH(analyze({one, temp / "one/../one"}, {}), Contains("second time"));
  CHECK_THROWS_AS(analyze({}, {}), base::InputError);
  std::ofstream(temp / "lines.csv") << "mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s,r2\n";
  std::ofstream(temp / "experiment.toml") << "format = 1\nname = \"t\"\nlines = \"lines.csv\"\n[track]\ndownhill = "
                                             "\"+X\"\n";
  CHECK_THROWS_WITH(analyze({temp.path()}, {}),
                    Contains("lines: found a table of lines") && Contains("glidelab diagnose"));
}

TEST_CASE("gravity that is no place's enters alpha with its spread, stated or not, of folders as of files") {
  const tests::TempDir temp;
  const auto found = [](const std::filesystem::path& input, const core::TrackFileOptions& bare) {
    core::AnalysisOptions how;
    how.bare = bare;
    return analyze({input}, how);
  };
  const auto folder = [&](const std::string& name, const std::string& lines) {
    return found(make_folder(temp / name, 1, lines), {});
  };
  const auto sd_of = [](const core::AnalysisResults& results) {
    return results.configurations[0].alpha_deg.estimate->sd;
  };
  const auto is_told = [](const core::AnalysisResults& results) {
    return tests::note_of<core::GravityAssumed>(results.configurations[0].notes) != nullptr;
  };
  const auto exact = folder("exact", "gravity_m_s2 = 9.81\ngravity_sd_m_s2 = 0.0\n");
  CHECK_FALSE(is_told(exact));
  for (const char* const lines : {"", "gravity_m_s2 = 9.8\n"}) {
    const auto vague = folder(fmt::format("vague{}", std::string(lines).size()), lines);
    INFO(lines);
    CHECK(is_told(vague));
    CHECK(vague.gravity_sd_m_s2 == 0.015);
    // alpha = asin(mean / g): d alpha / d g = -tan(alpha) / g. The values of g differ by 0.1 %, and so do these.
    const double tangent = std::tan(kLaw.alpha_deg / 57.29577951308232);
    const double of_gravity_deg = 57.29577951308232 * tangent * 0.015 / 9.81;
    CHECK(sd_of(vague) == Approx(std::hypot(sd_of(exact), of_gravity_deg)).epsilon(5e-3));
  }
  const auto place = folder("place", "gravity_m_s2 = 9.8123\n");
  CHECK_FALSE(is_told(place));
  CHECK(place.gravity_sd_m_s2 == Approx(0.0001 / std::sqrt(12.0)).epsilon(1e-9));
  write_track(temp / "up.csv", tests::launch(kLaw, -1.3, 1.7), 1);
  CHECK(is_told(found(temp / "up.csv", {})));
  core::TrackFileOptions stated;
  stated.gravity_m_s2 = 9.8;
  CHECK(is_told(found(temp / "up.csv", stated)));
  CHECK(found(temp / "up.csv", stated).gravity_m_s2 == 9.8);
  stated.gravity_sd_m_s2 = 0.0;
  CHECK_FALSE(is_told(found(temp / "up.csv", stated)));
  // One that knows its place is enough.
  std::filesystem::rename(temp / "exact", temp / "again");
  const auto both = analyze({temp / "again", make_folder(temp / "other", 3, "gravity_m_s2 = 9.81\n")}, {});
  CHECK(both.gravity_sd_m_s2 == 0.0);
}

TEST_CASE("recordings of one name in two folders are told apart in the results") {
  const tests::TempDir temp;
  for (const char* const folder : {"a", "b"}) {
    std::filesystem::create_directories(temp / folder);
    write_track(temp / folder / "run1.csv", tests::launch(kLaw, -1.3, 1.7), 1);
  }
  const auto results = analyze({temp / "a/run1.csv", temp / "b/run1.csv"}, {});
  CHECK(results.clips[0].experiment == "a-run1");
  CHECK(results.clips[1].experiment == "b-run1");
}

TEST_CASE(
    "the heights of a set-up have one sign, also that of a clip too short to show it, and follow a stated launch") {
  const tests::TempDir temp;
  std::filesystem::create_directories(temp / "drops");
  const auto write = [&](const std::string& name, int points, const std::function<double(double)>& height_m) {
    std::ofstream out(temp / "drops" / name);
    out << "t (s),y (m)\n";
    for (int i = 0; i < points; ++i) out << fmt::format("{},{:.5f}\n", 0.01 * i, height_m(0.01 * i));
  };
  write("long.csv", 50, [](double t) { return 2.0 - 4.9 * t * t; });
  write("short.csv", 12, [](double t) { return 0.2 + 0.01 * t; });  // a hand's, and by itself counted upwards
  const auto read = [&](const std::string& launched, double incline_deg) {
    std::ofstream toml(temp / "drops/experiment.toml");
    toml << "format = 1\nname = \"drops\"\n";
    for (const std::string name : {"long", "short"}) {
      toml << fmt::format(
          "[[clip]]\nname = \"{0}\"\ntrack = \"{0}.csv\"\nmass_kg = 0.1\nincline_deg = {1}\n"
          "launched = \"{2}\"\n",
          name, incline_deg, launched);
    }
    toml.close();
    return core::tracks_of(core::read_experiment(temp / "drops"), 1).tracks;
  };
  for (const double incline_deg : {90.0, 30.0}) {
    const auto released = read("released", incline_deg);
    CHECK(released[0].x_m.back() > released[0].x_m.front());
    CHECK(released[1].x_m.back() < released[1].x_m.front());  // reversed with the other
  }
  const auto down = read("down", 90.0), up = read("up", 90.0);
  CHECK(down[0].x_m.back() > down[0].x_m.front());
  CHECK(up[0].x_m.back() < up[0].x_m.front());
}

TEST_CASE("progress is told up to the end, and may stop the work") {
  const tests::TempDir temp;
  const auto folder = make_folder(temp / "one", 1);
  double last = 0.0;
  analyze({folder}, {}, [&](std::string_view, double fraction) { last = fraction; });
  CHECK(last == 1.0);
  CHECK_THROWS_AS(analyze({folder}, {}, [](std::string_view, double) { throw base::Interrupted(); }),
                  base::Interrupted);
}

TEST_CASE("a file alone with a recorded force needs the mass that the force accelerates") {
  const tests::TempDir temp;
  std::ofstream file(temp / "driven.csv");
  file << "t_s,x_m,force_n\n";
  for (int i = 0; i < 200; ++i) {  // x'' = F/m, F = 3 N, m = 2 kg
    const double t_s = 0.005 * i;
    file << fmt::format("{},{},{}\n", t_s, 0.75 * t_s * t_s, 3.0);
  }
  file.close();
  CHECK_THROWS_WITH(analyze({temp / "driven.csv"}, {}),
                    Contains("driven.csv") && Contains("--mass") && Contains("recorded force"));
  core::AnalysisOptions stated;
  stated.bare.mass_kg = 2.0;
  CHECK(analyze({temp / "driven.csv"}, stated).clips.at(0).forced);
}

TEST_CASE("x of a fall is counted downwards, but not against a recorded force or a stated launch") {
  const tests::TempDir temp;
  const auto first_step = [&](const std::string& header, const std::string& launched,
                              const std::function<double(double)>& x) {
    std::ofstream out(temp / "track.csv");
    out << header << "\n";
    for (int i = 0; i < 80; ++i) {
      const double t = 0.01 * i;
      out << fmt::format("{},{}{}\n", t, x(t), header == "t_s,x_m" ? "" : ",1.5");
    }
    out.close();
    std::ofstream toml(temp / "experiment.toml");
    toml << "format = 1\nname = \"fall\"\n[[clip]]\nname = \"a\"\ntrack = \"track.csv\"\nmass_kg = 0.1\n"
         << "incline_deg = 90\nlaunched = \"" << launched << "\"\n";
    toml.close();
    const auto results = analyze({temp.path()}, {});
    return *results.clips[0].motion[20].measured_m - *results.clips[0].motion[0].measured_m;
  };
  const auto up = [](double t) { return -0.5 * 9.81 * t * t; };
  CHECK(first_step("t_s,x_m", "released", up) > 0.0);
  CHECK(first_step("t_s,x_m", "released", [&](double t) { return -up(t); }) > 0.0);
  CHECK(first_step("t_s,x_m", "up", up) < 0.0);                // thrown, and never seen to come back
  CHECK(first_step("t_s,x_m,force_n", "released", up) < 0.0);  // lifted by a force
}

TEST_CASE("a table that speeds up like a fall is suspected to be one where nobody states an inclination") {
  const tests::TempDir temp;
  const auto suspected = [&](double a_m_s2, double until_s, std::optional<double> incline_deg, double braked_m_s2 = 0.0,
                             double sign = 1.0) {
    std::ofstream out(temp / "table.csv");
    out << "Time (s),Position (m)\n";
    const double v = a_m_s2 * until_s;
    for (int i = 0; i < 150; ++i) {  // it speeds up for some time, and keeps its speed or is braked
      const double t = 0.01 * i, s = t - until_s;
      const double x = s < 0.0 ? 0.5 * a_m_s2 * t * t : 0.5 * v * until_s + v * s - 0.5 * braked_m_s2 * s * s;
      out << fmt::format("{},{:.6f}\n", t, sign * x);
    }
    out.close();
    core::AnalysisOptions options;
    options.bare.incline_deg = incline_deg;
    const auto results = analyze({temp / "table.csv"}, options);
    return tests::note_of<core::MayBeAFall>(results.configurations[0].notes) != nullptr;
  };
  CHECK(suspected(7.0, 0.3, {}));
  CHECK_FALSE(suspected(7.0, 0.3, 0.0));   // somebody says that the track is level
  CHECK_FALSE(suspected(1.5, 0.3, {}));    // a gentle hand
  CHECK_FALSE(suspected(15.0, 0.15, {}));  // a push: nothing falls like this
  // A plunger gives 0.6 m/s within 18 mm, and the cart goes on for half a metre: no fall slows down.
  CHECK(suspected(8.0, 0.08, {}));
  CHECK_FALSE(suspected(8.0, 0.08, {}, 0.25));
  CHECK_FALSE(suspected(8.0, 0.08, {}, 0.25, -1.0));
}
