#include "teach/study/law_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "base/files/staged_output.h"
#include "render/scenario/scenario.h"
#include "sim/motion/simulate.h"
#include "sim/motion/true_parameters.h"

namespace glidelab::teach {
namespace {

std::string leading_comment(const std::string& toml) {
  std::istringstream lines(toml);
  std::string text;
  for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
    const std::size_t from = line.find_first_not_of("# ");
    if (from == std::string::npos) continue;
    if (line.find("glidelab ") == from) break;  // how to run it
    if (!text.empty()) text += ' ';
    text.append(line, from);
  }
  return text;
}

LawMotion motion_of(const sim::ConfigurationSetup& configuration, const sim::MotionSetup& motion) {
  LawMotion result;
  result.clip = motion.name;
  result.configuration = configuration.name;
  const auto steps = static_cast<std::size_t>(std::floor(motion.duration_s * kFramesPerSecond + 1e-9));
  for (std::size_t i = 0; i <= steps; ++i) result.t_s.push_back(static_cast<double>(i) / kFramesPerSecond);
  for (const sim::State& state : sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, result.t_s).states) {
    result.x_m.push_back(state.x_m);
    result.v_m_s.push_back(state.v_m_s);
    result.a_m_s2.push_back(state.a_m_s2);
  }
  return result;
}

double acceleration(const sim::Body& body, double v_m_s, int direction) {
  return sim::net_force_n(body, v_m_s, direction) / body.mass_kg;
}

LawCurve curve_of(const sim::ConfigurationSetup& configuration, double lowest, double highest) {
  constexpr int kPoints = 200;
  LawCurve curve;
  curve.configuration = configuration.name;
  curve.incline_deg = configuration.body.incline_rad * 180.0 / std::numbers::pi;
  if (const auto v_lim = sim::limit_speed_m_s(configuration.body)) highest = std::max(highest, 1.05 * *v_lim);
  // Denser near v = 0, where the laws differ.
  for (int i = 0; i <= kPoints; ++i) {
    const double part = static_cast<double>(i) / kPoints, dense = part * part;
    if (lowest < 0.0) {
      const double v = lowest * (1.0 - part) * (1.0 - part);
      curve.up_v_m_s.push_back(v);
      curve.up_a_m_s2.push_back(acceleration(configuration.body, v, -1));
    }
    if (highest > 0.0) {
      curve.down_v_m_s.push_back(highest * dense);
      curve.down_a_m_s2.push_back(acceleration(configuration.body, highest * dense, 1));
    }
  }
  curve.equilibria = equilibria(configuration.body, lowest, highest);
  return curve;
}

double at(const std::vector<double>& x, const std::vector<double>& y, double where) {
  const auto above = std::lower_bound(x.begin(), x.end(), where);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(above - x.begin());
  const double part = (where - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + part * (y[i] - y[i - 1]);
}

double largest_difference(const std::vector<double>& x1, const std::vector<double>& y1, const std::vector<double>& x2,
                          const std::vector<double>& y2) {
  double largest = 0.0;
  for (std::size_t i = 0; i < x1.size(); ++i) largest = std::max(largest, std::abs(y1[i] - at(x2, y2, x1[i])));
  return largest;
}

}  // namespace

LawStudy study_law(const std::filesystem::path& path) {
  const std::string toml = base::read_file(path);
  const render::Scenario scenario = render::read_scenario(toml, path, render::ScenarioChecks::values);
  LawStudy study;
  study.name = scenario.motion.name;
  study.text = leading_comment(toml);
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    std::vector<std::size_t> motions;
    double lowest = 0.0, highest = 0.0;
    for (const sim::MotionSetup& motion : configuration.motions) {
      motions.push_back(study.motions.size());
      study.motions.push_back(motion_of(configuration, motion));
      const std::vector<double>& v = study.motions.back().v_m_s;
      lowest = std::min(lowest, *std::min_element(v.begin(), v.end()));
      highest = std::max(highest, *std::max_element(v.begin(), v.end()));
    }
    study.curves.push_back(curve_of(configuration, lowest, highest));
    study.curves.back().motions = motions;
  }
  const std::vector<LawMotion>& two = study.motions;
  if (two.size() == 2 && study.curves.size() == 2 && two[0].t_s == two[1].t_s) {
    study.x_apart_m = largest_difference(two[0].t_s, two[0].x_m, two[1].t_s, two[1].x_m);
    const LawCurve &a = study.curves[0], &b = study.curves[1];
    if (!a.down_v_m_s.empty() && !b.down_v_m_s.empty()) {
      // As far as both go.
      const double end = std::min(a.down_v_m_s.back(), b.down_v_m_s.back());
      double apart = 0.0;
      for (std::size_t i = 0; i < a.down_v_m_s.size() && a.down_v_m_s[i] <= end; ++i) {
        apart = std::max(apart, std::abs(a.down_a_m_s2[i] - at(b.down_v_m_s, b.down_a_m_s2, a.down_v_m_s[i])));
      }
      study.a_apart_m_s2 = apart;
    }
  }
  return study;
}

}  // namespace glidelab::teach
