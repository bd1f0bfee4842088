/// A file's keys as a person reads them, with sizes in the units that people use (base/text/size_text.h).
#pragma once

#include <string>
#include <string_view>

#include "base/text/size_text.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

using base::name_and_unit;
using base::NamedUnit;
using base::size_and_sd_text;
using base::size_text;

/// "line = 30.67 ± 0.34 µs" for the key "line_s"; of a set-up by itself ("x_mid_m.NAME") "x_mid.NAME = …".
std::string parameter_text(std::string_view key, double value, double sd);
/// The same of a fitted one: "codec = libx264" of what is a word, "line: not known: …" of what the data do not tell.
std::string parameter_text(const diagnose::DiagnosedParameter& parameter);

}  // namespace glidelab::report
