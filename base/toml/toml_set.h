/// Sets values in a TOML document at dotted paths, before it is read.
///
///     camera.exposure_s                               a key, made with its table if it is missing
///     configuration[2].mass_kg                        in the second [[configuration]]; [N] counts from 1
///     configuration[*].force[law=viscous].k_over_m_1_s   in all, and in those whose `law` is "viscous"
///     camera.position_m[3]                            an element of an array
///
/// Keys consist of letters, digits, - and _. Unknown keys are found when the document is read (strict_toml.h), not
/// here.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml/strict_toml.h"

namespace glidelab::base {

struct TomlAssignment {
  std::string path;
  std::optional<TomlScalar> value;  ///< empty: the key is removed
};

/// A TOML basic string of UTF-8 text: in quotes, with escapes as needed.
std::string toml_string(std::string_view text);

/// "0.001", "true", "\"global\"": a whole number has no decimal point, so that it also serves as an integer.
std::string toml_text(const TomlScalar& value);

/// The document with the values set, as TOML. InputError, named `shown_as`, if the text is not valid TOML, a path is
/// not of the form above or leads through something that is not a table, or an array has no such element.
std::string with_values(std::string_view toml, const std::string& shown_as,
                        const std::vector<TomlAssignment>& assignments);

/// The places that a value at this path would replace or make, each as a path with numbers: "configuration[2].mass_kg".
/// InputError as of with_values.
std::vector<std::string> reached_by(std::string_view toml, const std::string& shown_as, const std::string& path);

/// A table of a document, and those of its keys that are not taken over.
struct TomlSection {
  std::string name;
  std::vector<std::string> without;
};

/// The document as TOML, with the keys of `others` that its own `sections` lack, and without the root's key
/// `taken_out`. InputError, named as shown, if either document is not valid TOML.
std::string with_missing(std::string_view toml, const std::string& shown_as, std::string_view others,
                         const std::string& others_shown_as, const std::vector<TomlSection>& sections,
                         std::string_view taken_out);

}  // namespace glidelab::base
