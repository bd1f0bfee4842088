/// render: the frames of a scenario's clips one after another, in memory; or the whole experiment folder.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/watched_work.h"
#include "render/film/clip_renderer.h"
#include "render/film/render_experiment.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;
using Seed = std::optional<std::uint64_t>;

/// A scenario as seen by the camera.
struct Film {
  std::shared_ptr<const render::ClipSet> clips;
  std::uint64_t seed = 1;
};

Film set_up(const GivenScenario& given, Seed seed, int jobs, const py::object& told) {
  return WatchedWork(told).run([&](const base::Progress& progress) {
    const render::Scenario scenario = read_scenario(given);
    std::atomic<std::size_t> drawn = 0;
    const auto count = static_cast<double>(render::count_set_ups(scenario));
    return Film{std::make_shared<const render::ClipSet>(
                    scenario, jobs, [&] { progress("rendering", static_cast<double>(++drawn) / count); }),
                seed.value_or(scenario.seed)};
  });
}

/// The frames of one clip. Holds one image.
class FrameIterator {
 public:
  FrameIterator(const Film& film, std::size_t clip)
      : scenario_(film.clips->scenario()), stream_(film.clips, clip, film.seed) {}

  /// (pixels, t_s, stamp_s, slot, repeated, x_m, v_m_s), or None at the end.
  py::object next() { return scenario_.sensor.bit_depth > 8 ? frame<std::uint16_t>() : frame<std::uint8_t>(); }

 private:
  template <typename Code>
  py::object frame() {
    const render::PixelRect all{0, 0, scenario_.camera.width_px, scenario_.camera.height_px};
    std::optional<render::ClipStream::Next> next;
    {
      const py::gil_scoped_release without_lock;
      next = stream_.next();
    }
    if (!next) return py::none();
    py::array_t<Code> pixels({all.height, all.width});
    const std::span<Code> codes(pixels.mutable_data(), static_cast<std::size_t>(pixels.size()));
    {
      const py::gil_scoped_release without_lock;
      stream_.read(*next->shown, all, codes);  // for a repeated frame the same codes again
    }
    const sim::State& state = next->shown->middle;
    return py::make_tuple(std::move(pixels), state.t_s, next->stamp_s, next->slot, next->repeated, state.x_m,
                          state.v_m_s);
  }

  render::Scenario scenario_;
  render::ClipStream stream_;
};

/// (name, configuration, frames) of each clip.
py::list clips_of(const Film& film) {
  py::list list;
  for (std::size_t clip = 0; clip < film.clips->size(); ++clip) {
    list.append(py::make_tuple(film.clips->motion(clip).name, film.clips->configuration(clip).name,
                               film.clips->frames(clip, film.seed)));
  }
  return list;
}

void check_empty(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder) || (fs::is_directory(folder, error) && fs::is_empty(folder))) return;
  throw base::InputError(base::Issue{folder.string(), 0, "folder", "something that exists already",
                                     "a new folder, or an empty one; nothing was touched"});
}

/// Writes the experiment folder, and the truth in `FOLDER.truth`.
py::tuple render_folder(const GivenScenario& given, const std::string& folder, Seed seed, bool ideal, int jobs,
                        const py::object& told) {
  const fs::path out = fs::absolute(folder).lexically_normal();
  const fs::path truth = out.parent_path() / (out.filename().string() + ".truth");
  const render::RenderSummary summary = WatchedWork(told).run([&](const base::Progress& progress) {
    check_empty(out);
    check_empty(truth);
    const render::Scenario scenario = read_scenario(given);
    base::StagedOutput staged_experiment(out), staged_truth(truth);
    const render::RenderSummary done =
        render::render_experiment(scenario, staged_experiment.dir(), staged_truth.dir(),
                                  {.seed = seed.value_or(scenario.seed), .jobs = jobs, .ideal = ideal}, progress);
    base::list_made_files(staged_truth.dir());
    base::list_made_files(staged_experiment.dir());
    staged_truth.publish_whole();
    staged_experiment.publish_whole();
    return done;
  });
  return py::make_tuple(out.string(), truth.string(), summary.clips, summary.frames);
}

}  // namespace

void bind_film(py::module_& module) {
  py::class_<Film>(module, "Film").def("clips", &clips_of).def("frames", [](const Film& film, std::size_t clip) {
    return std::make_unique<FrameIterator>(film, clip);
  });
  py::class_<FrameIterator>(module, "FrameIterator").def("next", &FrameIterator::next);
  module.def("set_up_film", &set_up);
  module.def("render_folder", &render_folder);
}

}  // namespace glidelab::python
