/// blind: experiments whose cause is withheld, diagnosed and scored.
///
/// As in the command, each case is diagnosed by another process, which knows the folder and nothing else: the
/// interpreter, started again with glidelab/_apart.py.
#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "report/blind/blind_report.h"
#include "validate/blind/run_blind.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;

/// Runs a program (the first of `words`) with these arguments; returns "", or how it failed and what it said.
std::string apart(std::vector<std::string> words, const std::vector<std::string>& arguments, const fs::path& log,
                  const WatchedWork& watched) {
  const std::string program = words.front();
  words.erase(words.begin());
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int status = base::run_program(program, words, log, {}, {}, [&watched] { return watched.stopped(); });
  watched.throw_if_stopped();
  const std::string how = base::how_it_failed(status);
  const std::string said = base::read_file(log);
  fs::remove(log);
  return how.empty() ? "" : fmt::format("{}: {}", how, said);
}

/// `python` is the interpreter with its own arguments.
Outcome run_blind(const std::vector<std::string>& python, const std::string& folder, std::size_t cases,
                  std::uint64_t seed, const std::string& only, bool everyday, bool pictures, bool leave_out,
                  const std::optional<GivenEstimator>& judged, int jobs, const py::object& told) {
  WatchedWork watched(told);
  const auto run = watched.run([&](const base::Progress& progress) {
    validate::BlindOptions wanted;
    wanted.seed = seed;
    wanted.cases = cases;
    wanted.only = only;
    wanted.everyday = everyday;
    wanted.images = pictures;
    wanted.leave_out = leave_out;
    wanted.jobs = jobs;
    wanted.outside = outside_of(judged, watched);
    auto made = std::make_shared<report::BlindRun>();
    made->seed = seed;
    made->images = pictures;
    made->outcomes = validate::run_blind(
        wanted, fs::absolute(folder).lexically_normal(),
        [&](const fs::path& experiment, const fs::path& out, const std::vector<std::string>& without) {
          std::vector<std::string> words = {"diagnose", experiment.string(), out.string()};
          words.insert(words.end(), without.begin(), without.end());
          return apart(python, words, out / "log.txt", watched);
        },
        progress,
        [&](const fs::path& scenario, const fs::path& out) {
          return apart(python, {"render", scenario.string(), out.string()}, out.parent_path() / "log.txt", watched);
        });
    if (wanted.outside) made->outside = validate::tally_of(*wanted.outside, made->outcomes);
    if (everyday) {
      made->everyday = validate::score_everyday(made->outcomes);
    } else {
      made->score = validate::score_blind(made->outcomes);
    }
    return std::shared_ptr<const report::BlindRun>(std::move(made));
  });
  return {report::blind_json(*run), report::blind_text(*run), [run](const fs::path& out, const base::Progress&) {
            base::write_file(out / "blind.json", report::blind_json(*run));
            report::write_page(out, "report.html", report::blind_page(*run));
          }};
}

}  // namespace

void bind_blind(py::module_& module) {
  module.def("blind", &run_blind);
}

}  // namespace glidelab::python
