#include "report/certificate/certificate_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "core/result/quantity.h"
#include "report/certificate/certificate_words.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

using validate::Certificate;
using validate::CertifiedQuantity;
using validate::ChangedTwin;

constexpr double kSure = 2.5;  // standard deviations of a mean, for the largest of three: 4 % by chance
constexpr std::size_t kMostChanges = 3;
constexpr double kWorthDoing = 0.1;  // by which a change must reduce the errors to be advised

std::string share_text(const validate::RunShare& share) {
  return share.of == 0 ? "–" : percent_text(share.share, share.low, share.high);
}

bool is_headline(const CertifiedQuantity& quantity) {
  return quantity.quantity != core::key_of(core::Measurand::v_lim) && quantity.answered() > 0;
}

/// "K/m, µ and α": the quantities that were counted.
std::string headline_names(const Certificate& certificate) {
  std::vector<std::string> names;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (is_headline(quantity)) names.push_back(symbol_of(quantity.quantity));
  }
  return list_of(names);
}

double sureness(const CertifiedQuantity& quantity) {
  return std::abs(quantity.bias_sds.value) / quantity.bias_sds.sd;
}

/// The largest bias that exceeds chance: "µ is off by 0.3 standard deviations on average".
std::string bias_words(const Certificate& certificate) {
  const CertifiedQuantity* worst = nullptr;
  bool any = false;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (!is_headline(quantity)) continue;
    any = true;
    if (sureness(quantity) < kSure) continue;
    if (worst == nullptr || std::abs(quantity.bias_sds.value) > std::abs(worst->bias_sds.value)) worst = &quantity;
  }
  if (!any) return {};
  if (worst == nullptr) return "none of them is biased by more than chance";
  return fmt::format("{} is off by {:.1f} standard deviations on average", symbol_of(worst->quantity),
                     std::abs(worst->bias_sds.value));
}

/// Values of one twin alone have no standard deviation.
std::string bias_text(const CertifiedQuantity& quantity) {
  const auto& [value, sd] = quantity.bias_sds;
  constexpr double kDigit = 0.01;  // of a standard deviation: finer ones tell nobody anything
  return std::isfinite(sd) && sd > 0.0 ? fmt::format("{:.2f} ± {:.2f}", value, std::max(sd, kDigit))
                                       : fmt::format("{:.2f}", value);
}

std::vector<std::string> cells_of(const CertifiedQuantity& quantity) {
  const std::string failed = fmt::format("{} of {}", quantity.failed, quantity.asked);
  return {heading_of(quantity.quantity), share_text(quantity.coverage),     bias_text(quantity),
          base::sd_text(quantity.rms),   base::sd_text(quantity.stated_sd), failed};
}

const std::vector<std::string> kHeader = {"quantity",  "intervals that hold", "bias (stated sd)",
                                          "rms error", "stated sd",           "without a value"};

/// The table cells of a change, one for each quantity that has values.
std::vector<std::string> change_cells(const Certificate& certificate, const ChangedTwin& change) {
  std::vector<std::string> cells;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() == 0) continue;
    const auto at =
        std::find_if(change.quantities.begin(), change.quantities.end(),
                     [&](const validate::QuantityFall& fall) { return fall.quantity == quantity.quantity; });
    cells.push_back(at == change.quantities.end() ? "–" : fall_text(at->fall));
  }
  return cells;
}

std::string change_name(const Certificate& certificate, const ChangedTwin& change) {
  const LimitWords words = limit_words(change, certificate);
  return fmt::format("{}: {}", words.limit, words.change);
}

constexpr const char* kNothingStandsOut =
    "Nothing stands out: no change that was tried reduces the errors by a tenth or more, beyond chance.";

/// Whether a change reduces the errors by more than chance and by enough to be worth the trouble.
bool helps(const ChangedTwin& change) {
  return change.stands_out && change.together && change.together->value >= kWorthDoing;
}

std::string limits_words(const Certificate& certificate) {
  std::string names;
  for (const ChangedTwin& change : certificate.changes) {
    if (helps(change)) names += (names.empty() ? "" : ", ") + limit_words(change, certificate).limit;
  }
  return names.empty() ? kNothingStandsOut : fmt::format("What limits it, the largest first: {}.", names);
}

