/// `glidelab analyze` on a folder of tracks: files, JSON, exit statuses, nothing half-written.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "test_paths.h"
#include "tests/app/made_track.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::size_t entries(const fs::path& dir) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(dir), fs::directory_iterator{}));
}

}  // namespace

TEST_CASE("analyze writes its files, and --json prints exactly results.json") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result =
      tests::glidelab({"analyze", (temp / "made").string(), "--out", (temp / "out").string(), "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  CHECK(result.out == base::read_file(temp / "out/results.json"));
  const json document = json::parse(result.out);
  CHECK(document.at("format") == 1);
  CHECK(document.at("clips").at(0).at("name") == "up");
  CHECK(document.at("clips").at(0).at("frames") == 340);
  CHECK(document.at("configurations").at(0).at("mass_kg") == 0.335);
  CHECK(document.at("calibration").is_null());
  CHECK(fs::exists(temp / "out/report.html"));
  const base::CsvTable phase =
      base::read_csv(temp / "out/phase-up.csv", {"t_s", "x_m", "v_m_s", "a_m_s2", "used"}, {}, true);
  CHECK(phase.column("t_s").size() > 100);
  CHECK(entries(temp.path()) == 2);  // made, out: no staging folder is left
}

TEST_CASE("analyze takes the bandwidth from the rule that is named, and says so") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const auto clip_of = [&](const std::string& bandwidth) {
    const tests::ProcessResult result = tests::glidelab({"analyze", (temp / "made").string(), "--bandwidth", bandwidth,
                                                         "--out", (temp / bandwidth).string(), "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    return json::parse(result.out).at("clips").at(0);
  };
  CHECK(clip_of("plug-in").at("bandwidth_method").get<std::string>().starts_with("plug-in"));
  CHECK(clip_of("ebbs").at("bandwidth_method").get<std::string>().starts_with("empirical bias"));
  CHECK(clip_of("0.05").at("bandwidth_s") == 0.05);
  CHECK(clip_of("lines").at("bandwidth_method").get<std::string>().starts_with("least mean squared error"));
}

TEST_CASE("analyze smooths as it is asked to, says how strongly, and refuses what does not go together") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const auto run = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"analyze", (temp / "made").string(), "--out", (temp / "out").string(), "--json"};
    words.insert(words.end(), options.begin(), options.end());
    return tests::glidelab(words);
  };
  for (const std::string smoother : {"kalman", "spline"}) {
    const tests::ProcessResult result = run({"--smoother", smoother});
    INFO(result.err);
    REQUIRE(result.status == 0);
    const json clip = json::parse(result.out).at("clips").at(0);
    CHECK(clip.at("smoothing").at("smoother") == smoother);
    CHECK(clip.at("smoothing").at("time_s") > 0.0);
    CHECK(base::read_file(temp / "out/report.html").find("Smoother " + smoother + ": smoothing time ") !=
          std::string::npos);
    fs::remove_all(temp / "out");
  }
  for (const std::vector<std::string>& refused :
       std::vector<std::vector<std::string>>{{"--smoother", "kalman", "--bandwidth", "0.05"},
                                             {"--smoother", "spline", "--bandwidth", "lines"},
                                             {"--smoother", "kalman", "--estimator", "phase-diagram-gls"},
                                             {"--smoother", "kalmann"}}) {
    const tests::ProcessResult result = run(refused);
    CHECK(result.status == 2);  // as any option that does not go with another
    CHECK(result.err.find("smoother") != std::string::npos);
    CHECK_FALSE(fs::exists(temp / "out"));
  }
}

