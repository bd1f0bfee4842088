/// validate, coverage, certify, require and sweep: the functions that use a truth. A sweep continues where it stopped,
/// in the given folder.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/preview.h"
#include "core/experiment/experiment.h"
#include "diagnose/lines/line_model.h"
#include "fit/estimators.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "report/analysis/analysis_report.h"
#include "report/analysis/result_files.h"
#include "report/certificate/certificate_report.h"
#include "report/coverage/coverage_report.h"
#include "report/requirement/requirement_report.h"
#include "report/sweep/sweep_report.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"
#include "report/validation/validation_report.h"
#include "validate/film/run_validation.h"
#include "validate/study/certify/certify.h"
#include "validate/study/coverage/interval_coverage.h"
#include "validate/study/requirement/requirement.h"
#include "validate/study/sweep/design/read_sweep.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_database.h"
#include "validate/study/sweep/sweep_summary.h"
#include "version_of_build.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;
using Seed = std::optional<std::uint64_t>;
using Judged = std::optional<GivenEstimator>;

/// A closed loop with its folders, which are removed with the last reference to it.
struct Validated {
  base::TemporaryFolder folder{"validate"};
  fs::path experiment() const { return folder / "experiment"; }
  fs::path truth() const { return folder / "experiment.truth"; }
  std::string name;
  std::string outside;  ///< name of the outside estimator
  validate::ValidationResult result;
};

void write_validation(const Validated& done, const fs::path& out, const base::Progress& progress) {
  for (const fs::path& from : {done.experiment(), done.truth()}) {
    fs::copy(from, out / from.filename(), fs::copy_options::recursive);
    base::list_made_files(out / from.filename());
  }
  report::write_analysis_files(done.result.results, out);
  for (const fs::directory_entry& entry : fs::directory_iterator(done.truth())) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("trajectory-")) base::write_file(out / name, base::read_file(entry.path()));
  }
  base::write_file(out / "comparison.json", report::comparison_json(done.result.comparison));
  if (!done.result.outside_json.empty()) {
    base::write_file(out / fmt::format("results-{}.json", report::file_name_part(done.outside)),
                     done.result.outside_json);
  }
  const std::vector<core::Preview> previews = core::previews_of({done.experiment()}, done.result.results, progress, {});
  report::write_page(
      out, "report.html",
      report::validation_report(done.name, done.result.results, done.result.comparison, previews, progress));
}

/// The comparison, and the JSON and the text of the analysis.
py::tuple run_validation(const GivenScenario& given, const Judged& judged, Seed seed, int jobs,
                         const py::object& told) {
  WatchedWork watched(told);
  const auto done = watched.run([&](const base::Progress& progress) {
    const render::Scenario scenario = read_scenario(given);
    auto loop = std::make_shared<Validated>();
    fs::create_directory(loop->experiment());
    fs::create_directory(loop->truth());
    loop->name = scenario.motion.name;
    validate::ValidationOptions run;
    run.render = {.seed = seed.value_or(scenario.seed), .jobs = jobs};
    run.analysis.jobs = jobs;
    run.outside = outside_of(judged, watched);
    if (run.outside) loop->outside = run.outside->name;
    loop->result = validate::run_validation(scenario, loop->experiment(), loop->truth(), run, progress);
    return std::shared_ptr<const Validated>(std::move(loop));
  });
  Outcome outcome{
      report::comparison_json(done->result.comparison), report::comparison_text(done->result.comparison),
      [done](const fs::path& out, const base::Progress& progress) { write_validation(*done, out, progress); }};
  return py::make_tuple(std::move(outcome), report::results_json(done->result.results));
}

Outcome measure_coverage(const GivenScenario& given, std::optional<double> noise_m, std::size_t replicates,
                         std::vector<double> levels, std::optional<double> bandwidth_s, const Judged& judged, Seed seed,
                         int jobs, const py::object& told) {
  std::string name;
  WatchedWork watched(told);
  const auto coverage = watched.run([&](const base::Progress& progress) {
    // With a given noise there is no camera, so it need not see the motions.
    const render::Scenario scenario =
        read_scenario(given, noise_m ? render::ScenarioChecks::values : render::ScenarioChecks::all);
    name = scenario.motion.name;
    validate::CoverageOptions wanted;
    wanted.replicates = replicates;
    wanted.noise_sd_m = noise_m;
    wanted.bandwidth_s = bandwidth_s;
    wanted.outside = outside_of(judged, watched);
    if (!levels.empty()) wanted.levels = std::move(levels);
    wanted.seed = seed.value_or(scenario.seed);
    wanted.jobs = jobs;
    return std::make_shared<const validate::Coverage>(validate::measure_coverage(scenario, wanted, progress));
  });
  return {report::coverage_json(*coverage), report::coverage_text(*coverage),
          [coverage, name](const fs::path& out, const base::Progress&) {
            base::write_file(out / "coverage.json", report::coverage_json(*coverage));
            report::write_page(out, "report.html", report::coverage_page(fmt::format("Coverage: {}", name), *coverage));
          }};
}

