#include "core/motion/smoothing/smoother_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.h"
#include "base/text/nearest_word.h"
#include "core/motion/smoothing/cubic_smoother.h"
#include "core/motion/smoothing/wiener_smoother.h"

namespace glidelab::core {

const std::vector<const Smoother*>& smoothers() {
  static const std::vector<const Smoother*> all{&cubic_smoother(), &kalman_smoother(), &spline_smoother()};
  return all;
}

std::vector<std::string> smoother_names() {
  std::vector<std::string> names;
  for (const Smoother* smoother : smoothers()) names.emplace_back(smoother->name());
  return names;
}

const Smoother* find_smoother(std::string_view name) {
  for (const Smoother* smoother : smoothers()) {
    if (smoother->name() == name) return smoother;
  }
  return nullptr;
}

void check_smoother(const std::string& name, bool bandwidth_asked_for) {
  const Smoother* smoother = find_smoother(name);
  if (smoother == nullptr) {
    const std::vector<std::string> names = smoother_names();
    throw base::InputError(
        base::Issue{"", 0, "smoother", fmt::format("\"{}\"", name),
                    fmt::format("one of {}{}", fmt::join(names, ", "), base::did_you_mean(name, names))});
  }
  if (bandwidth_asked_for && !smoother->takes_bandwidth()) {
    throw base::InputError(
        base::Issue{"", 0, "smoother", fmt::format("\"{}\" and a bandwidth", name),
                    fmt::format("one of them: only \"{}\" has a bandwidth, and this smoother finds its own strength",
                                kLocalPolynomial)});
  }
}

}  // namespace glidelab::core