/// "quadratic drag, added inertia and friction by configuration".
std::string explanation_name(const validate::CertifiedExplanation& one) {
  std::vector<std::string> names;
  for (const std::string& id : one.ids) names.push_back(effect_name(id));
  return names.empty() ? "the nominal law alone" : list_of(names);
}

/// The explanations under which the intervals fail, if they hold under others; empty if there is no difference.
std::string explanation_words(const Certificate& certificate) {
  double failing = 0.0;
  const validate::CertifiedExplanation* worst = nullptr;
  for (const validate::CertifiedExplanation& one : certificate.explanations) {
    if (!one.fails()) continue;
    failing += one.probability;
    if (worst == nullptr || one.probability > worst->probability) worst = &one;
  }
  if (worst == nullptr || certificate.explanations.size() < 2) return {};
  const std::string which =
      failing > 0.995
          ? "every explanation of the data that the diagnosis finds likely"
          : fmt::format("explanations of the data to which the diagnosis gives a probability of {} % in all",
                        whole_percent(failing));
  return fmt::format("They fail under {}, above all under {} ({} % hold).", which, explanation_name(*worst),
                     whole_percent(worst->coverage.share));
}

/// "the terminal velocity", "µ": within a sentence.
std::string named(const CertifiedQuantity& quantity) {
  return (is_headline(quantity) ? "" : "the ") + symbol_of(quantity.quantity);
}

/// The intervals that hold too rarely, each with its share; empty if there are none.
std::string narrow_words(const Certificate& certificate) {
  std::vector<std::string> names, shares;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (!quantity.too_narrow()) continue;
    names.push_back(named(quantity));
    shares.push_back(share_text(quantity.coverage));
  }
  if (names.empty()) return {};
  return fmt::format("Do not trust the intervals of {}: they hold in {} of recordings like yours, not in 95 %",
                     list_of(names), list_of(shares));
}

/// The command whose law includes the cause; empty if there is none.
std::string with_causes(const Certificate& certificate) {
  for (const ChangedTwin& change : certificate.changes) {
    if (change.limit != validate::TwinLimit::cause || change.causes.empty()) continue;
    return fmt::format(" `glidelab analyze --with {}` includes {} in the law.", fmt::join(change.causes, " --with "),
                       change.causes.size() > 1 ? "these causes" : "this cause");
  }
  return {};
}

}  // namespace

std::string certificate_answer(const Certificate& certificate) {
  if (certificate.empty()) {
    return "There is nothing to count: no twin of this recording yields K/m, µ, α or a terminal velocity with a known "
           "true value.";
  }
  const bool is_headline_known = certificate.together.of > 0;
  const std::string bias = is_headline_known ? "; " + bias_words(certificate) : "";
  if (const std::string narrow = narrow_words(certificate); !narrow.empty())
    return narrow + bias + "." + with_causes(certificate);
  if (!is_headline_known) {
    const auto known = std::find_if(certificate.quantities.begin(), certificate.quantities.end(),
                                    [](const CertifiedQuantity& quantity) { return quantity.answered() > 0; });
    return fmt::format("Intervals of {} hold in {} of recordings like yours. K/m, µ and α have no known true value.",
                       named(*known), share_text(known->coverage));
  }
  const std::string share = share_text(certificate.together);
  if (certificate.holds()) {
    return fmt::format("Intervals of {} hold in {} of recordings like yours{}.", headline_names(certificate), share,
                       bias);
  }
  return fmt::format("Do not trust the intervals: those of {} hold in {} of recordings like yours, not in 95 %{}.{}",
                     headline_names(certificate), share, bias, with_causes(certificate));
}

namespace {

/// ", but those of the terminal velocity 150 times larger (110 to 190)": what the change makes worse beyond chance.
std::string worse_words(const Certificate& certificate, const ChangedTwin& change) {
  std::vector<std::string> worse;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    const auto at = std::ranges::find(change.quantities, quantity.quantity, &validate::QuantityFall::quantity);
    if (at == change.quantities.end() || !makes_worse(*at)) continue;
    worse.push_back(fmt::format("those of {} {}", named(quantity), rise_text(at->fall)));
  }
  return worse.empty() ? std::string() : ", but " + list_of(worse);
}

}  // namespace

