#include "report/analysis/row_words.h"

#include <fmt/format.h>

namespace glidelab::report {

std::string row_words(const core::RowsIncomplete& of) {
  if (of.rows == 1) return "one row within the table lacks a time or x and is left out";
  return fmt::format("{} rows within the table lack a time or x and are left out", of.rows);
}

std::string row_words(const core::TimesRepeated& of) {
  if (of.rows == 1) {
    return fmt::format("one row repeats the time of the row above, {:.6g} s, and is left out", of.first_s);
  }
  return fmt::format("{} rows repeat the time of the row above, the first at {:.6g} s, and are left out", of.rows,
                     of.first_s);
}

std::string row_words(const core::ValuesHeld& of) {
  return fmt::format(
      "{} of {} rows repeat the position of the row above while the body moves on, and are left out: the sensor gives "
      "a new value only every {} rows or so",
      of.held, of.rows, of.usual);
}

std::string row_words(const core::UnlikelyLeftOut& of) {
  return fmt::format(
      "{} row{} with a \"{}\" below {:.3g} {} left out: the program that followed the body was not sure of it", of.rows,
      of.rows == 1 ? "" : "s", of.column, of.least, of.rows == 1 ? "is" : "are");
}

}  // namespace glidelab::report
