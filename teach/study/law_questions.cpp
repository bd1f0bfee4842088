#include "teach/study/law_questions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glidelab::teach {
namespace {

constexpr double kRounding = 1e-9;  // of differences of a (m/s²) or of slopes (1/s), whose values are of order one

}  // namespace

bool LawAnswers::flat() const {
  return std::abs(slope1_1_s) < kRounding && std::abs(slope2_1_s) < kRounding;
}

bool LawAnswers::straight() const {
  return std::abs(slope1_1_s - slope2_1_s) < kRounding * std::max(1.0, std::abs(slope1_1_s));
}

bool LawAnswers::jumps() const {
  return std::abs(jump_m_s2) > kRounding;
}

LawAnswers answers_of(const LawStudy& study) {
  LawAnswers answers;
  const LawCurve* chosen = nullptr;
  bool limited = false;
  for (const LawCurve& curve : study.curves) {
    if (limited || curve.down_v_m_s.empty()) continue;
    chosen = &curve;
    limited = std::ranges::any_of(curve.equilibria, [](const Equilibrium& at) { return at.v_m_s != 0.0; });
  }
  if (chosen == nullptr) throw std::logic_error("no motion downhill to ask about");
  answers.curve = static_cast<std::size_t>(chosen - study.curves.data());
  const double fastest = chosen->down_v_m_s.back();
  const double power = std::pow(10.0, std::floor(std::log10(fastest / 2.0)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (times * power <= fastest / 2.0 * (1.0 + kRounding)) answers.v1_m_s = times * power;
  }
  answers.v2_m_s = 2.0 * answers.v1_m_s;
  const sim::Body& body = chosen->body;
  const auto a = [&](double v, int direction) { return sim::net_force_n(body, v, direction) / body.mass_kg; };
  answers.slope1_1_s = (a(answers.v1_m_s, 1) - a(0.0, 1)) / answers.v1_m_s;
  answers.slope2_1_s = (a(answers.v2_m_s, 1) - a(answers.v1_m_s, 1)) / answers.v1_m_s;
  answers.jump_m_s2 = a(0.0, -1) - a(0.0, 1);
  answers.mu = answers.jump_m_s2 / (2.0 * body.gravity_m_s2 * std::cos(body.incline_rad));
  const sim::Contact contact = sim::contact_of(body);
  answers.mu_varies = std::ranges::any_of(body.forces, [&](const auto& force) {
    const double dry_n = force->force_n(0.0, 1, contact);
    return dry_n != 0.0 && std::abs(force->force_n(answers.v2_m_s, 1, contact) - dry_n) > kRounding * std::abs(dry_n);
  });
  return answers;
}

LawCurve in_both_directions(LawCurve curve) {
  const auto mirror = [&](const std::vector<double>& from, std::vector<double>& v, std::vector<double>& a,
                          int direction) {
    for (const double speed : from) {
      v.push_back(-0.5 * speed);
      a.push_back(sim::net_force_n(curve.body, v.back(), direction) / curve.body.mass_kg);
    }
  };
  if (curve.up_v_m_s.empty()) mirror(curve.down_v_m_s, curve.up_v_m_s, curve.up_a_m_s2, -1);
  if (curve.down_v_m_s.empty()) mirror(curve.up_v_m_s, curve.down_v_m_s, curve.down_a_m_s2, 1);
  return curve;
}

}  // namespace glidelab::teach