std::vector<std::string> best_changes(const Certificate& certificate) {
  std::vector<std::string> words;
  for (const ChangedTwin& change : certificate.changes) {
    if (!helps(change) || words.size() == kMostChanges) continue;
    const LimitWords limit = limit_words(change, certificate);
    words.push_back(fmt::format("{}. With {}, the errors of {} are {} smaller{}.", limit.advice, limit.change,
                                headline_names(certificate), fall_text(*change.together),
                                worse_words(certificate, change)));
  }
  return words;
}

Plot certificate_plot(const Certificate& certificate) {
  PlotData data{"q", {}, {"intervals that hold (%)", "row", "from (%)", "to (%)"}};
  std::string tics;
  double row = 0.0, lowest = 80.0;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() == 0) continue;
    row += 1.0;
    const validate::RunShare& share = quantity.coverage;
    lowest = std::min(lowest, 100.0 * share.low - 2.0);
    data.rows.push_back({100.0 * share.share, row, 100.0 * share.low, 100.0 * share.high});
    tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ", gnuplot_quoted(symbol_of(quantity.quantity)), row);
  }
  const std::string script =
      std::string(kFrame) +
      fmt::format(
          "unset offsets\nunset key\nset xrange [{:.4g}:100.5]\nset yrange [{:.4g}:0.3]\nset ytics ({})\n"
          "set xlabel '95 % intervals that contain the true value (%)'\n"
          "set arrow from 95, graph 0 to 95, graph 1 nohead back lw 1 lc rgb '#888888'\n"
          "plot $q using 1:2:3:4 with xerrorbars pt 7 ps 0.7 lw 1.5 lc rgb '{}'",
          lowest, row + 0.7, tics, color(0));
  return {Drawing{script, {never_empty(data)}, {480, 240}},
          "Intervals that hold in the twins, each share with its own 95 % interval; the line: 95 %, as stated",
          "Share of the stated intervals that hold, by quantity"};
}

namespace {

Json share_json(const validate::RunShare& share) {
  return Json{
      {"holds", share.holds}, {"of", share.of}, {"share", share.share}, {"interval95", {share.low, share.high}}};
}

Json quantity_json(const CertifiedQuantity& quantity, const std::vector<std::string>& setups) {
  Json object;
  if (quantity.setup) object["configuration"] = setups.at(*quantity.setup);
  object["quantity"] = quantity.quantity;
  object["asked"] = quantity.asked;
  object["failed"] = quantity.failed;
  if (quantity.answered() == 0) {
    object["coverage"] = nullptr;
    object["why"]["coverage"] = unanswered_words(quantity);
    return object;
  }
  object["coverage"] = share_json(quantity.coverage);
  put(object, "bias_sds", quantity.bias_sds.value);
  put(object, "bias_sds_sd", quantity.bias_sds.sd);
  put(object, "rms", quantity.rms);
  put(object, "stated_sd", quantity.stated_sd);
  object["too_narrow"] = quantity.too_narrow();
  return object;
}

Json fall_json(const validate::RunFall& fall) {
  return Json{{"value", fall.value}, {"interval95", {fall.low, fall.high}}};
}

Json change_json(const Certificate& certificate, const ChangedTwin& change) {
  const LimitWords words = limit_words(change, certificate);
  Json object{{"limit", words.limit}, {"change", words.change}, {"advice", words.advice}, {"twins", change.runs}};
  if (change.together) {
    object["fall"] = fall_json(*change.together);
  } else {
    object["fall"] = nullptr;
    object["why"]["fall"] = "too few twins have a value with and without the change";
  }
  object["stands_out"] = change.stands_out;
  object["quantities"] = Json::array();
  for (const validate::QuantityFall& one : change.quantities) {
    object["quantities"].push_back(
        {{"quantity", one.quantity}, {"fall", fall_json(one.fall)}, {"significant", one.significant}});
  }
  return object;
}

}  // namespace

