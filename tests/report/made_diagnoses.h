/// Diagnoses made by hand, for tests of what is said and shown of a sequence of causes.
#pragma once

#include "diagnose/result/diagnosis.h"
#include "tests/report/made_results.h"

namespace glidelab::tests {

/// The gap after causes that leave this share of the excess: g_i = sqrt(1 + left (g²_0 - 1)).
inline double gap_with_left(double before, double left) {
  return std::sqrt(1.0 + left * (before * before - 1.0));
}

inline diagnose::RecoveredConfiguration made_recovered(const std::string& group, double mass_kg,
                                                       std::vector<std::string> with) {
  return {group,
          mass_kg,
          4.0,
          false,
          std::move(with),
          known(0.92 / mass_kg, 0.006),
          known(0.0071, 0.0001),
          known(4.311, 0.006),
          known(0.2413, 0.0004)};
}

/// Two masses, six clips; the gap of 5.3 falls by 91 % with quadratic drag and by 6 % with wheels; 3 % are left.
inline diagnose::Diagnosis two_causes() {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  of.points = 1056;
  of.none = 0.001;
  of.unknown = 0.02;
  of.stage = diagnose::Stage::dynamics;
  of.effects = {{"quadratic_drag",
                 diagnose::Stage::dynamics,
                 "a drag that grows with the square of the speed",
                 0.97,
                 {},
                 {{"c_kg_m", 0.0031, 0.0002}},
                 0.97,
                 {}},
                {"rotational_inertia",
                 diagnose::Stage::dynamics,
                 "wheels that turn",
                 0.81,
                 {},
                 {{"mass_kg", 0.0123, 0.0014}},
                 0.81,
                 {}}};
  of.ranking = {{{{"quadratic_drag", "rotational_inertia"}}, 0.79, 812.3, 830.0, 2, 1.35, {}},
                {{{"quadratic_drag"}}, 0.18, 770.1, 780.0, 1, 1.86, {}}};
  diagnose::GapSizes gap;
  gap.before = 5.3;
  gap.after = gap_with_left(5.3, 0.03);
  gap.standard_error = 0.04;
  gap.shrink = 0.92;
  gap.held_out = {"m1-up", "m1-down", "m2-up", "m2-down"};
  gap.before_by_clip = {5.1, 4.9, 6.0, 5.2};
  gap.after_by_clip = {1.2, 1.5, 1.4, 1.3};
  gap.interval95.before = {4.6, 6.0};
  gap.interval95.after = {1.1, 1.6};
  gap.interval95.shrink = {0.88, 0.95};
  gap.parameters = {{"k_n_s_m",
                     diagnose::Against::all_clips,
                     "0.335 kg",
                     -3.0,
                     0.4,
                     {{"k_n_s_m", 0.911234, 0.00001}},
                     {{"k_n_s_m", 0.941234, 0.0000077}}}};
  gap.domains = {{diagnose::GapDomainKind::positions, 5.3, gap.after}, {diagnose::GapDomainKind::parameters, 3.0, {}}};
  of.gap = gap;
  of.explained = {{"quadratic_drag", 0.91, diagnose::GapInterval{0.86, 0.95}, gap_with_left(5.3, 0.09)},
                  {"rotational_inertia", 0.06, diagnose::GapInterval{0.02, 0.1}, gap_with_left(5.3, 0.03)}};
  diagnose::GapRegion region{diagnose::GapVariable::time, 0.0, 0.1, 4.1, 1.2e-3, "N", diagnose::GapKind::force, ""};
  region.size_sd = 1e-4;
  region.at = 0.05;
  of.remainder = diagnose::GapRemainder{0.03, gap.after, 4.1e-3, 8e-4, 0.021, {region}};
  of.levels = diagnose::GapLevels{5.3, 5.28, 5.1, false};
  of.recovered = {made_recovered("slope", 0.335, {"quadratic_drag", "rotational_inertia"}),
                  made_recovered("slope", 0.435, {"quadratic_drag", "rotational_inertia"})};
  of.recovered.back().v_lim_m_s = {std::nullopt,
                                   core::WhyUnknown{core::unknown::Told{"the clips hold no motion downhill"}}};
  of.next = diagnose::Routine::start_later;
  of.residuals = {{"m1-up",
                   {0.0, 1.0, 2.0},
                   {0.0, 0.1, 0.3},
                   {1.0, 0.9, 0.2},
                   {2e-5, -2e-5, 1e-5},
                   {0.0, 0.0, 1e-6},
                   {1e-5, 1e-5, 1e-5}}};
  return of;
}

/// Friction of each configuration: the law holds within, and not across.
inline diagnose::Diagnosis law_within() {
  diagnose::Diagnosis of = two_causes();
  of.effects = {{"configuration_friction",
                 diagnose::Stage::dynamics,
                 "a friction of each configuration",
                 0.99,
                 {},
                 {{"sd", 0.0009, 0.0003}, {"mu.0.335 kg, 4°", 0.0071, 0.0001}, {"mu.0.435 kg, 4°", 0.0083, 0.0001}},
                 0.99,
                 {}}};
  of.explained = {{"configuration_friction", 0.998, diagnose::GapInterval{0.99, 1.0}, gap_with_left(5.3, 0.002)}};
  of.remainder = diagnose::GapRemainder{0.002, gap_with_left(5.3, 0.002), 0.0, 0.0, 0.0, {}};
  of.levels = diagnose::GapLevels{5.3, 1.02, 1.01, true};
  for (diagnose::RecoveredConfiguration& one : of.recovered) one.with = {"configuration_friction"};
  return of;
}

/// No cause takes half: uneven frame times a third, and the rest lies in one clip.
inline diagnose::Diagnosis no_half() {
  diagnose::Diagnosis of = two_causes();
  of.verdict = diagnose::Verdict::unknown;
  of.unknown = 0.98;
  of.effects.clear();
  of.explained = {{"timestamp_jitter", 0.31, diagnose::GapInterval{0.2, 0.42}, gap_with_left(5.3, 0.69)}};
  of.remainder->share = 0.69;
  of.remainder->gap = gap_with_left(5.3, 0.69);
  of.remainder->regions.front().clip = "m2-up";
  of.curves = {{diagnose::GapVariable::position,
                diagnose::GapKind::force,
                "N",
                40.0,
                {0.0, 0.1, 0.2},
                {0.001, 0.002, 0.001},
                {1e-4, 1e-4, 1e-4}}};
  for (diagnose::RecoveredConfiguration& one : of.recovered) one.with = {"timestamp_jitter"};
  return of;
}

/// Nothing that matters; uneven frame times show.
inline diagnose::Diagnosis traces_alone() {
  diagnose::Diagnosis of = two_causes();
  of.verdict = diagnose::Verdict::none;
  of.none = 0.2;
  of.unknown = 0.01;
  of.effects.clear();
  of.ranking = {{{{"timestamp_jitter"}}, 0.77, 4.1, 6.0, 1, 1.01, {}}};
  of.explained.clear();
  of.remainder.reset();
  of.levels.reset();
  of.traces = {"timestamp_jitter"};
  of.gap->before = of.gap->after = 1.01;
  of.gap->shrink.reset();
  of.gap->after_by_clip = of.gap->before_by_clip = {1.0, 1.02, 1.01, 1.01};
  of.gap->domains.clear();
  of.gap->parameters.clear();
  for (diagnose::RecoveredConfiguration& one : of.recovered) one.with.clear();
  return of;
}

}  // namespace glidelab::tests
