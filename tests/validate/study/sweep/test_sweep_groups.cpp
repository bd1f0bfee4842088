/// What may be compared where some runs of a sweep have no answer.
#include "report/text/why_words.h"
#include "validate/study/sweep/sweep_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sweep_summary.h"

using namespace glidelab;

namespace {

constexpr const char* kRatesAndNoise = R"(
[[vary]]
key = "camera.frame_rate_hz"
values = [50, 80, 100]
[[vary]]
key = "tracks.noise_m"
values = [1e-5, 1e-4]
)";

enum class Outcome { answer, none, failed };
using Fate =
    std::function<Outcome(const std::string& configuration, double rate, double noise, std::uint64_t replicate)>;

/// 3, 2 and 1 at 50, 80 and 100 Hz, ten times as much with the larger noise, twice that in "b": of either sign in turn.
double error_of(const std::string& configuration, double rate, double noise, std::uint64_t replicate) {
  const double of_rate = rate == 50.0 ? 3.0 : (rate == 80.0 ? 2.0 : 1.0);
  return of_rate * (noise > 5e-5 ? 10.0 : 1.0) * (configuration == "b" ? 2.0 : 1.0) * (replicate % 2 == 0 ? 1.0 : -1.0);
}

/// Rows with these errors, and no run behind them.
struct Made {
  tests::TempDir dir;
  validate::Sweep sweep;
  std::unique_ptr<validate::SweepDatabase> database;
  explicit Made(const Fate& fate, const std::string& vary = kRatesAndNoise) {
    sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 2", tests::kNoise + vary));
    database =
        std::make_unique<validate::SweepDatabase>(dir / "a.sqlite", sweep, "1", validate::Shard{}, report::why_words);
    for (std::uint64_t run = 0; run < validate::run_count(sweep); ++run) {
      validate::RunRecord record;
      record.run = run;
      record.point = run / sweep.replicates;
      record.replicate = run % sweep.replicates;
      record.values = validate::values_of(sweep, run);
      const double rate = std::get<double>(record.values[0]), noise = std::get<double>(record.values[1]);
      for (const std::string configuration : {"a", "b"}) {
        const Outcome outcome = fate(configuration, rate, noise, record.replicate);
        record.failed = record.failed || outcome == Outcome::failed;
        validate::QuantityRow row{configuration, "trajectory", "mu", 7.0, {}, {}, {}, {}, {}, {}};
        if (outcome == Outcome::answer) {
          row.value = 7.0 + error_of(configuration, rate, noise, record.replicate);
          row.sd = 2.0;
        }
        record.quantities.push_back(row);
      }
      if (record.failed) record.quantities.clear();
      database->add(record, 0.1);
    }
  }
  validate::SweepSummary summary() { return validate::summarize(sweep, database->database()); }
};

}  // namespace

TEST_CASE("Values of a key are compared over the combinations that are answered at all of them") {
  // Errors are products, so that over like combinations they are as 3, 2 and 1 whatever these are.
  Made made([](const std::string&, double rate, double noise, std::uint64_t replicate) {
    if (rate == 50.0 && noise > 5e-5) return Outcome::failed;
    if (rate == 80.0 && noise < 5e-5 && replicate == 1) return Outcome::none;  // half of them do
    return Outcome::answer;
  });
  const validate::SweepSummary summary = made.summary();
  const validate::Series& rates = summary.axes[0].series.front();
  CHECK_FALSE(rates.likeness.whole);
  CHECK(rates.likeness.combinations == 4);  // of two noises and two configurations
  CHECK(rates.likeness.alike == 2);
  REQUIRE(rates.groups.size() == 3);
  const double both = std::sqrt((1.0 + 4.0) / 2.0);  // of the two configurations
  for (std::size_t i = 0; i < 3; ++i) {
    const validate::ErrorStatistics* const of = validate::comparable(rates, rates.groups[i]);
    REQUIRE(of != nullptr);
    CHECK(of->rms == Approx(both * static_cast<double>(3 - i)).epsilon(1e-12));
    CHECK(of->answered == (i == 1 ? 2 : 4));
  }
  // All that have an answer, as they are: most at the rate at which the hard ones have one.
  CHECK(rates.groups[1].statistics.rms > 4.0 * rates.groups[0].statistics.rms);
  const validate::Series& noises = summary.axes[1].series.front();  // the larger one has no answers at 50 Hz
  CHECK(noises.likeness.combinations == 6);
  CHECK(noises.likeness.alike == 4);
  CHECK(validate::comparable(noises, noises.groups[1])->rms / validate::comparable(noises, noises.groups[0])->rms ==
        Approx(10.0).epsilon(1e-12));
  for (std::size_t c = 0; c < 2; ++c) {  // of one configuration alone
    const validate::Series& of = summary.axes[0].of_configurations[c].front();
    CHECK(of.likeness.combinations == 2);
    CHECK(of.likeness.alike == 1);
    CHECK(validate::comparable(of, of.groups[0])->rms == Approx(3.0 * static_cast<double>(c + 1)).epsilon(1e-12));
  }
}

