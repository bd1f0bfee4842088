#include "python/binding/given_estimator.h"

#include <cstdint>
#include <utility>

namespace glidelab::python {

namespace py = pybind11;

namespace {

constexpr double kMegabyte = 1048576.0;  // bytes

}  // namespace

std::optional<fit::OutsideEstimator> outside_of(const std::optional<GivenEstimator>& given,
                                                const WatchedWork& watched) {
  if (!given) return std::nullopt;
  fit::OutsideEstimator made = fit::outside_estimator(given->command, given->name);
  made.function = given->function;
  made.limits.wall_s = given->seconds;
  made.limits.memory_bytes = static_cast<std::uint64_t>(given->megabytes * kMegabyte);
  made.stop = [&watched] { return watched.stopped(); };
  return made;
}

void bind_given_estimator(py::module_& module) {
  py::class_<GivenEstimator>(module, "EstimatorCommand")
      .def(py::init([](std::string command, std::string name, std::string function, double seconds, double megabytes) {
        return GivenEstimator{std::move(command), std::move(name), std::move(function), seconds, megabytes};
      }));
}

}  // namespace glidelab::python
