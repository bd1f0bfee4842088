#include "report/analysis/left_out_clips.h"

#include <fmt/format.h>

#include "base/text/readable_text.h"
#include "report/html/html.h"

namespace glidelab::report {

std::vector<std::string> left_out_words(const std::vector<core::LeftOutClip>& clips) {
  if (clips.empty()) return {};
  const std::size_t all = clips.front().of, left = all - clips.size();
  std::vector<std::string> words;
  words.push_back(clips.size() == 1
                      ? fmt::format("1 of {} clips is left out, because its marker is not found. The results are those "
                                    "of the other {}.",
                                    all, left)
                      : fmt::format("{} of {} clips are left out, because their marker is not found. The results are "
                                    "those of the other {}.",
                                    clips.size(), all, left));
  for (const core::LeftOutClip& clip : clips) words.push_back(fmt::format("{}: {}", clip.name, clip.why));
  if (2 * left < all) {
    words.emplace_back(
        "Fewer than half of the clips are left, so that the results need not be those of the experiment. Find out with "
        "glidelab check what keeps the others from being tracked before you use them.");
  }
  return words;
}

std::string left_out_text(const std::vector<core::LeftOutClip>& clips) {
  std::string text;
  for (const std::string& words : left_out_words(clips)) text += base::printable_text(words) + "\n";
  return text.empty() ? text : text + "\n";
}

std::string left_out_html(const std::vector<core::LeftOutClip>& clips) {
  std::string html;
  for (const std::string& words : left_out_words(clips))
    html += fmt::format("<p class=\"note\">{}{}{}</p>\n", html.empty() ? "<b>" : "", escape(words),
                        html.empty() ? "</b>" : "");
  return html;
}

Json left_out_json(const std::vector<core::LeftOutClip>& clips) {
  Json all = Json::array();
  for (const core::LeftOutClip& clip : clips) {
    Json one;
    one["clip"] = clip.name;
    one["experiment"] = clip.experiment;
    one["why"] = clip.why;
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace glidelab::report
