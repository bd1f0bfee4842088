#include "base/text/pattern.h"

#include <iterator>
#include <regex>

namespace glidelab::base {

struct Pattern::Compiled {
  std::regex expression;
};

namespace {

Captured captured_by(const std::smatch& match) {
  return Captured(match.begin(), match.end());
}

}  // namespace

Pattern::Pattern(const std::string& expression) : compiled_(new Compiled{std::regex(expression)}) {}

std::vector<Captured> Pattern::matches(const std::string& text) const {
  std::vector<Captured> all;
  for (std::sregex_iterator at(text.begin(), text.end(), compiled_->expression); at != std::sregex_iterator(); ++at) {
    all.push_back(captured_by(*at));
  }
  return all;
}

std::string Pattern::replaced(const std::string& text, const std::function<std::string(const Captured&)>& by) const {
  std::string result;
  auto rest = text.begin();
  for (std::sregex_iterator at(text.begin(), text.end(), compiled_->expression); at != std::sregex_iterator(); ++at) {
    result.append(rest, (*at)[0].first).append(by(captured_by(*at)));
    rest = (*at)[0].second;
  }
  return result.append(rest, text.end());
}

}  // namespace glidelab::base
