#include "teach/page/worksheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "base/text/number_text.h"
#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "teach/page/page_words.h"
#include "teach/study/law_questions.h"

namespace glidelab::teach {
namespace {

using report::color;
using report::gnuplot_quoted;
using report::PlotData;

// Size of the sheet, A4 in points.
constexpr int kWidth = 595, kHeight = 842;
constexpr double kLine = 15.0;                                  // from one line of text to the next
constexpr double kAnswerLine = 24.0;                            // for writing by hand
constexpr std::size_t kCharacters = 74, kTitleCharacters = 46;  // in a line
// Font sizes for gnuplot's PDF: half as many points on paper.
constexpr int kType = 19, kSmall = 17, kTitle = 30;
constexpr double kLeft = 0.085, kRight = 0.935;
constexpr std::string_view kNoBreak = "\u00a0";
constexpr int kReadDigits = 2;  // of what is read off the figure

/// A text of the sheet's language by its key.
using Say = std::function<std::string(const std::string& key, const WordValues& values)>;

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string in_language(const std::string& language, const std::string& number) {
  return replaced(replaced(number, "-", "−"), ".", texts_of(language).at("decimal"));
}

/// The text split into lines that fit the sheet; a number stays with its unit, and "a > 0" on one line.
std::vector<std::string> lines_of(std::string text, std::size_t most = kCharacters) {
  for (const char* sign : {"=", "<", ">"})
    text = replaced(text, fmt::format(" {} ", sign), fmt::format("{0}{1}{0}", kNoBreak, sign));
  for (const char* unit : {"m/s", "1/s"})
    text = replaced(text, fmt::format(" {}", unit), fmt::format("{}{}", kNoBreak, unit));
  std::vector<std::string> lines(1);
  std::size_t length = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto characters =
        static_cast<std::size_t>(std::ranges::count_if(word, [](char c) { return (c & 0xC0) != 0x80; }));
    if (length > 0 && length + 1 + characters > most) {
      lines.emplace_back();
      length = 0;
    }
    lines.back() += (length > 0 ? " " : "") + word;
    length += (length > 0 ? 1 : 0) + characters;
  }
  return lines;
}

/// gnuplot: the texts and rules of a sheet, from top to bottom.
class Sheet {
 public:
  void text(double from, const std::string& text, int size, std::string_view ink = "#000000") {
    script_ += fmt::format("set label {} at screen {:.4f}, screen {:.4f} left font ',{}' textcolor rgb '{}' front\n",
                           gnuplot_quoted(text), from, y(), size, ink);
  }
  void rule(double from, double to) {
    script_ += fmt::format(
        "set arrow from screen {:.4f}, screen {:.4f} to screen {:.4f}, screen {:.4f} nohead lw 0.7 "
        "lc rgb '#999999'\n",
        from, y(), to, y());
  }
  void down(double points) { from_top_ += points; }
  double y() const { return 1.0 - from_top_ / kHeight; }
  const std::string& script() const { return script_; }