std::string certificate_json(const Certificate& certificate) {
  Json document;
  document["format"] = 1;
  document["answer"] = certificate_answer(certificate);
  document["holds"] = certificate.empty() ? Json(nullptr) : Json(certificate.holds());
  document["twins"] = certificate.runs;
  document["clips"] = certificate.clips;
  document["motions"] = std::max(certificate.clips, certificate.motions);
  document["estimator"] = certificate.estimator;
  document["by"] = certificate.filmed ? "film" : "tracks";
  document["together"] = share_json(certificate.together);
  const std::vector<std::string> setups = setup_names(certificate);
  document["quantities"] = Json::array();
  for (const CertifiedQuantity& one : certificate.quantities)
    document["quantities"].push_back(quantity_json(one, setups));
  document["configurations"] = Json::array();
  for (const CertifiedQuantity& one : certificate.configurations)
    document["configurations"].push_back(quantity_json(one, setups));
  document["explanations"] = Json::array();
  for (const validate::CertifiedExplanation& one : certificate.explanations) {
    document["explanations"].push_back({{"causes", one.ids},
                                        {"probability", one.probability},
                                        {"twins", one.twins},
                                        {"coverage", share_json(one.coverage)}});
  }
  document["changes"] = Json::array();
  for (const ChangedTwin& change : certificate.changes) document["changes"].push_back(change_json(certificate, change));
  document["causes"] = certificate.causes;
  document["not_in_the_twins"] = Json::array();
  for (const validate::NotInTwins& lack : certificate.without) document["not_in_the_twins"].push_back(lack_words(lack));
  put(document, "recorded_noise_m", certificate.recorded_noise_m);
  put(document, "twin_noise_m", certificate.twin_noise_m);
  return json_text(document);
}

std::string certificate_text(const Certificate& certificate) {
  std::string text = without_code_marks(certificate_answer(certificate)) + "\n";
  if (const std::string which = explanation_words(certificate); !which.empty())
    text += base::printable_text(which) + "\n";
  if (const std::string lacks = all_lacks(certificate); !lacks.empty()) text += base::printable_text(lacks) + "\n";
  text += "\n";
  std::vector<std::vector<std::string>> rows = {kHeader};
  std::vector<std::vector<std::string>> changes = {{"how much smaller the error becomes with"}};
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() == 0) continue;
    rows.push_back(cells_of(quantity));
    changes.front().push_back(symbol_of(quantity.quantity));
  }
  text += text_table(rows, 1);
  if (const std::string none = all_unanswered(certificate); !none.empty()) text += base::printable_text(none) + "\n";
  for (const ChangedTwin& change : certificate.changes) {
    changes.push_back({change_name(certificate, change)});
    for (std::string& cell : change_cells(certificate, change)) changes.back().push_back(std::move(cell));
  }
  text += "\n" + text_table(changes, 1) + "\n" + limits_words(certificate) + "\n";
  const std::vector<std::string> best = best_changes(certificate);
  for (std::size_t i = 0; i < best.size(); ++i) text += fmt::format("{}. {}\n", i + 1, best[i]);
  return text + "\n" + base::printable_text(twin_words(certificate)) + "\n";
}

namespace {

/// A command in brackets as code.
std::string with_command(std::string text) {
  const std::size_t from = text.find("(glidelab "), to = text.find(')', from);
  if (from == std::string::npos || to == std::string::npos) return text;
  text.insert(to, "</code>");
  text.insert(from + 1, "<code>");
  return text;
}

std::string changes_html(const Certificate& certificate) {
  const std::vector<std::string> best = best_changes(certificate);
  if (best.empty()) return fmt::format("<p>{}</p>\n", kNothingStandsOut);
  std::string list;
  for (const std::string& one : best) list += fmt::format("<li>{}</li>\n", with_command(escape(one)));
  return fmt::format("<h2 id=\"changes\">What would help most</h2>\n<ol>\n{}</ol>\n", list);
}

std::string limits_table(const Certificate& certificate) {
  std::vector<std::string> header = {"change", "together"};
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() > 0) header.push_back(escape(symbol_of(quantity.quantity)));
  }
  HtmlTable table(header);
  table.stack_when_narrow(1);
  for (const ChangedTwin& change : certificate.changes) {
    const std::string together = change.together ? fall_text(*change.together) : "–";
    std::vector<std::string> cells = {escape(change_name(certificate, change)),
                                      change.stands_out ? "<b>" + together + "</b>" : together};
    for (std::string& cell : change_cells(certificate, change)) cells.push_back(std::move(cell));
    table.row(cells);
  }
  return table.str() +
         fmt::format(
             "<p class=\"soft\">How much smaller the rms error becomes, with its 95 % interval, over the same "
             "twins with one change each ({} of them). Below 0 it becomes larger; where it more than doubles, the "
             "table gives the factor instead. Together: K/m, µ and α alike. Bold: above 0 by more than chance, over "
             "all "
             "changes.</p>\n",
             certificate.changes.front().runs);
}

