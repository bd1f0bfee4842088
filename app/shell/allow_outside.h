/// --allow-outside, of the commands that read experiment folders.
#pragma once

#include <CLI/App.hpp>

#include "core/experiment/folder_files.h"

namespace glidelab::app {

inline void add_allow_outside(CLI::App& command, core::OutsideFiles& outside) {
  command.add_flag_callback(
      "--allow-outside", [&outside] { outside = core::OutsideFiles::allowed; },
      "Follow absolute names and `..` in experiment.toml to files outside the folder");
}

}  // namespace glidelab::app
