/// Why the data do not determine a quantity: one struct for each reason, with its numbers. report/text/why_words.h puts
/// it into words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>
#include "core/result/analysis_note.h"

namespace glidelab::core {

enum class LeftOut;  // core/result/results.h

namespace unknown {

/// In the words of an estimator written elsewhere, or of the error that ended an analysis.
struct Told {
  std::string text;
};

// From the lines of the phase diagram.

/// Neither direction has a line.
struct NoLine {
  std::size_t positions = 0;                                ///< measured, in all clips; 0 if not counted
  std::vector<std::pair<LeftOut, std::size_t>> left_out{};  ///< how many of them for which reason, the most first
};

/// The terminal velocity follows from the line for v > 0.
struct NoDownhillLine {};

/// There are points, but their speed changes by too little to show a slope.
struct SpeedHardlyChanges {};

/// mu and alpha follow from the lines of both directions; mu also from one line, where the inclination is known.
struct NotBothLines {
  bool minus = false, plus = false;  ///< those that are missing
  bool incline_would_do = false;     ///< the inclination with its uncertainty would give mu
};

/// The mean of the lines' a0 exceeds gravity.
struct MeanBeyondGravity {
  double mean_m_s2 = 0.0;
};

// The terminal velocity a0/(K/m) requires both above zero.

struct RateNotPositive {
  bool of_line = false;  ///< for v > 0; otherwise of the whole motion
};

struct InterceptNotPositive {};

// From the fit of the whole motion.

struct NoFreeMotion {};

/// The fit does not converge, or the motion does not determine its parameters.
struct NoFit {};

/// Motion in one direction determines g (sin(alpha) -+ mu cos(alpha)) alone.
struct OneDirection {
  int direction = 0;
  double a0_m_s2 = 0.0, sd_m_s2 = 0.0;
  bool incline_would_do = false;  ///< as above
};

struct NoDownhillMotion {};

/// The acceleration without friction exceeds gravity.
struct DriveBeyondGravity {};

// From an estimator written elsewhere.

/// It gave no value and no reason.
struct NotTold {};

/// Its results lack the configuration.
struct NotAnswered {};

// From a plumb line.

/// The marker does not move, so its line is unknown.
struct NoLineOfMotion {};

// From a diagnosis.

/// The motions do not separate it from the other quantities.
struct NotToldApart {};

/// The fit with the named causes stopped before it reached a minimum.
struct NoMinimum {};

/// The fit stopped at the largest or smallest value that is allowed, so that nothing is known of its uncertainty.
struct AtItsLimit {};

/// The likely explanations give values that differ too much.
struct ExplanationsDiffer {};

/// A fall has no normal force, and so no friction.
struct FreeFall {};

/// The forces balance at no speed downhill below 1000 m/s, the fastest that is looked for.
struct NoBalance {};

/// A body that falls through air: its drag grows with the square of the speed.
struct DragNotViscous {};

/// A table of lines does not state how they were smoothed.
struct KernelNotStated {};

}  // namespace unknown

using AnyReason = std::variant<unknown::Told, unknown::NoLine, unknown::NoDownhillLine, unknown::SpeedHardlyChanges,
                               unknown::NotBothLines, unknown::MeanBeyondGravity, unknown::RateNotPositive,
                               unknown::InterceptNotPositive, unknown::NoFreeMotion, unknown::NoFit,
                               unknown::OneDirection, unknown::NoDownhillMotion, unknown::DriveBeyondGravity,
                               unknown::NotTold, unknown::NotAnswered, unknown::NoLineOfMotion, unknown::NotToldApart,
                               unknown::NoMinimum, unknown::AtItsLimit, unknown::ExplanationsDiffer, unknown::FreeFall,
                               unknown::NoBalance, unknown::DragNotViscous, unknown::KernelNotStated>;

/// A clip whose motion in a direction without a line is attributed to the hand.
struct ClipAgainstLaunch {
  std::string clip;
  AgainstLaunch motion;
};

struct WhyUnknown {
  AnyReason reason;
  std::vector<ClipAgainstLaunch> against_launch = {};  ///< of these clips, if that is why a line is missing
};

}  // namespace glidelab::core