TEST_CASE("Without a combination that is answered at every value nothing is compared") {
  Made made([](const std::string&, double rate, double noise, std::uint64_t) {
    const bool hard = noise > 5e-5;
    return (rate == 50.0 && hard) || (rate == 100.0 && !hard) ? Outcome::failed : Outcome::answer;
  });
  const validate::Series rates = made.summary().axes[0].series.front();
  CHECK_FALSE(rates.likeness.whole);
  CHECK(rates.likeness.combinations == 4);
  CHECK(rates.likeness.alike == 0);
  for (const validate::GroupStatistics& group : rates.groups) CHECK(validate::comparable(rates, group) == nullptr);
}

TEST_CASE("Where values are drawn only a sweep in which every run has an answer is compared") {
  const std::string drawn =
      "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [50, 80]\n[[vary]]\nkey = \"tracks.noise_m\"\n"
      "random = { distribution = \"uniform\", from = 1e-5, to = 9e-5 }\n";
  Made whole([](const std::string&, double, double, std::uint64_t) { return Outcome::answer; }, drawn);
  const validate::Series all = whole.summary().axes[0].series.front();
  CHECK(all.likeness.whole);
  CHECK(validate::comparable(all, all.groups[0]) == &all.groups[0].statistics);
  Made part([](const std::string&, double rate, double,
               std::uint64_t replicate) { return rate == 50.0 && replicate == 1 ? Outcome::none : Outcome::answer; },
            drawn);
  const validate::Series some = part.summary().axes[0].series.front();
  CHECK_FALSE(some.likeness.whole);
  CHECK(some.likeness.combinations == 0);
  CHECK(validate::comparable(some, some.groups[0]) == nullptr);
}

TEST_CASE("Configurations are compared over the runs in which each has an answer") {
  Made made([](const std::string& configuration, double, double noise, std::uint64_t) {
    return configuration == "b" && noise > 5e-5 ? Outcome::none : Outcome::answer;
  });
  const validate::SweepSummary summary = made.summary();
  REQUIRE(summary.configurations.size() == 2);
  const validate::Series &a = summary.configurations[0].overall.front(), &b = summary.configurations[1].overall.front();
  CHECK(a.likeness.combinations == 12);
  CHECK(a.likeness.alike == 6);
  CHECK(validate::comparable(b, b.groups[0])->rms == Approx(2.0 * validate::comparable(a, a.groups[0])->rms));
  CHECK(a.groups[0].statistics.rms > 2.0 * b.groups[0].statistics.rms);  // the hard ones are in it
}

