/// One everyday experiment with a known truth: one cause, two, none or one outside the list, plus several small
/// imperfections (everyday_imperfections.h).
///
/// Drawn from (seed, index) alone. Of 100 cases, 50 have one cause, 20 two, 15 only imperfections ("dirt" in files), 15
/// a cause outside the list. The causes produce an excess of the squared gap (blind_strength.h: g² - 1 of held-out
/// clips, without noise) of 1.5 to 4 in moderate cases and 4 to 40 in strong ones. With X(L) that excess for a law L
/// that contains the named causes,
///
///     share of cause i = (X(causes before i) - X(those and i)) / X(nominal),      the main cause first,
///     their share      = X(all causes) / X(nominal),                              between 0.02 and 0.30.
///
/// The second of two causes has a share of a quarter or more. Imperfections alone are as large as they would be next to
/// a cause.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/everyday_imperfections.h"
#include "validate/blind/case/everyday_law.h"

namespace glidelab::validate {

enum class EverydayClass { one, two, imperfect, outside };
inline constexpr EverydayClass kEverydayClasses[] = {EverydayClass::one, EverydayClass::two, EverydayClass::imperfect,
                                                     EverydayClass::outside};

/// "one", "two", "dirt", "outside".
std::string_view word(EverydayClass kind);

inline constexpr double kLeastImperfections = 0.02, kMostImperfections = 0.30;  ///< share of the excess
inline constexpr double kLeastSecond = 0.25;                                    ///< share of the second of two causes
inline constexpr double kModerateExcess = 1.5, kStrongExcess = 4.0;             ///< of a position's squared gap

struct ActingImperfection {
  std::string id;
  double size = 0.0;
  std::string unit;
  double excess = 0.0;               ///< when acting alone, assumed to grow as the square of its size
  std::vector<std::string> effects;  ///< acceptable names for it
};

struct EverydayTruth {
  EverydayClass kind = EverydayClass::imperfect;
  bool strong = false;
  double excess = 0.0;                           ///< g² - 1 of the nominal law, of everything that acts
  std::vector<double> shares;                    ///< of the causes, the main one first
  double remainder = 1.0;                        ///< the imperfections'
  std::vector<std::vector<std::string>> equals;  ///< of each cause: other ids that give the same law here
  std::vector<ActingImperfection> imperfections;
  std::vector<EverydayConfiguration> configurations;
};

struct EverydayCase : BlindCase {
  EverydayTruth truth;
  EverydayNoise noise;
};

struct EverydayDraw {
  std::string only;                 ///< an effect that every case has; empty: all classes
  std::function<void()> look = {};  ///< as in BlindDraw
};

/// The class of a case, without making it.
EverydayClass everyday_class(std::uint64_t seed, std::size_t index);

/// NumericalError if none of many designs shows the wanted causes.
EverydayCase make_everyday_case(std::uint64_t seed, std::size_t index, const EverydayDraw& draw = {});

/// 4 to 12 clips at 25 to 240 Hz on up to 2.6 m of track, noise of 0.05 to 1.5 mm, one to three masses, one or two
/// inclinations, launched both ways.
BlindDesign draw_everyday_design(BlindRandom& random);

/// truth_of(), shares, imperfections, noise, and what is true of each configuration.
std::string everyday_truth_json(const EverydayCase& one);

}  // namespace glidelab::validate
