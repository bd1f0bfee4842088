/// Regular expressions, compiled once: every source that includes `<regex>` and uses it takes the compiler seconds
/// more.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace glidelab::base {

/// What a match captured: [0] is the whole of it, [i] the i-th group, empty if it took no part.
using Captured = std::vector<std::string>;

/// A regular expression in the grammar of ECMAScript.
class Pattern {
 public:
  explicit Pattern(const std::string& expression);

  /// What each match in the text captured, from left to right; matches do not overlap.
  std::vector<Captured> matches(const std::string& text) const;

  /// The text with every match replaced.
  std::string replaced(const std::string& text, const std::function<std::string(const Captured&)>& by) const;

 private:
  struct Compiled;
  std::shared_ptr<const Compiled> compiled_;
};

}  // namespace glidelab::base
