#include "teach/page/page_words.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "base/text/json_text.h"
#include "base/text/pattern.h"
#include "report/html/html.h"
#include "teach/page/page_texts.h"

namespace glidelab::teach {
namespace {

const std::vector<std::pair<std::string, std::string_view>>& files() {
  static const std::vector<std::pair<std::string, std::string_view>> all = {
      {"en", kEnglish}, {"de", kGerman}, {"es", kSpanish}, {"fr", kFrench}, {"pt", kPortuguese}};
  return all;
}

}  // namespace

std::vector<std::string> language_codes() {
  std::vector<std::string> codes;
  for (const auto& [code, json] : files()) codes.push_back(code);
  return codes;
}

const std::map<std::string, std::string>& texts_of(const std::string& language) {
  static const std::map<std::string, std::map<std::string, std::string>> all = [] {
    std::map<std::string, std::map<std::string, std::string>> read;
    for (const auto& [code, json] : files()) {
      read[code] = base::parsed_json(json).get<std::map<std::string, std::string>>();
    }
    return read;
  }();
  return all.at(language);
}

std::string text_in(const std::string& language, const std::string& key, const WordValues& values) {
  static const base::Pattern kPlace("\\{([a-z_0-9]+)\\}");
  return kPlace.replaced(texts_of(language).at(key), [&](const base::Captured& place) { return values.at(place[1]); });
}

std::string words(const std::string& key, const WordValues& values) {
  const std::string numbers =
      values.empty() ? ""
                     : fmt::format(" data-values=\"{}\"",
                                   report::escape(base::json_text(nlohmann::json(values), base::kOnOneLine)));
  return fmt::format("<span data-text=\"{}\"{}>{}</span>", key, numbers,
                     report::symbols_html(text_in("en", key, values)));
}

std::string key_of(std::string_view english, std::string_view begin) {
  for (const auto& [key, text] : texts_of("en")) {
    if (key.starts_with(begin) && text == english) return key;
  }
  return {};
}

std::string language_script(const std::string& language) {
  std::string all;
  for (const auto& [code, json] : files()) all += fmt::format("{}{}:{}", all.empty() ? "" : ",\n", code, json);
  return fmt::format("const LANGUAGES={{{}}};\nlet language='{}';\n{}", all, language, kPageLanguage);
}

}  // namespace glidelab::teach
