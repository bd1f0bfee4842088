/// analyze: for folders and files as in the command, and for tracks given as arrays.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "base/text/number_text.h"
#include "core/analysis/analyze.h"
#include "core/analysis/preview.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/configurations.h"
#include "core/motion/smoothing/smoother_list.h"
#include "core/result/quantity.h"
#include "diagnose/verdict/fit_given_causes.h"
#include "fit/estimators.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "report/analysis/analysis_report.h"
#include "report/analysis/result_files.h"
#include "report/diagnosis/given_causes_report.h"
#include "report/text/display_text.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;

/// The choices of an analysis, for any kind of input.
struct AnalysisChoices {
  std::optional<double> bandwidth_s;
  std::string bandwidth_rule;  ///< empty: the default
  std::string estimator;
  bool robust = false;
  int jobs = 1;
  std::string smoother;
  std::vector<std::string> with_effects;
};

constexpr const char* kWithEffects = "with_effects";

/// An analysis, and the fit with causes that were named; empty if none was.
struct Analysed {
  core::AnalysisResults results;
  std::optional<diagnose::GivenCauses> with;
};

using Cameras = std::vector<std::optional<core::CameraSettings>>;

Analysed with_causes(core::AnalysisResults results, const std::vector<core::ClipSetup>& setups, const Cameras& cameras,
                     const AnalysisChoices& choices, const base::Progress& progress) {
  Analysed made{std::move(results), {}};
  if (!choices.with_effects.empty()) {
    made.with = diagnose::fit_given_causes(made.results, setups, cameras, choices.with_effects, kWithEffects, progress);
  }
  return made;
}

const fit::Estimator& estimator_of(const AnalysisChoices& choices) {
  const fit::Estimator& estimator = estimator_named(choices.estimator);
  if (choices.robust && !estimator.takes_robust) {
    throw base::InputError(
        base::Issue{"", 0, "robust", choices.estimator,
                    "the estimator trajectory (the line estimators leave out outliers in any case)"});
  }
  return estimator;
}

std::string rule_of(const AnalysisChoices& choices) {
  return choices.bandwidth_rule == core::kLinesRule ? std::string() : choices.bandwidth_rule;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

py::dict motion_arrays(const core::ClipResult& clip) {
  const auto column = [&](const auto& value) {
    std::vector<double> values;
    values.reserve(clip.motion.size());
    for (const core::MotionPoint& point : clip.motion) values.push_back(value(point));
    return vector_of(values);
  };
  const auto smoothed = [&](double core::MotionPoint::*member) {
    return column([&](const core::MotionPoint& point) { return point.smoothed ? point.*member : kNone; });
  };
  py::dict arrays;
  arrays["t_s"] = column([](const core::MotionPoint& point) { return point.t_s; });
  arrays["measured_x_m"] = column([](const core::MotionPoint& point) { return point.measured_m.value_or(kNone); });
  arrays["x_m"] = smoothed(&core::MotionPoint::x_m);
  arrays["sd_x_m"] = smoothed(&core::MotionPoint::sd_x_m);
  arrays["v_m_s"] = smoothed(&core::MotionPoint::v_m_s);
  arrays["sd_v_m_s"] = smoothed(&core::MotionPoint::sd_v_m_s);
  arrays["a_m_s2"] = smoothed(&core::MotionPoint::a_m_s2);
  arrays["sd_a_m_s2"] = smoothed(&core::MotionPoint::sd_a_m_s2);
  py::list reasons;
  for (const core::MotionPoint& point : clip.motion) reasons.append(core::describe(point.left_out));
  arrays["reason"] = std::move(reasons);
  return arrays;
}

/// The outcome, and the arrays of each clip. `previews` are made together with the page.
py::tuple told(
    Analysed found, std::string title,
    std::function<std::vector<core::Preview>(const core::AnalysisResults&, const base::Progress&)> previews) {
  const auto made = std::make_shared<const Analysed>(std::move(found));
  const report::Json with = made->with ? report::given_causes_json(*made->with) : report::Json(nullptr);
  Outcome outcome;
  outcome.json = report::results_json(made->results, with);
  outcome.text = report::analysis_text(made->results);
  if (made->with) outcome.text += report::given_causes_text(made->results, *made->with);
  outcome.write = [made, with, title = std::move(title), previews = std::move(previews)](
                      const fs::path& folder, const base::Progress& progress) {
    report::write_analysis_files(made->results, folder, with);
    const report::Html section = made->with ? report::given_causes_section(made->results, *made->with) : report::Html{};
    report::write_page(
        folder, "report.html",
        report::analysis_report(title, made->results, previews(made->results, progress), progress, section));
  };
  py::list motions;
  for (const core::ClipResult& clip : made->results.clips) motions.append(motion_arrays(clip));
  return py::make_tuple(std::move(outcome), std::move(motions));
}

py::tuple analyze_files(const std::vector<std::string>& inputs, const AnalysisChoices& choices,
                        const core::TrackFileOptions& given, const py::object& progress_told) {
  const std::vector<fs::path> folders(inputs.begin(), inputs.end());
  const core::TrackFileOptions bare = core::masses_of_files(given, folders);
  const fit::Estimator& estimator = estimator_of(choices);
  diagnose::check_given_causes(choices.with_effects, kWithEffects);
  std::string title;
  Analysed made = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    core::AnalysisOptions how;
    how.bandwidth_s = choices.bandwidth_s;
    how.bandwidth_rule = rule_of(choices);
    how.jobs = choices.jobs;
    how.lines = estimator.lines;
    how.bare = bare;
    how.smoother = choices.smoother;
    how.images = !choices.with_effects.empty();
    core::AnalysisResults of_lines = core::analyze(folders, how, progress);
    title = report::title_of(core::read_tracks(folders.front(), bare).name, folders.size());
    std::vector<core::ClipSetup> setups;
    Cameras cameras;
    for (const fs::path& folder : folders) {
      const core::Experiment experiment = core::read_tracks(folder, bare);
      setups.insert(setups.end(), experiment.clips.begin(), experiment.clips.end());
      cameras.resize(setups.size(), experiment.camera);
    }
    return with_causes(fit::estimate_and_compare(estimator, std::move(of_lines), {.robust = choices.robust}), setups,
                       cameras, choices, progress);
  });
  return told(std::move(made), title, [folders, bare](const auto& of, const base::Progress& progress) {
    return core::previews_of(folders, of, progress, bare);
  });
}