validate::Confirm confirm_of(const std::string& word, const validate::Sweep& sweep) {
  if (word.empty()) return validate::usual_confirm(sweep);
  if (word == "none") return validate::Confirm::none;
  if (word == "tracks") return validate::Confirm::tracks;
  if (word == "clips") return validate::Confirm::clips;
  throw base::InputError(base::Issue{"", 0, "confirm", fmt::format("\"{}\"", word), "none, tracks or clips"});
}

Outcome find_requirement(const std::string& file, const std::vector<std::string>& targets, const std::string& confirm,
                         std::uint64_t runs, std::uint64_t track_runs, Seed seed, int jobs, const py::object& told) {
  WatchedWork watched(told);
  const auto requirement = watched.run([&](const base::Progress& progress) {
    validate::RequirementOptions how;
    for (const std::string& target : targets) how.targets.push_back(validate::parse_target(target));
    how.runs = runs;
    how.track_runs = track_runs;
    how.jobs = jobs;
    how.watch = [&watched] { watched.throw_if_stopped(); };
    validate::Sweep sweep = validate::read_sweep(file);
    how.confirm = confirm_of(confirm, sweep);
    if (seed) sweep.seed = *seed;
    return std::make_shared<const validate::Requirement>(validate::find_requirement(sweep, how, progress));
  });
  return {report::requirement_json(*requirement), report::requirement_text(*requirement),
          [requirement](const fs::path& out, const base::Progress&) {
            base::write_file(out / "require.json", report::requirement_json(*requirement));
            report::write_page(out, "report.html", report::requirement_report(*requirement));
          }};
}

Outcome run_sweep(const std::string& file, const std::string& folder, const Judged& judged, Seed seed, int jobs,
                  const py::object& told) {
  WatchedWork watched(told);
  const auto summary = watched.run([&](const base::Progress& progress) {
    validate::Sweep sweep = validate::read_sweep(file);
    if (seed) sweep.seed = *seed;
    sweep.outside = outside_of(judged, watched);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) base::throw_system_error(folder, "cannot be made", error.value());
    validate::SweepDatabase database(fs::path(folder) / "sweep.sqlite", sweep, GLIDELAB_VERSION, {}, report::why_words);
    validate::run_sweep(sweep, database, {}, jobs, progress);
    return std::make_shared<const validate::SweepSummary>(validate::summarize(sweep, database.database()));
  });
  return {report::sweep_json(*summary), report::sweep_text(*summary),
          [summary](const fs::path& out, const base::Progress& progress) {
            base::write_file(out / "sweep.json", report::sweep_json(*summary));
            report::write_page(out, "report.html", report::sweep_report(*summary, progress));
          }};
}

Outcome certify(const std::vector<std::string>& inputs, std::size_t twins, const std::string& estimator,
                std::optional<double> bandwidth_s, Seed seed, int jobs, const core::TrackFileOptions& given,
                const py::object& told) {
  const std::vector<fs::path> folders(inputs.begin(), inputs.end());
  const core::TrackFileOptions bare = core::masses_of_files(given, folders);
  std::string title;
  const auto certificate = WatchedWork(told).run([&](const base::Progress& progress) {
    validate::CertifyOptions how;
    how.runs = twins;
    how.estimator = estimator_named(estimator);
    how.bandwidth_s = bandwidth_s;
    how.seed = seed.value_or(how.seed);
    how.jobs = jobs;
    how.bare = bare;
    title = report::title_of(diagnose::read_recording(folders.front(), bare).name, folders.size());
    return std::make_shared<const validate::Certificate>(validate::certify(folders, how, progress));
  });
  return {report::certificate_json(*certificate), report::certificate_text(*certificate),
          [certificate, title](const fs::path& out, const base::Progress&) {
            base::write_file(out / "certify.json", report::certificate_json(*certificate));
            report::write_page(out, "report.html", report::certificate_page(title, *certificate));
          }};
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("validate", &run_validation);
  module.def("coverage", &measure_coverage);
  module.def("require", &find_requirement);
  module.def("sweep", &run_sweep);
  module.def("certify", &certify);
}

}  // namespace glidelab::python
