/// The texts of the pages for class in each language, one file each (teach/page/languages/CODE.json): keys, and texts
/// in which {name} stands for a number or a name.
///
/// A page holds all of them. It is written in English, and its script (languages/language.js) replaces the texts by
/// those of the chosen language; quantities, units and names from files stay.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::teach {

/// "en" first, then the others sorted by code.
std::vector<std::string> language_codes();

/// All texts of a language by their keys. std::out_of_range if there is no such language.
const std::map<std::string, std::string>& texts_of(const std::string& language);

using WordValues = std::map<std::string, std::string>;

/// The text of that key with its values inserted. std::out_of_range if there is no such key or value.
std::string text_in(const std::string& language, const std::string& key, const WordValues& values = {});

/// HTML: a span with the English text, which the page's script translates into the chosen language. Values are text.
std::string words(const std::string& key, const WordValues& values = {});

/// The key of this English text among the keys that begin with `begin` ("law"); "" if there is none, as for a user's
/// own text.
std::string key_of(std::string_view english, std::string_view begin);

/// Script: LANGUAGES, `language`, and the code that puts texts into a page.
std::string language_script(const std::string& language);

}  // namespace glidelab::teach
