/// Tables of numbers as other programs export them: Tracker, Logger Pro and Vernier Graphical Analysis, PASCO Capstone,
/// phyphox, spreadsheets.
///
/// These forms are understood, whatever the file's name: tab, semicolon, comma or blanks between fields; decimal point
/// or decimal comma; quoted fields; LF or CRLF, a byte-order mark; titles and comments ('#') before the header, or a
/// header after a '#'; one to three header lines (a padded line of runs, or of bodies that several columns belong to;
/// names, short names, units); channels as "Position, Ch 1 (m)"; units as "Time (s)", "x [cm]", "x_mm", "x / cm", "x in
/// cm" or in a line of their own; runs as "Run 1: Time (s)", "Time (s) Run #1" or in a line of their own; columns of
/// different lengths; runs one below the other, told apart by a column of whole numbers, with times that begin anew
/// ("Run,Time,Position"), which become columns as of runs side by side, each value in its row; NaN for no value; the
/// Unicode minus sign (U+2212); blanks between thousands. A decimal comma goes with a comma between fields if each
/// number that has one is in quotes. The delimiter and the decimal sign are chosen so that most lines consist only of
/// numbers, or have numbers in the same columns. Text in other columns, as labels and remarks are, is no value. Times
/// of day ("14:03:07.25", also after a date) are seconds from the first row where no other column is named as one of
/// times, and no values elsewhere.
/// The parts of a body that DeepLabCut ("bodyparts", "coords") and SLEAP ("thorax.x") follow are runs, in pixels.
/// Brackets around digits belong to the name: "cal[0]".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "core/track/column_header.h"

namespace glidelab::core {

/// `name` is the file, for messages. InputError as below.
ColumnTable table_of_text(std::string_view text, const std::string& name);

/// A workbook of Excel (workbook.h), or text. The text may be UTF-8, UTF-16 or Latin-1 (text_encoding.h). InputError if
/// the file does not have two columns of numbers, or is no text (a spreadsheet's own format, JSON). Text between the
/// numbers of a column is an issue for whoever uses that column.
ColumnTable read_column_table(const std::filesystem::path& file);

/// An InputError about the columns of a table.
base::InputError wrong_column(const ColumnTable& table, const std::string& found, const std::string& expected);

}  // namespace glidelab::core