TEST_CASE("Of more than five kinds of failures the summary has five, how many more there are and of how many runs") {
  const auto failures = [](std::uint64_t kinds) {
    const tests::TempDir dir;
    const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(
        dir.path(), "replicates = 20", tests::kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n"));
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
    for (std::uint64_t run = 0; run < 20; ++run) {  // kind k: of 2 runs, the last of the rest
      const std::uint64_t kind = std::min(run / 2, kinds - 1);
      database.add({run, 0, run, run, {50.0}, true, std::string("reason ") + static_cast<char>('a' + kind), {}, {}},
                   0.1);
    }
    return validate::summarize(sweep, database.database()).failures;
  };
  const validate::FailedRuns eight = failures(8);  // 7 of two runs and one of 6
  REQUIRE(eight.kinds.size() == 5);
  CHECK(eight.kinds[0].runs == 6);
  CHECK(eight.kinds[0].one_text);
  CHECK_FALSE(eight.kinds[0].of_scenario);
  CHECK(eight.kinds[0].why == "reason h");
  CHECK(eight.other_kinds == 3);
  CHECK(eight.other_runs == 6);
  CHECK(failures(6).other_kinds == 1);
  CHECK(failures(6).other_runs == 2);
  CHECK(failures(5).other_kinds == 0);
}

TEST_CASE("Failures of one cause are one kind whatever its numbers, and one of them stands for it with short numbers") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(
      dir.path(), "replicates = 20", tests::kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n"));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  const std::string file = sweep.scenario_file.string();
  for (std::uint64_t run = 0; run < 20; ++run) {
    const double size = 1.0 / (3.0 + static_cast<double>(run));
    const std::string why = run < 12   ? fmt::format("no root between {} and 7", size)
                            : run < 18 ? fmt::format("{} with camera.frame_rate_hz = {}: too fast", file, size)
                            : run < 19 ? "no marker"
                                       : fmt::format("{} with camera.frame_rate_hz = 50: no light", file);
    database.add({run, 0, run, run, {50.0}, true, why, {}, {}}, 0.1);
  }
  struct Row {
    std::uint64_t runs;
    bool one_text, of_scenario;
    const char* why;
  };
  const std::vector<Row> rows = {{12, false, false, "no root between 0.3333 and 7"},
                                 {6, false, true, "camera.frame_rate_hz = 0.06667: too fast"},
                                 {1, true, true, "camera.frame_rate_hz = 50: no light"},
                                 {1, true, false, "no marker"}};
  const validate::FailedRuns found = validate::summarize(sweep, database.database()).failures;
  REQUIRE(found.kinds.size() == rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    INFO(rows[k].why);
    CHECK(found.kinds[k].runs == rows[k].runs);
    CHECK(found.kinds[k].one_text == rows[k].one_text);
    CHECK(found.kinds[k].of_scenario == rows[k].of_scenario);
    CHECK(found.kinds[k].why == rows[k].why);
  }
  CHECK(found.other_kinds == 0);
  CHECK(found.other_runs == 0);
}

TEST_CASE("The error of a(t) beside the best possible one is given of each configuration apart") {
  const tests::TempDir dir;
  tests::write_sweep(dir.path(), "replicates = 3",
                     tests::kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n");
  std::string second = tests::one_glider(0.0, 2.768, 0.0071, {{"level", 0.2, -1.2, 1.2}});
  second.replace(second.find("name = \"m1\""), 11, "name = \"m2\"");
  base::write_file(dir / "scenario.toml", tests::kSweptScenario + second);
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  for (std::uint64_t run = 0; run < 3; ++run) {  // the first one failed
    validate::RunRecord record{run, 0, run, validate::seed_of(sweep, run), {50.0}, run == 0, "first", {}, {}};
    for (const std::string clip : {"up", "level"}) {
      for (const std::string estimator : {"phase-diagram", "phase-diagram best-possible"}) {
        const double factor = estimator == "phase-diagram" ? (clip == "up" ? 2.0 : 5.0) : 1.0;
        if (run > 0) record.clips.push_back({clip, estimator, 60, 60, 0.03, 1e-5, {}, {}, 0.01 * factor});
      }
    }
    for (const char* name : {"m1", "m2"}) {
      if (run > 0) record.quantities.push_back({name, "phase-diagram", "mu", 1.0, 1.0, {}, {}, {}, {}, {}});
    }
    database.add(record, 0.1);
  }
  const validate::SweepSummary summary = validate::summarize(sweep, database.database());
  REQUIRE(summary.configurations.size() == 2);
  for (std::size_t c = 0; c < 2; ++c) {
    const validate::AccelerationError& of = summary.configurations[c].accelerations.front();
    CHECK(of.configuration == (c == 0 ? "m1" : "m2"));
    CHECK(of.clips == 2);
    CHECK(*of.regret == Approx(c == 0 ? 2.0 : 5.0).epsilon(1e-12));
  }
  CHECK(summary.accelerations.front().clips == 4);
  CHECK_FALSE(summary.overall.front().groups.front().statistics.in_stated_sds);  // none is stated
}

TEST_CASE("Errors are also given over their stated standard deviations, with the standard errors of normal ones") {
  // Of either sign in turn, so that their mean is 0; every stated standard deviation is 2.
  Made made([](const std::string&, double, double, std::uint64_t) { return Outcome::answer; });
  const validate::SweepSummary summary = made.summary();
  REQUIRE(summary.overall.size() == 1);
  const validate::ErrorStatistics& of = summary.overall.front().groups.front().statistics;
  const auto count = static_cast<double>(of.answered);
  REQUIRE(of.in_stated_sds);
  CHECK(std::abs(of.in_stated_sds->mean) < 1e-12);
  CHECK(std::abs(of.in_stated_sds->rms - of.rms / 2.0) < 1e-12);
  CHECK(std::abs(of.in_stated_sds->mean_sd - of.rms / 2.0 / std::sqrt(count - 1.0)) < 1e-12);
  CHECK(std::abs(of.in_stated_sds->rms_sd - of.rms / 2.0 / std::sqrt(2.0 * count)) < 1e-12);
}
