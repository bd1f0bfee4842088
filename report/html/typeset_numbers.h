/// Typesetting of the numbers on a page: a minus sign in place of a hyphen, and no line that begins with a unit.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::report {

/// HTML in which a hyphen before a number is a minus sign (U+2212), and a number keeps to its unit and to its ± by
/// no-break spaces (U+00A0). Not touched: tags, what stands in code, script and style elements, and a hyphen right
/// behind a letter of any alphabet, a digit, another hyphen, "_", "." or "]" ("m1-2", "maß-2", "1e-07", "2026-11-23").
/// A unit is one that pages use.
std::string typeset_numbers(std::string_view html);

}  // namespace glidelab::report
