#include "report/html/html.h"

#include <algorithm>
#include <cmath>

#include "report/analysis/analysis_report.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;

TEST_CASE("text cannot become markup") {
  CHECK(report::escape("<script>alert('x') & \"y\"</script>") ==
        "&lt;script&gt;alert(&#39;x&#39;) &amp; &quot;y&quot;&lt;/script&gt;");
}

TEST_CASE("a table of long names gives them a wide column, one of short names or of links does not") {
  report::HtmlTable cameras({"camera", "price (EUR)"}), clips({"clip", "frames"});
  cameras.row({"Raspberry Pi camera v1 (OV5647), 640x480 at 90 fps", "8"});
  clips.row({"view-00.png", "264"});
  CHECK(cameras.str().find("<table class=\"names\">") != std::string::npos);
  CHECK(clips.str().find("<table>") != std::string::npos);
  report::HtmlTable links({"clip", "frames"});
  links.row({"<a href=\"#a-very-long-place\">m1 &amp; µ</a>", "264"});
  CHECK(links.str().find("<table>") != std::string::npos);  // what is not seen takes no room
}

TEST_CASE("a table that stacks when narrow names every cell after its column, the row's own names aside") {
  report::HtmlTable table({"no.", "camera", "a<sub>0</sub> (m/s²)", "at most"}, 2);
  table.stack_when_narrow(2);
  table.row({"1", "webcam", "2.0", "3.0"});
  CHECK(table.str().find("<table class=\"stack numbered\">") != std::string::npos);
  CHECK(table.str().find("<td>1</td><td>webcam</td><td class=\"n\" data-title=\"a0 (m/s²)\">2.0</td>"
                         "<td class=\"n\" data-title=\"at most\">3.0</td>") != std::string::npos);
}

TEST_CASE("a long title of a column gets width for few lines, a short one and the first column's do not") {
  const std::string table = report::HtmlTable({"a long first title", "gap", "standard deviations off, before"}).str();
  CHECK(table.find("<th>a long first title</th><th class=\"n\">gap</th><th class=\"n w\">standard") !=
        std::string::npos);
  CHECK(report::HtmlTable({"a", "what the pictures show"}, 2).str().find("<th class=\"w\">what") != std::string::npos);
}

TEST_CASE("a hyphen before a number becomes a minus sign on a page, one in a name, a date, a tag or code does not") {
  CHECK(report::typeset_numbers("-0.3, (-5) ± -2") == "−0.3, (−5) ± −2");
  CHECK(report::typeset_numbers("10×-3, “-4”, ±-5") == "10×−3, “−4”, ±−5");
  CHECK(report::typeset_numbers("<td class=\"n\">-1.2</td>") == "<td class=\"n\">−1.2</td>");
  for (const std::string same :
       {"m1-2", "maß-2", "Δ-1", "ход-3", "µ-4", "1e-07", "2026-11-23", "a - b", "--cases 3", "<a href=\"#-1\">x</a>",
        "<code>-1</code>", "<script>x = -1;</script>", "<style>a { top: -1px }</style>", "-", "<", "<code"}) {
    CHECK(report::typeset_numbers(same) == same);
  }
  CHECK(report::typeset_numbers("<code>-1</code>-1") == "<code>-1</code>−1");
  CHECK(report::page("p", "<p>-4</p>").html.find("<p>−4</p>") != std::string::npos);
}

TEST_CASE("a number keeps to its unit and its standard deviation on one line, and a word behind a number does not") {
  const std::string space = "\u00a0";
  CHECK(report::typeset_numbers("0.351 ± 0.022 m/s of 53 %)") ==
        "0.351" + space + "±" + space + "0.022" + space + "m/s of 53" + space + "%)");
  CHECK(report::typeset_numbers("c = 0.0012 kg/m, 0.5 N s/m.") ==
        "c = 0.0012" + space + "kg/m, 0.5" + space + "N" + space + "s/m.");
  CHECK(report::typeset_numbers("(0.2 ± 0.1) mm") == "(0.2" + space + "±" + space + "0.1)" + space + "mm");
  for (const std::string same : {"3 more", "1 m-up", "4 mmol", "m s", "12 bits", "5 of 6", "<code>5 mm</code>",
                                 "K v becomes K v", "<a title=\"5 mm\">x</a>"}) {
    CHECK(report::typeset_numbers(same) == same);
  }
}

TEST_CASE("a quantity's name with one letter has its subscript, and what is longer or a file's key stays text") {
  CHECK(report::symbols_html("v_lim = 3, v_c up to 2") == "v<sub>lim</sub> = 3, v<sub>c</sub> up to 2");
  CHECK(report::symbols_html("tether_a x_mid_m m_s/x <b>") == "tether_a x_mid_m m_s/x &lt;b&gt;");
}

TEST_CASE("base64 gives RFC 4648's test vectors") {
  CHECK(report::base64("") == "");
  CHECK(report::base64("f") == "Zg==");
  CHECK(report::base64("fo") == "Zm8=");
  CHECK(report::base64("foo") == "Zm9v");
  CHECK(report::base64("foob") == "Zm9vYg==");
  CHECK(report::base64("fooba") == "Zm9vYmE=");
  CHECK(report::base64("foobar") == "Zm9vYmFy");
  CHECK(report::base64("\xff\xff\xfe") == "///+");
}