TEST_CASE("analyze fits generalised lines where they are asked for, in the same form") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  json found[2];
  int at = 0;
  for (const std::string estimator : {"phase-diagram", "phase-diagram-gls"}) {
    const tests::ProcessResult result = tests::glidelab({"analyze", (temp / "made").string(), "--estimator", estimator,
                                                         "--out", (temp / estimator).string(), "--json"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    found[at] = json::parse(result.out);
    CHECK(found[at].at("estimator") == estimator);
    ++at;
  }
  const auto sd = [](const json& of) {
    return of.at("configurations").at(0).at("k_over_m_1_s").at("sd").get<double>();
  };
  CHECK(sd(found[1]) < sd(found[0]));
  const json &plain = found[0].at("clips").at(0).at("segments").at(0),
             &better = found[1].at("clips").at(0).at("segments").at(0);
  for (const auto& [key, value] : plain.items()) CHECK(better.contains(key));
}

TEST_CASE("analyze --with gives the numbers with an effect in the model beside its own, and refuses what it cannot") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const std::string folder = (temp / "made").string();
  const tests::ProcessResult plain = tests::glidelab({"analyze", folder, "--out", (temp / "plain").string(), "--json"});
  REQUIRE(plain.status == 0);
  const tests::ProcessResult result =
      tests::glidelab({"analyze", "--with", "quadratic_drag", folder, "--out", (temp / "out").string(), "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  json document = json::parse(result.out);
  const json with = document.at("with");
  CHECK(with.at("effects").at(0).at("id") == "quadratic_drag");
  CHECK(with.at("effects").at(0).at("parameters").contains("c_kg_m"));
  const json& k = with.at("recovered").at(0).at("k_over_m_1_s");
  // Nothing but the law acts on this track: its K/m, 2.768, within four standard deviations.
  CHECK(std::abs(k.at("value").get<double>() - 2.768) < 4.0 * k.at("sd").get<double>());
  document.erase("with");
  CHECK(document == json::parse(plain.out));
  CHECK(base::read_file(temp / "out/report.html").find("With this effect in the model: quadratic drag") !=
        std::string::npos);
  const tests::ProcessResult text =
      tests::glidelab({"analyze", folder, "--with", "quadratic_drag", "--out", (temp / "out").string()});
  CHECK(text.out.find("the law alone") != std::string::npos);

  for (const char* const id : {"quadratic_darg", "light_flicker", "rolling_shutter"}) {
    const tests::ProcessResult refused =
        tests::glidelab({"analyze", folder, "--with", id, "--out", (temp / "none").string()});
    INFO(refused.err);
    CHECK(refused.status == 1);
    CHECK(refused.out.empty());
    CHECK(refused.err.find(id) != std::string::npos);
    CHECK(refused.err.find("quadratic_drag") != std::string::npos);
    CHECK_FALSE(fs::exists(temp / "none"));
  }
}

TEST_CASE("analyze takes a file that another program exported, its column of x by name") {
  const tests::TempDir temp;
  std::string text = "Run 1: Time (s);Run 1: Position (cm);Run 2: Time (s);Run 2: Position (cm)\n";
  for (int i = 0; i < 300; ++i) {  // 1.2 m/s, slowing down at 2 1/s and 0.07 m/s^2; a decimal comma
    const double t = 0.005 * i, x = 100.0 * (-0.035 * t - 0.6175 * std::expm1(-2.0 * t));
    std::string row = fmt::format("{:.3f};{:.6f};{:.3f};{:.6f}\n", t, 0.5 * x, t, x + 1e-3 * ((i * 37) % 11 - 5));
    std::replace(row.begin(), row.end(), '.', ',');
    text += row;
  }
  base::write_file(temp / "glider.csv", text);
  const std::string file = (temp / "glider.csv").string(), out = (temp / "out").string();
  const tests::ProcessResult unclear = tests::glidelab({"analyze", file, "--out", out});
  CHECK(unclear.status == 1);
  CHECK(unclear.err.find("Run 2: Position (cm)") != std::string::npos);
  CHECK_FALSE(fs::exists(out));
  const tests::ProcessResult result =
      tests::glidelab({"analyze", file, "--column", "Run 2: Position", "--mass", "0.3", "--out", out, "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("configurations").at(0).at("mass_kg") == 0.3);
  CHECK(document.at("clips").at(0).at("name") == "glider");
  const json& k = document.at("clips").at(0).at("segments").at(0).at("k_over_m_1_s");
  CHECK(std::abs(k.at("value").get<double>() - 2.0) < 4.0 * k.at("sd").get<double>());
  CHECK(fs::exists(temp / "out/motion-glider.csv"));
  CHECK(fs::exists(temp / "out/report.html"));
  // What analyze takes, check and diagnose take as well, with the same options.
  const tests::ProcessResult checked = tests::glidelab(
      {"check", file, "--column", "Run 2: Position", "--mass", "0.3", "--out", (temp / "check").string()});
  INFO(checked.err);
  CHECK(checked.status == 0);
  const tests::ProcessResult diagnosed = tests::glidelab(
      {"diagnose", file, "--column", "Run 2: Position", "--no-page", "--out", (temp / "diagnosis").string()});
  INFO(diagnosed.err);
  CHECK(diagnosed.status == 0);
  const tests::ProcessResult runs =
      tests::glidelab({"analyze", file, "--runs", "all", "--masses", "0.3,0.4", "--out", out, "--json"});
  INFO(runs.err);
  REQUIRE(runs.status == 0);
  CHECK(json::parse(runs.out).at("configurations").size() == 2);
  const tests::ProcessResult comma = tests::glidelab({"analyze", file, "--mass", "0,335"});
  CHECK(comma.status == 2);
  CHECK(comma.err.find("use a decimal point: 0.335") != std::string::npos);
  const tests::ProcessResult without = tests::glidelab({"analyze", file, "--column", "4", "--out", out});
  CHECK(without.status == 0);
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult folder = tests::glidelab({"analyze", (temp / "made").string(), "--column", "2"});
  CHECK(folder.status == 1);
  CHECK(folder.err.find("--column") != std::string::npos);
}

TEST_CASE(
    "what a sensor wrote while it saw nothing is told by analyze, check and diagnose, and files have masses each") {
  const tests::TempDir temp;
  std::vector<std::string> files;
  for (const double speed_m_s : {0.8, 0.9}) {
    std::string text = "t (s),x (m)\n";
    for (int i = 0; i < 120; ++i) {
      const double t = 0.02 * i, noise = 2e-4 * std::sin(1.7 * i * i);
      const double x = i >= 100 ? 0.0 : 0.5 + speed_m_s * (1.0 - std::exp(-0.5 * t)) / 0.5 + noise;
      text += fmt::format("{:.3f},{:.6f}\n", t, x);
    }
    files.push_back((temp / fmt::format("{}.csv", speed_m_s)).string());
    std::ofstream(files.back()) << text;
  }
  for (const char* command : {"analyze", "check", "diagnose"}) {
    const tests::ProcessResult one =
        tests::glidelab({command, files[0], "--incline", "0", "--mass", "0.3", "--out", (temp / command).string()});
    INFO(command << one.err << one.out);
    CHECK(one.status == 0);
    std::string words = one.out;  // lines are wrapped
    std::replace(words.begin(), words.end(), '\n', ' ');
    CHECK(words.find("20 positions that are all 0 m, from 2 s on, are left out") != std::string::npos);
  }
  const tests::ProcessResult masses = tests::glidelab(
      {"analyze", files[0], files[1], "--masses", "0.3,0.4", "--json", "--out", (temp / "masses").string()});
  INFO(masses.err);
  REQUIRE(masses.status == 0);
  CHECK(json::parse(masses.out).at("configurations").size() == 2);
  const tests::ProcessResult one_mass =
      tests::glidelab({"diagnose", files[0], files[1], "--masses", "0.3", "--out", (temp / "masses").string()});
  CHECK(one_mass.status == 1);
  CHECK(one_mass.err.find("one for each of the 2 files") != std::string::npos);
}

TEST_CASE("analyze without --json prints a table, and the same files for any number of jobs") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  for (const char* jobs : {"1", "2"}) {
    const tests::ProcessResult result = tests::glidelab(
        {"analyze", (temp / "made").string(), "--out", (temp / jobs).string(), "--jobs", jobs, "--seed", "7"});
    INFO(result.err);
    REQUIRE(result.status == 0);
    CHECK(result.out.find("K/m (1/s)") != std::string::npos);
    CHECK(result.err.find("report: ") != std::string::npos);
    CHECK(result.err.find('\r') == std::string::npos);  // no bar where there is no terminal
  }
  std::size_t files = 0;
  std::set<std::string> sorts;  // of the phase diagram
  for (const auto& entry : std::filesystem::recursive_directory_iterator(temp / "1")) {
    if (!entry.is_regular_file()) continue;
    const std::filesystem::path name = std::filesystem::relative(entry.path(), temp / "1");
    CAPTURE(name);
    CHECK(base::read_file(entry.path()) == base::read_file(temp / "2" / name));
    if (name.stem().string().ends_with("acceleration-against-velocity-with-fitted-lines"))
      sorts.insert(name.extension());
    ++files;
  }
  CHECK(sorts == std::set<std::string>{".csv", ".gp", ".pdf", ".svg"});
  for (const char* file : {"results.json", "phase-up.csv", "motion-up.csv", "report.html"}) {
    CHECK(std::filesystem::exists(temp / "1" / file));
  }
  std::size_t others = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(temp / "2")) others += entry.is_regular_file();
  CHECK(files == others);
}

TEST_CASE("a quiet analysis says nothing on standard error") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result = tests::glidelab({"analyze", (temp / "made").string(), "-q"}, temp.path());
  CHECK(result.status == 0);
  CHECK(result.err.empty());
  CHECK(fs::exists(temp / "glidelab-out/analyze-made/results.json"));  // the documented default
}

TEST_CASE("a second analysis replaces its own files and leaves the others") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::create_directories(temp / "out");
  base::write_file(temp / "out/notes.txt", "mine");
  base::write_file(temp / "out/results.json", "old");
  const tests::ProcessResult result =
      tests::glidelab({"analyze", (temp / "made").string(), "--out", (temp / "out").string()});
  CHECK(result.status == 0);
  CHECK(base::read_file(temp / "out/notes.txt") == "mine");
  CHECK(base::read_file(temp / "out/results.json") != "old");
}

