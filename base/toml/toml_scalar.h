/// A single value of a TOML file: a number, a switch or a text.
#pragma once

#include <string>
#include <variant>

namespace glidelab::base {

using TomlScalar = std::variant<double, bool, std::string>;

}  // namespace glidelab::base
