/// The minus sign of whatever a person reads on a page: U+2212 everywhere, as the plots have it.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::report {

/// The document with U+2212 for each hyphen that begins a number ("-0.3", "(-5", "± -2"): one before a digit, with
/// neither a letter of any alphabet, a digit, another hyphen, nor one of "_", "." and "]" before it, so that "m1-2",
/// "maß-2", "1e-07" and "2026-11-23" stay. Tags, style,
/// scripts and code elements (what one types or finds in a file) stay as they are.
std::string with_minus_signs(std::string_view html);

}  // namespace glidelab::report
