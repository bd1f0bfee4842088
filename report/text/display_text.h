/// Text for readers: the names of the recovered quantities (core/result/quantity.h), the estimators (fit/estimators.h),
/// the configurations and files of a result, and the effects; a file's keys with sizes in customary units
/// (base/text/number_text.h); intervals of a gap; and tables for a terminal.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "core/result/quantity.h"
#include "core/result/results.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

using core::kQuantities;
using core::place_of;
using core::QuantityName;
using core::symbol_of;
using core::unit_of;

/// "v (m/s)"; only the name for a pure number.
std::string with_unit(std::string_view name, std::string_view unit);

/// "K/m (1/s)" for "k_over_m_1_s": a quantity at the head of a row or a column.
std::string heading_of(std::string_view key);

/// The subject of a page of `count` recordings: the first one's name, "my glider and 2 more".
std::string title_of(std::string first, std::size_t count);

/// A unit after a number: " 1/s", "°", and nothing for a pure number.
std::string unit_suffix(std::string_view unit);

/// "fit of the whole motion" for "trajectory"; any other name stays as it is.
std::string estimator_name(std::string_view estimator);
/// "with the fit of the whole motion"; "with “mine”" for an outside estimator.
std::string by_estimator(std::string_view estimator);

/// A recovered quantity with its names.
struct NamedQuantity {
  QuantityName name;
  const core::Quantity* quantity = nullptr;  ///< in the given configuration
};

/// K/m, µ, α and the terminal velocity of a configuration, in the order of kQuantities.
std::array<NamedQuantity, kQuantities.size()> quantities_of(const core::ConfigurationResult& configuration);

/// "0.335 kg, 4°", with the group added if another of the results has the same mass and stated inclination: "0.5 kg,
/// 2°, plunger". Text from a file: to be escaped.
std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration);

inline constexpr std::size_t kLongestNamePart = 100;  ///< bytes; a file's name of two parts stays below 255

/// The text with '/', '%' and control characters written as %XX, so that it names one file of a folder. A clip's name
/// is any text of any length; a file's name is not. A name of more than kLongestNamePart bytes is cut between two
/// characters.
std::string file_name_part(std::string_view text);

/// `phase-<clip>.csv` for each clip of the results; if clips of two folders have the same name, the folder's name
/// precedes it (and a number follows it if that is also the same).
std::vector<std::string> phase_file_names(const core::AnalysisResults& results);

/// The name of an effect on pages, in contrast to the id in files and options; it is given by the effect's own file
/// (diagnose/effects/): "quadratic drag" for "quadratic_drag"; "none" and "unknown" are also put into words. A text
/// that is not the id of an effect (a cause without a name, already in words) stays as it is.
std::string effect_name(std::string_view id);

/// The meaning of the letters in the effect's size: "a force −c v |v|"; empty if its size is a word, or if an id is not
/// that of an effect.
std::string effect_meaning(std::string_view id);

/// effect_name() of each.
std::vector<std::string> effect_names(const std::vector<std::string>& ids);

/// The name, with the id in small type next to it if they differ. HTML.
std::string effect_html(std::string_view id);

using base::name_and_unit;
using base::NamedUnit;
using base::size_and_sd_text;
using base::size_text;

/// "line = 30.67 ± 0.34 µs" for the key "line_s"; for a single set-up ("x_mid_m.NAME") "x_mid.NAME = …".
std::string parameter_text(std::string_view key, double value, double sd);
/// A fitted one: "codec = libx264" for a word, "line: not known: …", "line not determined" if sd exceeds
/// the range that is searched.
std::string parameter_text(const diagnose::DiagnosedParameter& parameter);

/// "22.1 to 28"; "–" if there is none.
std::string interval_text(const std::optional<diagnose::GapInterval>& interval);

/// The fraction of the gap above the noise floor that disappears or is added: "shrinks by 96.9 % (95.8 to 98.0 %)",
/// "grows by 12.0 %"; "" if the gap is at the noise floor.
std::string shrink_text(const diagnose::GapSizes& gap);

/// "a, b and c", or with another last word: "a, b, or c".
std::string list_of(const std::vector<std::string>& words, const std::string& last = " and ");

/// Without the backticks around commands, which a page turns into code: for a terminal.
std::string without_code_marks(std::string text);

/// Columns aligned below their headers, two spaces apart; columns from `first_number` on are flush right. Widths count
/// characters, not bytes. base::printable_text() is applied to every cell: a clip's name must not steer the terminal.
///
/// A table that is wider than base::kTerminalWidth first gets units on a second line of its head. If that is not
/// enough, a last or only column of words is wrapped, and a table of numbers that is still too wide is printed in parts
/// one below the other, each with the columns before `first_number` (as R prints a data frame).
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t first_number);

}  // namespace glidelab::report
