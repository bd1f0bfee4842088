/// glidelab explore.
#include <cmath>
#include <numbers>
#include <random>

#include "base/files/file_io.h"
#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"
#include "sim/oracle/closed_forms.h"
#include "teach/page/teaching_pages.h"
#include "tests/app/opened_page.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr double kGravity = 9.80665;

/// As the page's sliders stand.
struct Setting {
  int law;  ///< 0 viscous, 1 power 3/2, 2 quadratic, 3 none
  double k, mu, alpha_deg, v0_m_s, t_s;
};

/// The same motion by other means: closed forms, and for the power law the equation of motion itself, solved whole.
sim::State expected(const Setting& s) {
  const double incline = s.alpha_deg * std::numbers::pi / 180.0;
  const sim::DryTrack track = sim::dry_track(incline, s.mu, s.mu, kGravity);
  if (s.law == 2) return sim::quadratic_coulomb_motion(track, s.k, 0.0, s.v0_m_s, s.t_s);
  if (s.law != 1) return sim::viscous_coulomb_motion(track, s.law == 0 ? s.k : 0.0, 0.0, s.v0_m_s, s.t_s);
  sim::Body body{1.0, incline, kGravity, {}};
  body.forces.push_back(sim::laws::power_law().with({s.k, 1.5}));
  body.forces.push_back(sim::laws::coulomb().with({s.mu}));
  return sim::simulate(body, 0.0, s.v0_m_s, std::vector<double>{s.t_s}).states.front();
}

/// Places of the sliders, drawn; every second one with the drag's slider in its lowest hundredth, where scales are
/// largest.
std::vector<Setting> settings(int count) {
  std::mt19937_64 random(20260723);
  const auto step = [&](int low, int high) {
    return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<Setting> drawn;
  for (int i = 0; i < count; ++i) {
    // The power law's oracle takes the longest: one in ten.
    const int law = i % 10 == 9 ? 1 : i % 3 == 1 ? 3 : i % 3;
    drawn.push_back({law, step(1, i % 2 == 0 ? 5 : 500) / 100.0, step(0, 300) / 1e4, step(-40, 80) / 10.0,
                     step(-200, 200) / 100.0, step(1, 500) / 100.0});
  }
  return drawn;
}

std::string page_html() {
  static const std::string html = teach::explorer_page(teach::explore_phases()).html;
  return html;
}

}  // namespace

TEST_CASE("the explorer's page stands alone, and its script agrees with the program's solver") {
  const tests::TempDir temp;
  const tests::ProcessResult made = tests::glidelab({"explore", "-q", "-o", "page"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  const std::string page = base::read_file(temp / "page/explore.html");
  CHECK(page.find("http:") == std::string::npos);
  CHECK(page.find("https:") == std::string::npos);
  for (const char* number : {"[nan", ",nan", ":nan", "-nan"}) CHECK(page.find(number) == std::string::npos);
  // The page measures itself against the solver's motions when it is opened; a browser is needed to see by how much.
  const auto opened = tests::open_page(temp / "page/explore.html");
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened->messages.find("CONSOLE") == std::string::npos);
  // As in the next test.
  CHECK(std::stod(opened->data.at("off-x")) < 1e-6);
  CHECK(std::stod(opened->data.at("off-v")) < 1e-6);
  CHECK(std::stod(opened->data.at("off-a")) < 1e-5);
}

TEST_CASE("wherever the explorer's sliders stand, x, v and a are those of the closed forms") {
  const tests::TempDir temp;
  std::string script = "const asked = [";
  for (const Setting& s : settings(6000)) {
    const sim::State state = expected(s);
    script += fmt::format("[{},{},{},{},{},{},{:.17g},{:.17g},{:.17g}],\n", s.law, s.k, s.mu, s.alpha_deg, s.v0_m_s,
                          s.t_s, state.x_m, state.v_m_s, state.a_m_s2);
  }
  script += R"js(];
const worst = { x: [0], v: [0], a: [0] };
for (const [law, k, mu, alpha, v0, t, x, v, a] of asked) {
  const here = motion({ law, k: law === 3 ? 0 : k, mu, alpha, v0 }).at(t), there = { x, v, a };
  for (const q of ['x', 'v', 'a']) {
    const off = Math.abs(here[q] - there[q]);
    if (!(off <= worst[q][0])) worst[q] = [off, law, k, mu, alpha, v0, t];
  }
}
for (const q of ['x', 'v', 'a']) document.documentElement.dataset['worst' + q] = worst[q].join(' ');
)js";
  const auto opened = tests::open_with(temp.path(), page_html(), script);
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  // Polynomials of fifth order through points h = 0.1 of the time apart in which u changes by itself leave h^6 / 46080
  // = 2e-11 of its sixth derivative (of 300 at most, tanh's) in u, h times that in a distance within one piece, and
  // some h^5 / 2000 in du/dtau: scaled by 140 m/s, 2e4 m and 2 m/s² below the tens that are allowed here.
  for (const auto& [name, allowed] : {std::pair{"worstx", 1e-6}, {"worstv", 1e-6}, {"worsta", 1e-5}}) {
    INFO(name << " law k mu alpha v0 t " << opened->data.at(name));
    CHECK(std::stod(opened->data.at(name)) < allowed);
  }
}