std::string configurations_table(const Certificate& certificate) {
  if (certificate.configurations.empty()) return {};
  std::vector<std::string> header = kHeader;
  header.insert(header.begin(), "configuration");
  HtmlTable table(header, 2);
  table.stack_when_narrow(2);
  const std::vector<std::string> setups = setup_names(certificate);
  for (const CertifiedQuantity& quantity : certificate.configurations) {
    if (quantity.answered() == 0) continue;
    std::vector<std::string> cells = cells_of(quantity);
    cells.front() = escape(cells.front());
    cells.insert(cells.begin(), escape(setups.at(*quantity.setup)));
    table.row(cells);
  }
  return table.empty() ? std::string() : table.str();
}

std::string explanations_table(const Certificate& certificate) {
  HtmlTable table({"explanation", "probability", "twins", "intervals that hold"});
  for (const validate::CertifiedExplanation& one : certificate.explanations) {
    table.row({escape(explanation_name(one)), whole_percent(one.probability) + " %", fmt::format("{}", one.twins),
               share_text(one.coverage)});
  }
  return table.str() +
         "<p class=\"soft\">Explanations that the diagnosis weighed, with their probabilities among these; K/m, µ and "
         "α "
         "together.</p>\n";
}

std::string how_judged(const Certificate& certificate) {
  return fmt::format(
      "<p>{}</p>\n<p>A twin's truth is known: K/m, µ, α and the terminal velocity of the fitted motions (with "
      "a named cause, K/m and µ are those of the viscous and Coulomb friction in the law). A 95 % interval holds if it "
      "contains the truth. The share that holds has the interval of Clopper and Pearson, for the number of independent "
      "intervals that would scatter as much as the shares of single twins do. Bias is the mean error divided by the "
      "stated standard deviation.</p>\n",
      escape(twin_words(certificate)));
}

}  // namespace

Page certificate_page(const std::string& name, const Certificate& certificate) {
  Html body = question_heading(name, "Can I trust the stated intervals?") +
              fmt::format("<p><b>{}</b></p>\n", escape_with_code(certificate_answer(certificate)));
  if (const std::string which = explanation_words(certificate); !which.empty())
    body += fmt::format("<p>{}</p>\n", escape(which));
  if (const std::string lacks = all_lacks(certificate); !lacks.empty())
    body += fmt::format("<p class=\"note\">{}</p>\n", escape(lacks));
  HtmlTable table(kHeader);
  table.stack_when_narrow(1);
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() == 0) continue;
    std::vector<std::string> cells = cells_of(quantity);
    cells.front() = escape(cells.front());
    table.row(cells);
  }
  if (!table.empty()) body += table.str();
  if (const std::string none = all_unanswered(certificate); !none.empty())
    body += fmt::format("<p class=\"soft\">{}</p>\n", escape(none));
  if (!certificate.empty()) body += figures({certificate_plot(certificate)});
  body += changes_html(certificate);
  if (!certificate.changes.empty()) body += folded("What limits it", limits_table(certificate));
  if (certificate.explanations.size() > 1) body += folded("Each explanation", explanations_table(certificate));
  body += folded("Each configuration", configurations_table(certificate));
  body += folded("How this was judged", how_judged(certificate));
  return page("Certificate: " + name, body);
}

}  // namespace glidelab::report
