#include "teach/page/worksheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string number(const std::string& language, double value, int digits) {
  const std::string text = std::abs(value) < 1e-12 ? "0" : base::number_text(value, digits);
  return replaced(replaced(text, "-", "−"), ".", texts_of(language).at("decimal"));
}

/// The text split into lines that fit the sheet.
std::vector<std::string> lines_of(const std::string& text, std::size_t most = kCharacters) {
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
    const LawCurve& curve = study.curves[c];
    const std::string how = fmt::format("with lines lw 2.2 dt {} lc rgb '{}' ", c % 2 == 0 ? 1 : 2, color(c));
    const std::string title = "title " + gnuplot_quoted(report::shortened(curve.configuration));
    add(fmt::format("up{}", c), curve.up_v_m_s, curve.up_a_m_s2, how + (curve.down_v_m_s.empty() ? title : "notitle"));
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
  const auto shown = [&](double value, int digits = 3) { return number(language, value, digits); };
  const auto say = [&](const std::string& key, const WordValues& values = {}) {
    return replaced(text_in(language, key, values), "v_lim", "vₗᵢₘ");
  };
  const std::string key = key_of(study.name, "scenario");
  const std::string law = key.empty() ? study.name : text_in(language, key);
  std::string ends;
  for (const Equilibrium& at : curve.equilibria) {
    ends += (ends.empty() ? "" : "; ") +
            (at.v_m_s != 0.0 ? say(at.stable ? "tends_to_limit" : "unstable_at", {{"v", shown(at.v_m_s, 4)}})
             : !at.stable    ? say("may_stay")
             : at.stops      ? say("comes_to_rest")
                             : say("tends_to_rest"));
  }
  if (ends.empty()) ends = say("no_limit");
  WorksheetTexts texts;
  texts.title = say("ws_title", {{"law", law}});
  texts.answers_title = say("ws_answers", {{"law", law}});
  texts.questions = {say("ws_question1", {{"track", curve.configuration},
                                          {"alpha", shown(curve.incline_deg, 4)},
                                          {"v1", shown(asked.v1_m_s)},
                                          {"v2", shown(asked.v2_m_s)}}),
                     say("ws_question2", {{"g", shown(curve.body.gravity_m_s2, 3)}}), say("ws_question3")};
  const std::string slope = asked.flat() ? "ws_flat" : asked.straight() ? "ws_linear" : "ws_bent";
  WordValues slopes;
  if (!asked.flat())
    slopes = {{"s1", shown(asked.slope1_1_s)}, {"s2", shown(asked.slope2_1_s)}, {"k", shown(-asked.slope1_1_s)}};
  texts.answers = {
      say(slope, slopes),
      asked.jumps() ? say("ws_jump", {{"jump", shown(asked.jump_m_s2)}, {"mu", shown(asked.mu)}}) : say("ws_no_jump"),
      say("ws_end", {{"ends", ends}})};
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