py::tuple analyze_arrays(std::vector<GivenTrack> given, const GivenGravity& given_gravity, const std::string& name,
                         const AnalysisChoices& choices, const py::object& progress_told) {
  const fit::Estimator& estimator = estimator_of(choices);
  core::check_bandwidth(choices.bandwidth_s, rule_of(choices));
  core::MotionOptions how;
  how.bandwidth_s = choices.bandwidth_s;
  how.bandwidth_rule = rule_of(choices);
  how.lines = estimator.lines;
  how.smoother = choices.smoother;
  core::check_smoothing(how);
  const core::Gravity gravity = read_gravity(given_gravity);
  diagnose::check_given_causes(choices.with_effects, kWithEffects);
  Analysed made = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    const GivenTracks tracks = read_tracks(std::move(given));
    core::AnalysisResults of_lines =
        core::analyze_tracks(tracks.setups, tracks.tracks, gravity, how, choices.jobs, progress);
    for (core::ClipResult& clip : of_lines.clips) clip.experiment = name;
    return with_causes(fit::estimate_and_compare(estimator, std::move(of_lines), {.robust = choices.robust}),
                       tracks.setups, Cameras(tracks.setups.size()), choices, progress);
  });
  return told(std::move(made), name, [](const auto&, const auto&) { return std::vector<core::Preview>{}; });
}

}  // namespace

const fit::Estimator& estimator_named(const std::string& name) {
  const fit::Estimator* const estimator = fit::find_estimator(name);
  if (estimator == nullptr) {
    throw base::InputError(base::Issue{"", 0, "estimator", fmt::format("\"{}\"", name),
                                       fmt::format("one of {}{}", fmt::join(fit::estimator_names(), ", "),
                                                   base::did_you_mean(name, fit::estimator_names()))});
  }
  return *estimator;
}

void bind_analysis(py::module_& module) {
  py::class_<AnalysisChoices>(module, "AnalysisChoices")
      .def(py::init([](std::optional<double> bandwidth_s, std::string rule, std::string estimator, bool robust,
                       int jobs, std::string smoother, std::vector<std::string> with_effects) {
        return AnalysisChoices{bandwidth_s, std::move(rule),     std::move(estimator),   robust,
                               jobs,        std::move(smoother), std::move(with_effects)};
      }));
  module.def("analyze_files", &analyze_files);
  module.def("analyze_arrays", &analyze_arrays);
  module.def("bandwidth_choices", &core::bandwidth_choices);
  module.def("smoother_names", &core::smoother_names);
  module.def("estimator_names", &fit::estimator_names);
  module.def("did_you_mean", [](const std::string& word, const std::vector<std::string>& known) {
    return base::did_you_mean(word, known);
  });
  module.def("unit_of_key", [](const std::string& key) { return base::name_and_unit(key).unit; });
  module.def("quantities", [] {
    std::vector<std::pair<std::string, std::string>> keys_and_units;
    for (const core::QuantityName& one : core::kQuantities) keys_and_units.emplace_back(one.key, one.unit);
    return keys_and_units;
  });
}

}  // namespace glidelab::python