TEST_CASE("a page needs nothing but itself, says its values, and stays small for long tracks") {
  core::AnalysisResults results = tests::made_results();
  results.clips[0] = tests::made_clip("m1-up", 2.768, 0.8063, 0.667, 25000);
  const report::Page made = report::analysis_report("a long track", results, {});
  const std::string& page = made.html;
  CHECK(page.find("2.7680\u00a0±\u00a00.0060") != std::string::npos);
  // How many points a value rests on, and how well the noise itself is known: 0.021 mm / sqrt(2 x 24945 points).
  CHECK(page.find("<br><small>100 points</small>") != std::string::npos);
  CHECK(page.find("Position noise 0.021000\u00a0±\u00a00.000094\u00a0mm") != std::string::npos);
  CHECK(page.find("src=\"http") == std::string::npos);
  CHECK(page.find("href=\"http") == std::string::npos);
  CHECK(page.find("src=\"data:image/svg+xml;base64,") != std::string::npos);
  CHECK(std::any_of(made.files.begin(), made.files.end(), [](const auto& file) {
    return file.first.ends_with("-acceleration-against-velocity-with-fitted-lines.svg");
  }));
  CHECK(page.size() < 3'000'000);  // 10 MB allow twelve clips of a quarter of this each
}

TEST_CASE("what the camera's model says begins as a sentence does") {
  core::AnalysisResults results = tests::made_results();
  results.calibrations[0].lens.kept = {"<b>"};
  CHECK(report::analysis_report("camera", results, {}).html.find("px. Distortion: &lt;b&gt; (") != std::string::npos);
}

TEST_CASE("parts of a page keep their order, and a plot stands where it was put") {
  report::Html first("<p>a</p>");
  first.plot({{"plot 1", {}}, "one", "one"});
  report::Html second("<p>b</p>");
  second.plot({{"plot 2", {}}, "two", "two"});
  const report::Html both = first + (second + "<p>c</p>");
  CHECK(both.texts() == std::vector<std::string>{"<p>a</p>", "<p>b</p>", "<p>c</p>"});
  REQUIRE(both.plots().size() == 2);
  CHECK(both.plots()[1].caption == "two");
}

TEST_CASE("results without any usable point still make a page that says so") {
  core::AnalysisResults results = tests::made_results();
  for (core::ClipResult& clip : results.clips) {
    clip.motion.clear();
    clip.segments.clear();
  }
  for (core::ConfigurationResult& configuration : results.configurations) {
    configuration.lines.clear();
    configuration.k_over_m_1_s = configuration.mu = configuration.alpha_deg =
        configuration.v_lim_m_s = {std::nullopt, core::WhyUnknown{core::unknown::Told{"no free motion was found"}}};
  }
  const std::string page = report::analysis_report("nothing", results, {}).html;
  CHECK(page.find("no free motion was found") != std::string::npos);
}

TEST_CASE("a page says why a clip has no video") {
  const core::AnalysisResults results = tests::made_results();
  std::vector<core::Preview> previews(results.clips.size());
  CHECK(report::analysis_report("clips", results, previews).html.find("No video") == std::string::npos);
  previews[0].no_video = core::NoVideo{};
  previews[1].no_video = core::NoVideo{2'340'000};
  const std::string page = report::analysis_report("clips", results, previews).html;
  CHECK(page.find("No video: no H.264 encoder is installed.") != std::string::npos);
  CHECK(page.find("No video: it would take 2.3 MB.") != std::string::npos);
}

TEST_CASE("the detail near v = 0 promises the terminal velocity only where it shows a line that crosses a = 0") {
  core::AnalysisResults results = tests::made_results();
  // The clips' largest speed is 1.2 m/s, and the detail shows 15 % of it, 0.18 m/s.
  for (const double v_lim_m_s : {0.1, 0.3}) {
    for (core::ConfigurationResult& configuration : results.configurations) {
      core::LineFit& down = configuration.lines[1];
      down.a0_m_s2.value = down.k_over_m_1_s.value * v_lim_m_s;
    }
    const std::string page = report::analysis_report("detail", results, {}).html;
    REQUIRE(page.find("Near v = 0: the step between the lines") != std::string::npos);
    CHECK((page.find(" crosses a = 0 at the terminal velocity") != std::string::npos) == (v_lim_m_s < 0.18));
  }
}

TEST_CASE("a page says in words where a plot has nothing to show, and keeps its numbers and every other plot") {
  const report::Plot seen = {{"plot $a using 1:2", {{"a", {{0.0, 1.0}, {1.0, 2.0}}}}}, "seen", "a plot"};
  const report::Plot nothing = {{"plot $a using 1:2", {{"a", {{0.0, HUGE_VAL}}}}}, "not <seen>", "an empty plot"};
  const report::Page page = report::page("two", report::figures({nothing, seen}));
  CHECK(page.html.find("This plot is left out because its numbers leave nothing to draw") != std::string::npos);
  CHECK(page.html.find("<code>plots/01-an-empty-plot.csv</code>") != std::string::npos);
  CHECK(page.html.find("not &lt;seen&gt;") != std::string::npos);
  CHECK(page.html.find("<img alt=\"a plot\" src=\"data:image/svg+xml") != std::string::npos);
  CHECK(page.html.find("alt=\"an empty plot\"") == std::string::npos);
  CHECK(page.files.contains("plots/01-an-empty-plot.csv"));
  CHECK_FALSE(page.files.contains("plots/01-an-empty-plot.svg"));
  CHECK(page.files.contains("plots/02-a-plot.svg"));
}

TEST_CASE("a value in a tile may break before its plus-minus sign, and nowhere else") {
  CHECK(report::tile("-0.0105 ± 0.0090", "µ").find("0.0105<wbr> ± 0.0090</b>") != std::string::npos);
}

TEST_CASE("what stands between two backticks is code, a single one is a backtick, and all else is text") {
  CHECK(report::escape_with_code("use `a <b>` or `c`, not d`") ==
        "use <code>a &lt;b&gt;</code> or <code>c</code>, not d`");
}
