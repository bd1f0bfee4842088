#include "report/text/display_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <set>
#include <utility>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "base/text/wrapped_text.h"
#include "diagnose/effects/effect_library.h"
#include "fit/estimators.h"
#include "report/html/html.h"
#include "report/text/why_words.h"
#include "validate/study/coverage/interval_coverage.h"

namespace glidelab::report {

std::string with_unit(std::string_view name, std::string_view unit) {
  std::string text(name);
  if (!unit.empty()) text.append(" (").append(unit).append(")");
  return text;
}

std::string heading_of(std::string_view key) {
  return with_unit(symbol_of(key), unit_of(key));
}

std::string title_of(std::string first, std::size_t count) {
  return count > 1 ? fmt::format("{} and {} more", first, count - 1) : first;
}

std::string unit_suffix(std::string_view unit) {
  std::string text;
  if (!unit.empty() && unit != "°") text += ' ';
  return text.append(unit);
}

std::string estimator_name(std::string_view estimator) {
  if (const fit::Estimator* known = fit::find_estimator(estimator)) return std::string(known->title);
  if (estimator == validate::kNaiveLines) return "naive lines (for contrast)";
  return std::string(estimator);
}

std::string by_estimator(std::string_view estimator) {
  const std::string name = estimator_name(estimator);
  return name == estimator ? fmt::format("with “{}”", name) : fmt::format("with the {}", name);
}

std::array<NamedQuantity, kQuantities.size()> quantities_of(const core::ConfigurationResult& configuration) {
  std::array<NamedQuantity, kQuantities.size()> named;
  for (std::size_t i = 0; i < named.size(); ++i) {
    named[i] = {kQuantities[i], &core::value_of(configuration, kQuantities[i].which)};
  }
  return named;
}

std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration) {
  const auto alike = std::count_if(
      results.configurations.begin(), results.configurations.end(), [&](const core::ConfigurationResult& other) {
        return other.mass_kg == configuration.mass_kg && other.incline_deg == configuration.incline_deg;
      });
  const std::string name = fmt::format("{:.6g} kg, {:.4g}°", configuration.mass_kg, configuration.incline_deg);
  return alike > 1 ? name + ", " + configuration.group : name;
}

std::string file_name_part(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '/' || c == '%' || byte < 0x20 || byte == 0x7f) {
      name += fmt::format("%{:02X}", byte);
    } else {
      name += c;
    }
  }
  if (name.size() <= kLongestNamePart) return name;
  std::size_t end = kLongestNamePart;
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(name[at]) & 0xc0) == 0x80; };
  while (end > 0 && continues(end)) --end;  // UTF-8
  return name.substr(0, end);
}

std::vector<std::string> phase_file_names(const core::AnalysisResults& results) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const core::ClipResult& clip : results.clips) {
    const auto same = std::count_if(results.clips.begin(), results.clips.end(),
                                    [&](const core::ClipResult& other) { return other.name == clip.name; });
    const std::string stem = same == 1
                                 ? file_name_part(clip.name)
                                 : fmt::format("{}-{}", file_name_part(clip.experiment), file_name_part(clip.name));
    std::string name = fmt::format("phase-{}.csv", stem);
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("phase-{}-{}.csv", stem, n);
    names.push_back(std::move(name));
  }
  return names;
}

std::string effect_name(std::string_view id) {
  if (id == "none") return "nothing is missing";
  if (id == "unknown") return "an unnamed cause";
  if (const diagnose::EffectInfo* const effect = diagnose::find_effect(id)) return std::string(effect->name);
  return std::string(id);
}

std::vector<std::string> effect_names(const std::vector<std::string>& ids) {
  std::vector<std::string> names;
  for (const std::string& id : ids) names.push_back(effect_name(id));
  return names;
}

std::string effect_meaning(std::string_view id) {
  if (const diagnose::EffectInfo* const effect = diagnose::find_effect(id)) return std::string(effect->meaning);
  return {};
}

std::string effect_html(std::string_view id) {
  const std::string name = effect_name(id);
  if (name == id) return escape(id);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(id));
}

std::string parameter_text(std::string_view key, double value, double sd) {
  const std::string_view member = key.substr(std::min(key.find('.'), key.size()));
  const NamedUnit of = name_and_unit(key.substr(0, key.size() - member.size()));
  return fmt::format("{}{} = {}", of.name, member, size_and_sd_text(value, sd, of.unit));
}

namespace {

/// Whether a standard deviation is larger than what the parameter may be: then the data say nothing about it.
bool is_open(const diagnose::DiagnosedParameter& parameter) {
  constexpr double kBeyondAny = 10.0;  // m, s or Hz: of a place, a time or a frequency, whose range is that of the
                                       // data; and the least for a size that may grow with the mass
  double widest = 0.0;
  for (const diagnose::EffectInfo& effect : diagnose::effect_list()) {
    for (const diagnose::EffectParameter& of : effect.parameters) {
      if (of.key != parameter.key) continue;
      const bool as_stated = of.reach == diagnose::Reach::stated;
      if (as_stated || of.reach == diagnose::Reach::with_mass) widest = std::max(widest, of.high - of.low);
      if (!as_stated) widest = std::max(widest, kBeyondAny);
    }
  }
  return widest > 0.0 && parameter.sd > widest;
}

}  // namespace

std::string parameter_text(const diagnose::DiagnosedParameter& parameter) {
  if (!parameter.text.empty()) return fmt::format("{} = {}", parameter.key, parameter.text);
  if (parameter.why) return fmt::format("{} is not determined: {}", parameter.key, why_words(parameter.why));
  if (is_open(parameter)) {
    const std::string named = parameter_text(parameter.key, parameter.value, parameter.sd);
    return named.substr(0, named.find(" = ")) + " not determined";
  }
  const std::string text = parameter_text(parameter.key, parameter.value, parameter.sd);
  return parameter.at_end ? text + " (at the end of the range that is searched)" : text;
}