TEST_CASE("a wrong experiment.toml is status 1, one line for each error, and what stood there stays") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  std::string text = base::read_file(temp / "made/experiment.toml");
  text += "mas_kg = 1\nend_s = \"soon\"\n";
  base::write_file(temp / "made/experiment.toml", text);
  fs::create_directories(temp / "out");
  base::write_file(temp / "out/results.json", "old");
  const tests::ProcessResult result =
      tests::glidelab({"analyze", (temp / "made").string(), "--out", (temp / "out").string()});
  CHECK(result.status == 1);
  CHECK(result.out.empty());
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 2);
  CHECK(result.err.find("experiment.toml:12: clip[1].mas_kg") != std::string::npos);
  CHECK(result.err.find("experiment.toml:13: clip[1].end_s") != std::string::npos);
  CHECK(base::read_file(temp / "out/results.json") == "old");
  CHECK(entries(temp / "out") == 1);
}

TEST_CASE("an output that cannot be written is status 3, found before the work") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  base::write_file(temp / "file", "in the way");
  for (const std::string& out : {(temp / "file").string(), (temp / "file/below").string(), std::string("/proc/out")}) {
    const tests::ProcessResult result = tests::glidelab({"analyze", (temp / "made").string(), "--out", out});
    INFO(out << ": " << result.err);
    CHECK(result.status == 3);
    CHECK(result.err.starts_with("glidelab: error: "));
    CHECK(result.err.find(out) != std::string::npos);
  }
  CHECK(base::read_file(temp / "file") == "in the way");
  CHECK(entries(temp.path()) == 2);
}

