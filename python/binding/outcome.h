/// What a function of the module returns to Python besides its arrays: the JSON that the command of the same name
/// writes, the text that it prints, and all of its files on request.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <functional>
#include <string>

#include "base/long_work.h"

namespace glidelab::python {

struct Outcome {
  std::string json;  ///< with a newline at its end
  std::string text;
  /// Writes the command's files into an empty folder.
  std::function<void(const std::filesystem::path& folder, const base::Progress& progress)> write;
};

/// glidelab._glidelab.Outcome: json, text, write(folder, progress). Files appear in the folder whole or not at all.
void bind_outcome(pybind11::module_& module);

}  // namespace glidelab::python