 private:
  double from_top_ = 55.0;
  std::string script_;
};

/// What becomes of gliders on this curve: one sentence for each range of speeds, and the reason for it.
std::string outcome_text(const LawCurve& curve, const std::function<std::string(double)>& shown, const Say& say) {
  std::string text;
  const auto add = [&](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  const std::vector<Equilibrium>& all = curve.equilibria;
  if (all.empty()) {
    const auto zero = [](double a) { return a == 0.0; };
    const bool coasts = std::ranges::all_of(curve.up_a_m_s2, zero) && std::ranges::all_of(curve.down_a_m_s2, zero);
    return say(coasts ? "ws_everywhere" : "ws_never", {});
  }
  std::vector<double> left;  // speeds that a glider leaves, on either side
  bool returns = false;
  for (const Equilibrium& at : all) {
    if (at.stable) returns = true;
    if (!at.stable && at.v_m_s != 0.0) left.push_back(at.v_m_s);
    if (!at.stable && at.v_m_s == 0.0) add(say("ws_at_rest", {{"ends", say("may_stay", {})}}));
  }
  for (std::size_t i = 0; i <= left.size(); ++i) {  // the ranges between them
    std::string ends = say("ws_runs_away", {});
    for (const Equilibrium& at : all) {
      if (!at.stable || (i > 0 && at.v_m_s < left[i - 1]) || (i < left.size() && at.v_m_s > left[i])) continue;
      ends = at.v_m_s != 0.0 ? say("tends_to_limit", {{"v", shown(at.v_m_s)}})
                             : say(at.stops ? "comes_to_rest" : "tends_to_rest", {});
    }
    WordValues values = {{"ends", ends}};
    const bool above = i > 0, below = i < left.size();
    if (above && below) {
      values["v1"] = shown(left[i - 1]);
      values["v2"] = shown(left[i]);
    } else if (above || below) {
      values["v"] = shown(above ? left[i - 1] : left[i]);
    }
    add(say(above && below ? "ws_between" : above ? "ws_faster" : below ? "ws_slower" : "ws_always", values));
  }
  if (returns) add(say("ws_stable", {}));
  for (const double v : left) add(say("ws_unstable", {{"v", shown(v)}}));
  return text;
}

report::Plot sheet_of(const LawStudy& study, const WorksheetTexts& texts, const std::string& language, bool teacher) {
  Sheet sheet;
  for (const std::string& line : lines_of(teacher ? texts.answers_title : texts.title, kTitleCharacters)) {
    sheet.text(kLeft, line, kTitle);
    sheet.down(24.0);
  }
  sheet.down(4.0);
  if (!teacher) {
    sheet.text(kLeft, text_in(language, "ws_name") + ":", kType);
    sheet.text(0.65, text_in(language, "ws_date") + ":", kType);
    sheet.down(5.0);
    sheet.rule(kLeft + 0.1, 0.62);
    sheet.rule(0.74, kRight);
  }
  sheet.down(24.0);
  sheet.text(kLeft, text_in(language, "ws_figure"), kSmall, "#555555");
  sheet.down(30.0);
  const double top = sheet.y();
  sheet.down(270.0);
  const double bottom = sheet.y();
  sheet.down(62.0);
  for (std::size_t i = 0; i < texts.questions.size(); ++i) {
    for (const std::string& line : lines_of(texts.questions[i])) {
      sheet.text(kLeft, line, kType);
      sheet.down(kLine);
    }
    if (teacher) {
      sheet.down(3.0);
      for (const std::string& line : lines_of(texts.answers[i])) {
        sheet.text(kLeft, line, kType, "#0058a0");
        sheet.down(kLine);
      }
      sheet.down(16.0);
    } else {
      for (int k = 0; k < 3; ++k) {
        sheet.down(k == 0 ? 9.0 : kAnswerLine);
        sheet.rule(kLeft, kRight);
      }
      sheet.down(26.0);
    }
  }
  std::vector<PlotData> data;
  std::string plots;
  const auto add = [&](const std::string& name, const std::vector<double>& v, const std::vector<double>& a,
                       const std::string& how) {
    if (v.empty()) return;
    PlotData block{name, {}};
    for (std::size_t i = 0; i < v.size(); ++i) block.rows.push_back({v[i], a[i]});
    plots += fmt::format("{}${} using 1:2 {}", plots.empty() ? "" : ", ", name, how);
    data.push_back(std::move(block));
  };
  for (std::size_t c = 0; c < study.curves.size(); ++c) {
    const LawCurve curve = in_both_directions(study.curves[c]);
    const std::string how = fmt::format("with lines lw 2.2 dt {} lc rgb '{}' ", c % 2 == 0 ? 1 : 2, color(c));
    const std::string title = "title " + gnuplot_quoted(report::shortened(curve.configuration));
    add(fmt::format("up{}", c), curve.up_v_m_s, curve.up_a_m_s2, how + "notitle");
    add(fmt::format("down{}", c), curve.down_v_m_s, curve.down_a_m_s2, how + title);
  }
  if (teacher) {
    for (const bool stable : {true, false}) {
      std::vector<double> v, zero;
      for (const Equilibrium& at : study.curves[answers_of(study).curve].equilibria) {
        if (at.stable == stable) v.push_back(at.v_m_s);
      }
      zero.assign(v.size(), 0.0);
      add(stable ? "stable" : "unstable", v, zero,
          fmt::format("with points pt {} ps 0.9 lw 1.6 lc rgb '#000000' notitle", stable ? 7 : 6));
    }
  }
  const std::string script =
      std::string(report::kFrame) + sheet.script() +
      fmt::format(
          "set decimalsign '{0}'\nset lmargin at screen {1}\nset rmargin at screen {2}\nset tmargin at screen "
          "{3:.4f}\nset bmargin at screen {4:.4f}\nset tics font ',{5}'\nset grid xtics ytics mxtics mytics lw "
          "0.6 lc rgb '#cccccc', lw 0.3 lc rgb '#e4e4e4'\nset mxtics 5\nset mytics 5\n"
          "set key at screen {2}, screen {6:.4f} right bottom horizontal samplen 2 font ',{5}'\n"
          "set xlabel 'v (m/s)' font ',{5}'\nset ylabel 'a (m/s²)' font ',{5}'\n"
          "set xzeroaxis lt 1 lc rgb '#555555'\nset yzeroaxis lt 1 lc rgb '#555555'\nplot ",
          texts_of(language).at("decimal"), kLeft + 0.07, kRight, top, bottom, kSmall, top + 0.004) +
      plots;
  return {report::Drawing{script, data, {kWidth, kHeight}}, texts.title, texts.title};
}

}  // namespace

WorksheetTexts worksheet_texts(const LawStudy& study, const std::string& language) {
  const LawAnswers asked = answers_of(study);
  const LawCurve& curve = study.curves[asked.curve];
  const auto read = [&](double value) { return in_language(language, base::digits_text(value, kReadDigits)); };
  const auto given = [&](double value, int digits = 3) {
    return in_language(language, base::number_text(value, digits));
  };
  const Say say = [&](const std::string& key, const WordValues& values) {
    return replaced(text_in(language, key, values), "v_lim", "vₗᵢₘ");
  };
  const std::string key = key_of(study.name, "scenario");
  const std::string law = key.empty() ? study.name : text_in(language, key);
  WorksheetTexts texts;
  texts.title = say("ws_title", {{"law", law}});
  texts.answers_title = say("ws_answers", {{"law", law}});
  texts.questions = {say("ws_question1", {{"track", curve.configuration},
                                          {"alpha", given(std::round(10.0 * curve.incline_deg) / 10.0, 4)},
                                          {"v1", given(asked.v1_m_s)},
                                          {"v2", given(asked.v2_m_s)}}),
                     say("ws_question2", {{"g", given(curve.body.gravity_m_s2)}}), say("ws_question3", {})};
  const std::string slope = asked.flat() ? "ws_flat" : asked.straight() ? "ws_linear" : "ws_bent";
  WordValues slopes;
  if (!asked.flat())
    slopes = {{"s1", read(asked.slope1_1_s)}, {"s2", read(asked.slope2_1_s)}, {"k", read(-asked.slope1_1_s)}};
  const std::string jump = !asked.jumps() ? "ws_no_jump" : asked.mu_varies ? "ws_jump_near" : "ws_jump";
  const WordValues jumps = {{"jump", read(asked.jump_m_s2)}, {"mu", read(asked.mu)}};
  texts.answers = {say(slope, slopes), say(jump, asked.jumps() ? jumps : WordValues{}), outcome_text(curve, read, say)};
  return texts;
}

std::vector<Worksheet> worksheets(const std::vector<LawStudy>& studies, const std::string& language) {
  std::vector<report::Plot> plots;
  std::vector<std::string> names;
  for (const LawStudy& study : studies) {
    const WorksheetTexts texts = worksheet_texts(study, language);
    for (const bool teacher : {false, true}) {
      plots.push_back(sheet_of(study, texts, language, teacher));
      names.push_back(fmt::format("sheet{:02}", names.size()));
    }
  }
  const std::vector<report::DrawnPlot> drawn = report::draw_plots(plots, names);
  std::vector<Worksheet> made;
  for (std::size_t i = 0; i < studies.size(); ++i) made.push_back({drawn[2 * i].pdf, drawn[2 * i + 1].pdf});
  return made;
}

}  // namespace glidelab::teach
