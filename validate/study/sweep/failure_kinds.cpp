#include "validate/study/sweep/failure_kinds.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <functional>

#include "base/text/number_text.h"

namespace glidelab::validate {
namespace {

constexpr int kAsTheyAre = 6;  // significant digits that a person still reads
constexpr int kShownDigits = 4;

bool is_digit(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

std::size_t behind_digits(std::string_view text, std::size_t at) {
  while (is_digit(text, at)) ++at;
  return at;
}

/// Behind the number that begins with a digit at `from`.
std::size_t behind_number(std::string_view text, std::size_t from) {
  std::size_t at = behind_digits(text, from);
  if (at < text.size() && text[at] == '.' && is_digit(text, at + 1)) at = behind_digits(text, at + 1);
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const bool sign = at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+');
    const std::size_t power = at + (sign ? 2 : 1);
    if (is_digit(text, power)) at = behind_digits(text, power);
  }
  return at;
}

/// The text with each number as `written` has it.
std::string rewritten(std::string_view text, const std::function<std::string(std::string_view)>& written) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const bool minus = text[at] == '-' && is_digit(text, at + 1) &&
                       (at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0);
    if (!minus && !is_digit(text, at)) {
      result += text[at++];
      continue;
    }
    const std::size_t end = behind_number(text, at + (minus ? 1 : 0));
    result += written(text.substr(at, end - at));
    at = end;
  }
  return result;
}

/// Digits before a power of ten, without the zeros in front.
int significant_digits(std::string_view number) {
  int digits = 0;
  for (const char c : number.substr(0, number.find_first_of("eE"))) {
    if (c >= '0' && c <= '9' && (digits > 0 || c != '0')) ++digits;
  }
  return digits;
}

}  // namespace

void FailureKinds::add(const std::string& why) {
  FailureKind& kind = kinds_[without_numbers(why)];
  if (kind.runs == 0) kind.example = why;
  kind.one_text = kind.one_text && kind.example == why;
  ++kind.runs;
}

std::vector<FailureKind> FailureKinds::by_number() const {
  std::vector<FailureKind> kinds;
  for (const auto& [text, kind] : kinds_) kinds.push_back(kind);
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const FailureKind& a, const FailureKind& b) { return a.runs > b.runs; });
  return kinds;
}

std::string without_numbers(std::string_view text) {
  return rewritten(text, [](std::string_view) { return std::string("#"); });
}

std::string with_rounded_numbers(std::string_view text) {
  return rewritten(text, [](std::string_view number) {
    const bool whole = number.find_first_of(".eE") == std::string_view::npos;
    if (whole || significant_digits(number) <= kAsTheyAre) return std::string(number);
    return base::number_text(std::strtod(std::string(number).c_str(), nullptr), kShownDigits);
  });
}

}  // namespace glidelab::validate