TEST_CASE("a disk that fills up is status 3, and nothing is left under the final name") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  // Files of at most 8 blocks of 512 bytes: smaller than any of the results.
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "ulimit -f 8 && exec \"$0\" analyze made --out out", tests::kBinary}, temp.path());
  INFO(result.err);
  CHECK(result.status == 3);
  CHECK(entries(temp.path()) == 1);
}

TEST_CASE("a standard output that cannot be written is status 3") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  const tests::ProcessResult result =
      tests::run({"sh", "-c", "exec \"$0\" analyze made --json --out out > /dev/full", tests::kBinary}, temp.path());
  CHECK(result.status == 3);
}

TEST_CASE("a missing gnuplot is status 3, found before the work") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made");
  fs::create_directories(temp / "empty");
  const tests::ProcessResult result = tests::run(
      {"env", "PATH=" + (temp / "empty").string(), tests::kBinary, "analyze", "made", "--out", "out"}, temp.path());
  CHECK(result.status == 3);
  CHECK(result.err.find("gnuplot") != std::string::npos);
  CHECK_FALSE(fs::exists(temp / "out"));
}

TEST_CASE("clip names of any text neither break the page nor leave the folder") {
  const tests::TempDir temp;
  tests::write_track_experiment(temp / "made", "<script>alert(1)</script> it's ünï");
  const tests::ProcessResult result =
      tests::glidelab({"analyze", (temp / "made").string(), "--out", (temp / "out").string()});
  INFO(result.err);
  if (result.status == 1) {  // the reader may refuse such a name
    CHECK(result.err.find("name") != std::string::npos);
    return;
  }
  CHECK(result.status == 0);
  CHECK(base::read_file(temp / "out/report.html").find("<script") == std::string::npos);
  CHECK(entries(temp / "out") == 3);
}

