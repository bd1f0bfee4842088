#include "teach/page/laws_motion.h"

#include <fmt/format.h>

#include <vector>

#include "report/html/html.h"
#include "report/html/plot_style.h"
#include "teach/page/page_texts.h"

namespace glidelab::teach {
namespace {

using report::color;
using report::data_uri;
using report::escape;

std::string numbers(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += fmt::format("{}{:.5g}", i == 0 ? "" : ",", values[i]);
  return text + "]";
}

}  // namespace

// Names are text of the page over the film: no text of a file is in the script.
std::string film_figure(const LawStudy& study, const LawFilm& film) {
  std::string data = fmt::format("{{\"rate\":{},\"motions\":[", kFramesPerSecond), names;
  for (std::size_t i = 0; i < study.motions.size(); ++i) {
    const LawMotion& motion = study.motions[i];
    data += fmt::format("{}{{\"color\":\"{}\",\"v\":{},\"a\":{}}}", i == 0 ? "" : ",", color(i), numbers(motion.v_m_s),
                        numbers(motion.a_m_s2));
    names +=
        fmt::format("<li style=\"--row:{:.4f}\"><i style=\"background:{}\"></i>{}</li>",
                    static_cast<double>(i) / static_cast<double>(study.motions.size()), color(i), escape(motion.clip));
  }
  data += "],\"equilibria\":[";
  for (const LawCurve& curve : study.curves) {
    for (const Equilibrium& at : curve.equilibria) {
      data += fmt::format("{}[{:.5g},{}]", data.back() == '[' ? "" : ",", at.v_m_s, at.stable);
    }
  }
  return fmt::format(
      "<div class=\"law\"><figure><div class=\"rows\" style=\"--tall:{:.4f}\"><video controls loop muted playsinline "
      "preload=\"auto\" "
      "width=\"{}\" height=\"{}\" aria-label=\"Film of {}\" src=\"{}\"></video><ul>{}</ul></div>"
      "<figcaption>The gliders on their tracks drawn by the renderer, each track with its true slope; {:.1f} s, in "
      "real time</figcaption></figure><figure><canvas role=\"img\" aria-label=\"Points of {} in a(v)\"></canvas>"
      "<figcaption>Their points in a(v) at the same time</figcaption></figure>"
      "<script type=\"application/json\">{}]}}</script></div>\n",
      film.width_px > 0 ? static_cast<double>(film.height_px) / film.width_px : 0.0, film.width_px, film.height_px,
      escape(study.name), data_uri("video/mp4", film.mp4), names,
      static_cast<double>(film.frames - 1) / film.frame_rate_hz, escape(study.name), data);
}

std::string film_script() {
  return fmt::format("<style>\n{}</style>\n<script>\n{}</script>\n", kFilmStyle, kFilmScript);
}

}  // namespace glidelab::teach