std::string interval_text(const std::optional<diagnose::GapInterval>& interval) {
  if (!interval) return "–";
  return fmt::format("{} to {}", base::digits_text(interval->low, 3), base::digits_text(interval->high, 3));
}

std::string shrink_text(const diagnose::GapSizes& gap) {
  if (!gap.shrink) return "";
  const bool grows = *gap.shrink < 0.0;
  const double percent = grows ? -100.0 : 100.0;
  constexpr double kNearlyAll = 0.999;  // rounded it would be all
  if (gap.interval95.shrink ? gap.interval95.shrink->low > kNearlyAll : *gap.shrink > kNearlyAll) {
    return "shrinks by over 99.9 %";
  }
  std::string text = fmt::format("{} by {:.1f} %", grows ? "grows" : "shrinks", percent * *gap.shrink);
  if (const auto& of = gap.interval95.shrink) {
    text += fmt::format(" ({:.1f} to {:.1f} %)", percent * (grows ? of->high : of->low),
                        percent * (grows ? of->low : of->high));
  }
  return text;
}

std::string list_of(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
  }
  return text;
}

std::string without_code_marks(std::string text) {
  std::erase(text, '`');
  return text;
}

namespace {

using Rows = std::vector<std::vector<std::string>>;
constexpr std::size_t kColumnGap = 2;  // spaces between two columns

std::vector<std::size_t> widths_of(const Rows& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], base::characters_in(row[i]));
  }
  return widths;
}

std::size_t whole_width(const std::vector<std::size_t>& widths) {
  return std::accumulate(widths.begin(), widths.end(), std::size_t{0}) +
         kColumnGap * (std::max<std::size_t>(widths.size(), 1) - 1);
}

/// The rows with these columns alone.
std::string table_of(const Rows& rows, const std::vector<std::size_t>& columns, std::size_t first_number) {
  const std::vector<std::size_t> widths = widths_of(rows);
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (const std::size_t i : columns) {
      if (i >= row.size()) continue;
      const std::string padding(widths[i] - base::characters_in(row[i]), ' ');
      if (i != columns.front()) line += std::string(kColumnGap, ' ');
      line += i >= first_number ? padding + row[i] : row[i] + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

/// The head in two lines, "K/m" above "(1/s)", where that makes a column narrower; other heads are on the lower line.
Rows with_units_below(const Rows& rows) {
  const std::vector<std::size_t> below_head = widths_of(Rows(rows.begin() + 1, rows.end()));
  Rows all = {std::vector<std::string>(rows.front().size()), rows.front()};
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    const std::string& head = rows.front()[i];
    const std::size_t unit = head.rfind(" (");
    if (unit == std::string::npos || i >= below_head.size() || base::characters_in(head) <= below_head[i]) continue;
    all[0][i] = head.substr(0, unit);
    all[1][i] = head.substr(unit + 1);
  }
  if (all[1] == rows.front()) return rows;
  all.insert(all.end(), rows.begin() + 1, rows.end());
  return all;
}

/// With this column of words wrapped to so many characters; the other cells of a row are on its first line.
Rows with_wrapped(const Rows& rows, std::size_t column, std::size_t width) {
  Rows all;
  for (const auto& row : rows) {
    all.push_back(row);
    if (column >= row.size()) continue;
    std::string rest = base::wrapped(row[column], width);
    while (true) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      all.back()[column] = rest.substr(0, end);
      if (end == rest.size()) break;
      rest.erase(0, end + 1);
      all.emplace_back(row.size());
    }
  }
  return all;
}

/// In parts that fit, each with the columns before the first number.
std::string table_in_parts(const Rows& rows, std::size_t first_number) {
  const std::vector<std::size_t> widths = widths_of(rows);
  std::size_t names = 0;
  for (std::size_t i = 0; i < first_number; ++i) names += widths[i] + kColumnGap;
  std::string text;
  for (std::size_t next = first_number; next < widths.size();) {
    std::vector<std::size_t> part(first_number);
    std::iota(part.begin(), part.end(), std::size_t{0});
    std::size_t used = names;
    do {
      part.push_back(next);
      used += widths[next] + kColumnGap;
      ++next;
    } while (next < widths.size() && used + widths[next] <= base::kTerminalWidth);
    text += (text.empty() ? "" : "\n") + table_of(rows, part, first_number);
  }
  return text;
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& unsafe, std::size_t first_number) {
  constexpr std::size_t kLeastWords = 28;  // characters to which a column of words may be wrapped
  Rows rows = unsafe;
  for (auto& row : rows) {
    for (std::string& cell : row) cell = base::printable_text(cell);
  }
  std::vector<std::size_t> columns(widths_of(rows).size());
  std::iota(columns.begin(), columns.end(), std::size_t{0});
  const auto width = [&] { return whole_width(widths_of(rows)); };
  if (rows.empty() || width() <= base::kTerminalWidth) return table_of(rows, columns, first_number);
  rows = with_units_below(rows);
  const bool only_words = first_number >= columns.size();
  if (width() > base::kTerminalWidth && (only_words || first_number == 1)) {
    const std::size_t words = only_words ? columns.size() - 1 : 0;
    const std::size_t others = width() - widths_of(rows)[words];
    rows =
        with_wrapped(rows, words, std::max(kLeastWords, base::kTerminalWidth - std::min(others, base::kTerminalWidth)));
  }
  if (width() <= base::kTerminalWidth || only_words) return table_of(rows, columns, first_number);
  return table_in_parts(rows, first_number);
}

}  // namespace glidelab::report