namespace {

constexpr double kDragRate_1_s = 0.8, kMu = 0.005, kIncline_deg = 3.0, kSpeedNoise_m_s = 3e-3;

/// An encoder's table of a glider that is launched uphill and comes back: v' = g (sin alpha -+ mu cos alpha) - k v in
/// closed form on both sides of the turn, x downhill.
std::string table_of_speeds(unsigned seed) {
  const double alpha = kIncline_deg * std::acos(-1.0) / 180.0, g = 9.80665, v0 = -0.9;
  const double up = g * (std::sin(alpha) + kMu * std::cos(alpha)) / kDragRate_1_s;
  const double down = g * (std::sin(alpha) - kMu * std::cos(alpha)) / kDragRate_1_s;
  const double turn = std::log((up - v0) / up) / kDragRate_1_s;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, kSpeedNoise_m_s);
  std::string text = "t (s),v (m/s)\n";
  for (int i = 0; i < 500; ++i) {
    const double t = 0.005 * i;
    const double v =
        t < turn ? up + (v0 - up) * std::exp(-kDragRate_1_s * t) : -down * std::expm1(-kDragRate_1_s * (t - turn));
    text += fmt::format("{:.4f},{:.6f}\n", t, v + noise(random));
  }
  return text;
}

}  // namespace

TEST_CASE("gravity of a file is stated by --gravity, and a note follows what its digits or --gravity-sd leave open") {
  const tests::TempDir temp;
  const fs::path file = temp / "encoder.csv";
  base::write_file(file, table_of_speeds(7));
  const auto told = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"analyze", file.string(), "--out", (temp / "out").string()});
    const tests::ProcessResult result = tests::glidelab(more);
    INFO(result.err);
    REQUIRE(result.status == 0);
    return result.out.find("State its value at your place") != std::string::npos;
  };
  CHECK(told({}));
  CHECK(told({"--gravity", "9.8"}));
  CHECK_FALSE(told({"--gravity", "9.8123"}));
  CHECK_FALSE(told({"--gravity", "9.8", "--gravity-sd", "0.0001"}));
  CHECK(tests::glidelab({"analyze", file.string(), "--gravity-sd", "0.0001"}).status == 2);
  CHECK(tests::glidelab({"analyze", file.string(), "--gravity", "0"}).status == 2);
  fs::create_directories(temp / "folder");
  base::write_file(temp / "folder/experiment.toml", "format = 1\nname = \"x\"\n");
  const tests::ProcessResult folder = tests::glidelab({"check", (temp / "folder").string(), "--gravity", "9.8123"});
  CHECK(folder.status == 1);
  CHECK(folder.err.find("gravity_m_s2") != std::string::npos);
}

TEST_CASE("analyze takes speeds without positions, states none, and other estimators refuse them") {
  const tests::TempDir temp;
  const fs::path file = temp / "encoder.csv";
  base::write_file(file, table_of_speeds(7));
  const std::vector<std::string> words{"analyze", file.string(), "--mass", "0.4", "--incline", "3", "--json", "--out"};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return tests::glidelab(more);
  };
  const tests::ProcessResult result = run({(temp / "out").string()});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out), clip = document.at("clips").at(0);
  CHECK(clip.at("position_noise_m").is_null());
  // The standard deviation of 500 values is known to 3 %.
  CHECK(std::abs(clip.at("speed_noise_m_s").get<double>() - kSpeedNoise_m_s) < 0.15 * kSpeedNoise_m_s);
  const json k = document.at("configurations").at(0).at("k_over_m_1_s");
  CHECK(std::abs(k.at("value").get<double>() - kDragRate_1_s) < 4.0 * k.at("sd").get<double>());
  CHECK(k.at("sd").get<double>() < 0.1);
  CHECK(base::read_file(temp / "out/report.html").find("v(t)") != std::string::npos);
  const tests::ProcessResult refused = run({(temp / "fit").string(), "--estimator", "trajectory"});
  CHECK(refused.status == 1);
  CHECK(refused.err.find("speeds") != std::string::npos);
  CHECK_FALSE(fs::exists(temp / "fit"));
}
