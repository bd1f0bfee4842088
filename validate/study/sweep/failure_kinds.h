/// Why runs failed, by kind: one cause reads alike in every run but for the numbers in it.
///
/// A number is digits, with a decimal point and a power of ten where these follow, and a minus before it that no word
/// ends at. Two reasons are of one kind where they are the same text once each number is taken out.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::validate {

/// Runs that failed for reasons of one kind.
struct FailureKind {
  std::string example;  ///< the first reason that was added, as it is
  std::uint64_t runs = 0;
  bool one_text = true;  ///< all reasons are the example to the letter
};

class FailureKinds {
 public:
  void add(const std::string& why);

  /// The commonest first; of those with as many runs by their text without numbers.
  std::vector<FailureKind> by_number() const;

 private:
  std::map<std::string, FailureKind> kinds_;
};

/// The text with "#" for each number.
std::string without_numbers(std::string_view text);

/// The text with four significant digits for each number that has more than six and is no whole one:
/// "1.5811388300841898e-05" becomes "0.00001581".
std::string with_rounded_numbers(std::string_view text);

}  // namespace glidelab::validate