TEST_CASE("the explorer says what becomes of a motion: held, stopped, ever slower, on for ever, or to its limit") {
  const tests::TempDir temp;
  // Law (0 viscous, 2 quadratic, 3 none), k, mu, alpha, v0: what is said, what is not, and whether there is one
  // equilibrium.
  struct Case {
    const char *p, *said, *unsaid;
    bool equilibrium;
  };
  const std::vector<Case> cases = {
      {"3,0,0,0,-2", "keeps its speed for ever", "rest", false},
      {"0,0,0,0,-2", "keeps its speed for ever", "rest", false},  // a viscous drag of nothing
      {"0,0,0,0,0", "at rest, and nothing drives it", "comes to rest", false},
      {"2,1,0,0,1", "tends to rest", "comes to rest", true},
      {"0,1,0,0,0", "at rest, and nothing drives it", "tends", true},
      {"0,1,0.01,0,0", "at rest and stays there: nothing pulls it", "comes to rest", true},
      {"0,1,0.03,1,0", "at rest and stays there: the slope pulls", "comes to rest", true},
      {"3,0,0.01,0,0.5", "comes to rest at t = 5.099 s", "for ever", true},     // v0 / (mu g)
      {"3,0,0,2,-1", "It turns at t = 2.922 s. Without drag", "jumps", false},  // v0 / (g sin alpha)
      {"0,2,0,0.5,0", "tends to v = 0.0428 m/s", "turns", true}};               // g sin(alpha) / k
  std::string script = "const said = [], dots = [];\nfor (const [law, k, mu, alpha, v0] of [";
  for (const Case& c : cases) script += fmt::format("[{}],", c.p);
  script += R"js(]) {
  $('law').value = law; $('k').value = k; $('mu').value = mu; $('alpha').value = alpha; $('v0').value = v0;
  change(); said.push($('readout').textContent); dots.push(current.m.limit === null ? 0 : 1);
}
document.documentElement.dataset.said = said.join('|'); document.documentElement.dataset.dots = dots.join('');
)js";
  const auto opened = tests::open_with(temp.path(), page_html(), script);
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  std::string all = opened->data.at("said");
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string said = all.substr(0, all.find('|'));
    all.erase(0, std::min(all.size(), said.size() + 1));
    INFO(cases[i].p << ": " << said);
    CHECK(said.find(cases[i].said) != std::string::npos);
    CHECK(said.find(cases[i].unsaid) == std::string::npos);
    CHECK((opened->data.at("dots").at(i) == '1') == cases[i].equilibrium);
  }
}

TEST_CASE("in class and on a telephone the explorer's sliders, its three plots and its time are seen at once") {
  const tests::TempDir temp;
  const std::string script = R"js(
const boxes = ['xt', 'vt', 'av', 'timebar'].map(id => $(id).getBoundingClientRect());
document.documentElement.dataset.seen = boxes.filter(b => b.top >= 0 && b.bottom <= innerHeight && b.right <= innerWidth).length;
document.documentElement.dataset.rows = new Set(boxes.slice(0, 3).map(b => b.top)).size;
document.documentElement.dataset.sliders = ['k', 'mu', 'alpha', 'v0'].filter(id => $(id).getBoundingClientRect().bottom < boxes[0].top).length;
document.documentElement.dataset.wide = document.documentElement.scrollWidth - innerWidth;
document.documentElement.dataset.time = boxes[3].bottom - innerHeight;
let covered = 0;  // of the words, by the bar below them
for (const law of [0, 1, 2, 3]) for (const mu of [0, 0.03]) for (const alpha of [-4, 1.5, 8]) for (const v0 of [-2, 0, 2]) {
  $('law').value = law; $('mu').value = mu; $('alpha').value = alpha; $('v0').value = v0; change();
  covered = Math.max(covered, $('readout').getBoundingClientRect().bottom - $('timebar').getBoundingClientRect().top);
}
document.documentElement.dataset.covered = covered;
)js";
  for (const auto& [width, height] : {std::pair{1280, 720}, {1280, 1500}, {1920, 1080}}) {
    const auto opened = tests::open_with(temp.path(), page_html(), script, width, height);
    if (!opened) {
      WARN("skipped: no chromium program");
      return;
    }
    INFO(width << " x " << height);
    CHECK(opened->data.at("seen") == "4");
    CHECK(opened->data.at("rows") == "1");
    CHECK(std::stod(opened->data.at("covered")) < 1.0);
  }
  for (const int height : {700, 800, 1000}) {
    const auto narrow = tests::open_with(temp.path(), page_html(), script, 500, height);
    REQUIRE(narrow);
    INFO("500 x " << height);
    CHECK(narrow->data.at("seen") == "4");
    CHECK(narrow->data.at("rows") == "2");  // a(v) has one of its own
    CHECK(narrow->data.at("sliders") == "4");
    CHECK(std::stod(narrow->data.at("wide")) <= 0.0);
    CHECK(std::abs(std::stod(narrow->data.at("time"))) < 1.0);  // at the window's foot, the words are below it
  }
}
