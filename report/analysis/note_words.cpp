#include "report/analysis/note_words.h"

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <variant>
#include "base/text/number_text.h"
#include "core/result/results.h"
#include "report/analysis/row_words.h"
#include "report/analysis/statement_words.h"
#include "report/text/why_words.h"

namespace glidelab::report {

namespace {

const char* sign_of(int direction) {
  return direction > 0 ? ">" : "<";
}

/// A sentence for every kind; a kind without one does not compile.
struct AnalysisSentence {
  std::string operator()(const core::FilesSkipped& of) const {
    if (of.files == 1) return "one file in the folder of frames is not an image and is skipped";
    return fmt::format("{} files in the folder of frames are not images and are skipped", of.files);
  }
  std::string operator()(const core::ContainerOfOtherRate& of) const {
    return fmt::format(
        "the container states {:.6g} frames per second, experiment.toml {:.6g}; {}", of.container_hz, of.stated_hz,
        of.by_rate ? "the rate in experiment.toml is used" : "the container's time stamps are used, as requested");
  }
  std::string operator()(const core::LastFramesUnstamped&) const {
    return "the last frames have no time stamp and are left out";
  }
  std::string operator()(const core::IrregularStamps& of) const {
    return fmt::format(
        "the container's time stamps are irregular: {} of {} steps differ from the median step of {:.4g} ms, the "
        "longest is {:.4g} ms{}",
        of.irregular, of.steps, of.median_step_s * 1e3, of.longest_step_s * 1e3,
        of.by_rate ? " (frames may be missing; the rate in experiment.toml is used)" : "");
  }
  std::string operator()(const core::RepeatedFrames& of) const {
    return fmt::format(
        "{} of {} frames are identical to the frame before: repeats, or a scene at rest without any noise", of.repeated,
        of.frames);
  }
  std::string operator()(const core::RepeatsLeftOut& of) const {
    const std::string times =
        of.camera_hz > 0.0
            ? fmt::format("a converter added them, and the camera's {:.4g} Hz time the others", of.camera_hz)
        : of.in_place_of_lost ? "they fill in for lost frames, so the other times are right"
                              : "the others may be late by a frame";
    return fmt::format("{} of {} frames repeat the one before and are left out: {}", of.repeats, of.frames, times);
  }
  std::string operator()(const core::InterlacedFilm& of) const {
    return fmt::format(
        "the film is interlaced: odd and even rows of a frame are half a frame apart, so positions err; make one frame "
        "of each field (ffmpeg -vf bwdif) and state frame_rate_hz = {:.6g}",
        2.0 * of.frame_rate_hz);
  }
  std::string operator()(const core::EvenStamps& of) const {
    return fmt::format(
        "the container's time stamps are whole multiples of {:.4g} ms, and frames evenly spaced by {:.6g} ms (to "
        "{:.0f} ppm) explain them all: those times are used",
        of.tick_s * 1e3, of.step_s * 1e3, std::ceil(of.half_width_s / of.step_s * 1e6));
  }

  std::string operator()(const core::SheetTaken& of) const {
    return fmt::format("the table is taken from sheet \"{}\"", of.sheet);
  }
  std::string operator()(const core::ColumnsTaken& of) const {
    return fmt::format("x is \"{}\", its time \"{}\"{}{}", of.x, of.t, of.run.empty() ? "" : ", ", of.run);
  }
  std::string operator()(const core::UnitAssumed& of) const {
    return fmt::format("\"{}\" states no unit and is taken as {}", of.column, of.unit);
  }
  std::string operator()(const core::HeightTaken& of) const {
    return fmt::format("x is \"{}\", a height: state an inclination of 90° if this is a fall (--incline 90)",
                       of.column);
  }
  std::string operator()(const core::ForceUnused& of) const {
    return fmt::format(
        "\"{}\" is not used. To use a force along x, put it in the column force_n of a table with the header "
        "t_s,x_m,force_n",
        of.column);
  }
  std::string operator()(const core::MotionAlongY& of) const {
    return fmt::format("y covers {:.3g} m and x only {:.2g} m: the motion is taken along y (--column says otherwise)",
                       of.y_m, of.x_m);
  }
  std::string operator()(const core::SlantedPath& of) const {
    return fmt::format(
        "the path makes an angle of {0:.1f}° with the {1} axis; positions are taken along the path, from x and y, and "
        "distances are {2:.3g} times those along {1}. If the axes are level, this is the inclination (--incline "
        "{3:.1f}, or -{3:.1f} where x increases uphill)",
        of.off_deg, of.along_y ? "y" : "x", of.stretch, of.along_y ? 90.0 - of.off_deg : of.off_deg);
  }
  std::string operator()(const core::CountedAlongMotion&) const {
    return "x is counted along the motion, so its sign is reversed";
  }
  std::string operator()(const core::RowsIncomplete& of) const { return row_words(of); }
  std::string operator()(const core::TimesRepeated& of) const { return row_words(of); }
  std::string operator()(const core::ValuesHeld& of) const { return row_words(of); }
  std::string operator()(const core::UnlikelyLeftOut& of) const { return row_words(of); }
  std::string operator()(const core::ImageUnitsTaken& of) const {
    std::string text;
    if (of.frame_rate_hz > 0.0)
      text = fmt::format("the times are frame numbers, at {:.6g} frames a second", of.frame_rate_hz);
    if (of.px_per_m == 0.0) return text;
    return fmt::format("{}{}x is in pixels, {:.6g} of them to a metre{}", text, text.empty() ? "" : "; ", of.px_per_m,
                       of.exact_scale ? ", taken as exact; no lens is corrected" : "; no lens is corrected");
  }
  std::string operator()(const core::PositionsUnseen& of) const {
    return fmt::format(
        "{} positions that are all {:.6g} m, from {:.6g} s on, are left out: no motion leads there, and a sensor or a "
        "tracker writes one value while it sees nothing",
        of.positions, of.value_m + 0.0, of.from_s);  // no "-0"
  }
  std::string operator()(const core::PositionsScattered& of) const {
    const std::size_t all = of.at_start + of.at_end;
    const std::string where = of.at_end == 0 ? "the start"
                              : of.at_start == 0
                                  ? "the end"
                                  : fmt::format("the start ({}) and the end ({})", of.at_start, of.at_end);
    return fmt::format(
        "{} position{} at {} {} left out: they jump to and fro as no body does, and as a tracker writes them where it "
        "has not found the body",
        all, all == 1 ? "" : "s", where, all == 1 ? "is" : "are");
  }
  std::string operator()(const core::PositionsAstray& of) const {
    const bool one = of.positions == 1;
    return fmt::format(
        "{} position{} {:.6g} s {} left out: the path jumps to {} by up to {:.3g} m, as when a motion sensor hears "
        "another object",
        of.positions, one ? " at" : "s from", of.from_s, one ? "is" : "on are", one ? "it" : "them", of.off_m);
  }
  std::string operator()(const core::ColumnsGuessed& of) const {
    return fmt::format(
        "the table has no header: \"{}\" is taken as the time{} and \"{}\" as x. Name the columns t and x in a first "
        "line, or state which one is x (--column)",
        of.t, of.either ? ", which another column could be as well," : ", because it alone increases throughout,",
        of.x);
  }
  std::string operator()(const core::OtherAxisUnused& of) const {
    return fmt::format(
        "\"{}\" is not used: this column was requested alone. Together the two give a path at {:.1f}° to this axis "
        "that "
        "departs from a straight line by {:.2g} m, so distances along the motion are longer",
        of.column, of.off_deg, of.off_m);
  }
  std::string operator()(const core::PathBends& of) const {
    return fmt::format(
        "the path in x and y is not straight: it leaves its line by {:.2g} m, and its direction changes by {:.1f}°. "
        "On "
        "a bent track gravity along the motion changes, which looks like a drag or a friction that depends on the "
        "place",
        of.off_m, of.slope_deg);
  }
  std::string operator()(const core::RoundedTimes& of) const {
    return fmt::format("the times are whole multiples of {:.2g} s and taken as even, {:.4g} s apart", of.tick_s,
                       of.step_s);
  }

  std::string operator()(const core::NoLengthUnit&) const {
    return "the project states no unit of length: metres are assumed";
  }
  std::string operator()(const core::PointMassTaken& of) const {
    return fmt::format("x is the {} of point mass \"{}\" in the project's axes, positive towards {}{}",
                       of.along_y ? "Y" : "X", of.mass, of.towards,
                       of.as_stated ? ""
                       : of.along_y ? ": it moves most along Y, and that is down in the image"
                                    : ": it moves most along X, and downhill is not stated");
  }
  std::string operator()(const core::MassMovesAslant& of) const {
    return fmt::format(
        "the mass moves along a line that makes {:.0f} degrees with {}, so x is {:.1f} % short: turn the axes in "
        "Tracker to lie along the motion",
        of.off_deg, of.along_y ? "Y" : "X", 100.0 * of.short_by);
  }
  std::string operator()(const core::PositionsOutsideClip& of) const {
    if (of.positions == 1) return "one position that is not among the steps of the project's clip is left out";
    return fmt::format("{} positions that are not among the steps of the project's clip are left out", of.positions);
  }
  std::string operator()(const core::PositionsFilledIn& of) const {
    if (of.positions == 1) {
      return "one position that Tracker filled in on a straight line between two marks is left out";
    }
    return fmt::format("{} positions that Tracker filled in on a straight line between two marks are left out",
                       of.positions);
  }

  std::string operator()(const core::AssumedStatements& of) const {
    const std::string mass = fmt::format("a mass of {:g} kg", of.mass_kg.value_or(0.0));
    const std::string level = "an inclination of 0°";
    const bool both = of.mass_kg && of.level;
    return fmt::format(
        "{} assumed, because neither the file nor an option states {} ({}). K/m, µ and α do not depend on {}",
        both ? mass + " and " + level + " are" : (of.mass_kg ? mass : level) + " is", both ? "them" : "it",
        both ? "--mass, --incline" : (of.mass_kg ? "--mass" : "--incline"), both ? "them" : "it");
  }
  std::string operator()(const core::MayBeAFall& of) const {
    return fmt::format(
        "A hand seems to hold the body in {} positions, yet it accelerates at {:.2g} m/s² there, as in a fall. If it "
        "falls, state an inclination of 90° (--incline 90)",
        of.positions, of.a_m_s2);
  }
  std::string operator()(const core::AssumedMass&) const {
    return "no mass is stated: 1 kg is assumed (K/m, µ and α do not depend on it)";
  }

  std::string operator()(const core::OutlyingView& of) const {
    return fmt::format("{} departs from the fitted camera by {:.3g} px and is {}", of.file, of.error_px,
                       of.left_out ? "left out" : "kept, because fewer than three views would be left");
  }
  std::string operator()(const core::NoPatternInSight& of) const {
    return fmt::format("no pattern is visible in {}", fmt::join(of.files, ", "));
  }
  std::string operator()(const core::UnrefinedCorners& of) const {
    if (of.corners == 1) return "one corner could not be refined and keeps the detector's position";
    return fmt::format("{} corners could not be refined and keep the detector's position", of.corners);
  }
  std::string operator()(const core::CornersErrTogether& of) const {
    return fmt::format(
        "neighbouring corners share an error of {:.2g} px (each has {:.2g} px of its own): the pattern is bent, or the "
        "model does not describe the lens; the uncertainties allow for it",
        of.shared_px, of.own_px);
  }
  std::string operator()(const core::UncertainFocalLength& of) const {
    return fmt::format("the views hardly determine the focal length ({:.5g} px, sd {:.3g} px): tilt the pattern more",
                       of.focal_px, of.sd_px);
  }
  std::string operator()(const core::FisheyePreferred& of) const {
    return fmt::format(
        "the lens is modelled as a fisheye (equidistant): corners fit to {:.2g} px, to {:.2g} px with Brown-Conrady{}",
        of.rms_px, of.brown_conrady_rms_px,
        of.fewer_terms > 0 ? fmt::format(", which needs {} more terms for that", of.fewer_terms) : "");
  }
  std::string operator()(const core::PlaneViewsDisagree& of) const {
    const bool one = of.views == 1;
    return fmt::format(
        "the plane {} of group \"{}\" {} not agree with the camera: the pattern's corners lie {:.2g} px (rms) from "
        "where the camera and {} plane place them; their noise explains {:.2g} px",
        one ? "view" : "views", of.group, one ? "does" : "do", of.rms_px, one ? "a" : "one", of.expected_px);
  }

  std::string operator()(const core::MarkerAtRest&) const { return "the marker does not move in this clip"; }
  std::string operator()(const core::MarkerConcealed& of) const {
    return fmt::format("in {} frames the marker {} and counts as not seen", of.frames,
                       of.by == core::MarkerConcealed::By::similar
                           ? "cannot be distinguished from a similar object at rest"
                           : "is partly hidden or disturbed (its size or the residuals differ)");
  }
  std::string operator()(const core::MarkerMeasuredBy& of) const {
    using What = core::MarkerMeasuredBy::What;
    switch (of.what) {
      case What::centroid:
        return "the marker is not a disc; the centroid of its colour is used";
      case What::shading:
        return "the marker is lit from one side; its shading is fitted";
      case What::own_centre:
        return "the marker is neither a disc nor a sphere; its mean image over the clip is matched to each frame, and "
               "its centre is the point about which that image is unchanged by half a turn";
      case What::own_look:
        break;
    }
    return "the marker is neither a disc nor a sphere; it is tracked by its appearance in the other frames, and "
           "the origin of x may be off by a fraction of its diameter";
  }
  std::string operator()(const core::MarkerOfOtherSize& of) const {
    return fmt::format("the marker looks {:.0f} % {} than its diameter predicts", 100.0 * std::abs(of.ratio - 1.0),
                       of.ratio > 1.0 ? "larger" : "smaller");
  }
  std::string operator()(const core::MarkerFittedAgain& of) const {
    return fmt::format("the marker is fitted as a {} in front of {}: it is found in {} frames, in {} before",
                       of.sphere ? "sphere that is lit from one side" : "disc",
                       of.still_background ? "the background that other frames show" : "what moves with it", of.seen,
                       of.seen_before);
  }
  std::string operator()(const core::PixelsAnswerLeft& of) const {
    if (of.left_out) {
      return fmt::format(
          "the marker's positions are corrected for the response of the camera's pixels to an edge; {} of {} frames, "
          "in "
          "which the fit with that response fails, are left out",
          of.kept, of.sightings);
    }
    return fmt::format(
        "the marker's positions are not corrected for the response of the camera's pixels to an edge: in {} of {} "
        "frames the clip is too long for so large a marker, or the fit with that response fails",
        of.kept, of.sightings);
  }
  std::string operator()(const core::MarkerLost& of) const {
    std::vector<std::string> where;
    if (of.before > 0) where.push_back(fmt::format("the first {}", of.before));
    if (of.between > 0) where.push_back(fmt::format("{} between its sightings", of.between));
    if (of.after > 0) where.push_back(fmt::format("the last {}", of.after));
    return fmt::format("in {} of {} frames the marker is not found, though it is not at the edge of the image: {}",
                       of.before + of.between + of.after, of.frames, fmt::join(where, ", "));
  }
  std::string operator()(const core::DarkMarker&) const {
    return "the marker is darker than its surroundings; set color = \"#101010\" in [marker] to look for a dark one";
  }
  std::string operator()(const core::DiscMarker&) const {
    return "the marker is treated as a disc in the plane of motion, not as a sphere";
  }
  std::string operator()(const core::NotOfStatedSize& of) const {
    return "a marker of the stated diameter_m is not found: " + of.failure;
  }

  std::string operator()(const core::NoRay& of) const {
    return fmt::format("{} sightings lie where the lens model has no ray and are left out", of.sightings);
  }
  std::string operator()(const core::SlantedLine& of) const {
    return fmt::format("the line of motion makes {:.0f} degrees with the pattern's X axis", of.angle_deg);
  }
  std::string operator()(const core::ExactScale&) const {
    return "the scale is taken as exact (px_per_m_sd is 0 or not given)";
  }
  std::string operator()(const core::CodecDragSubtracted& of) const {
    return fmt::format(
        "the codec shifts the marker towards simple fractions of a pixel per frame, by {:.2g} px (root mean square). "
        "This shift is subtracted, and the intervals include its uncertainty",
        of.rms_px);
  }

  std::string operator()(const core::FramesMissing& of) const {
    constexpr std::size_t kNamed = 6;
    std::vector<std::string> places;
    for (const double t_s : of.after_s) places.push_back(fmt::format("{:.3f} s", t_s));
    const bool more = places.size() > kNamed;
    places.resize(std::min(places.size(), kNamed));
    return fmt::format(
        "{} frame{} missing without a gap in the times (after {}{}): the motion jumps there by the distance of whole "
        "frames; {}",
        of.frames, of.frames == 1 ? " is" : "s are", fmt::join(places, ", "), more ? ", …" : "",
        of.put_right ? "the later times are corrected" : "the times are left as they are");
  }
  std::string operator()(const core::OutliersLeftOut& of) const {
    return fmt::format("{} of {} positions are outliers and are left out", of.outliers, of.positions);
  }
  std::string operator()(const core::CorrelatedNoise& of) const {
    return fmt::format("the noise of neighbouring positions is correlated ({:.2f}); the intervals allow for it",
                       of.neighbours);
  }
  std::string operator()(const core::LineScatters& of) const {
    return fmt::format(
        "v {} 0: the points scatter {:.1f} times as much about the line as the noise explains; the intervals are "
        "widened",
        sign_of(of.direction), of.ratio);
  }
  std::string operator()(const core::NoiseGrowsWithSpeed& of) const {
    return fmt::format(
        "the noise of a position grows with the speed: {} mm at the slowest, {} mm at the fastest; the lines' "
        "intervals allow for it",
        base::digits_text(1e3 * of.slowest_m, 2), base::digits_text(1e3 * of.fastest_m, 2));
  }
  std::string operator()(const core::CoarseRounding& of) const {
    return fmt::format("positions are rounded to {:.3g} m and often repeat: {}", of.rounding_m,
                       of.instead_of_generalised
                           ? "the rounding error persists over frames, and generalised lines, which weight points by "
                             "the covariance of random noise, are not fitted; ordinary lines take their place"
                           : "the noise is not random");
  }
  std::string operator()(const core::GeneralisedLine& of) const {
    return fmt::format("v {} 0: the line is fitted to {} positions of free motion, up to its ends and reversals",
                       sign_of(of.direction), of.positions);
  }
  std::string operator()(const core::NoGeneralisedLine& of) const {
    return fmt::format("v {} 0: the generalised least squares did not converge; there is no line",
                       sign_of(of.direction));
  }
  std::string operator()(const core::AgainstLaunch& of) const { return launch_words(of); }

  std::string operator()(const core::MassInGrams& of) const {
    if (of.lightest_kg) {
      return fmt::format(
          "mass_kg = {:.6g}, but {:.6g} for the lightest glider: masses are in kilograms, and one of these looks like "
          "grams",
          of.mass_kg, *of.lightest_kg);
    }
    return fmt::format("mass_kg = {:.6g}: masses are in kilograms, and this one looks like grams ({:.6g} kg)",
                       of.mass_kg, of.mass_kg / 1000.0);
  }
  std::string operator()(const core::InclineContradiction& of) const {
    return fmt::format("{}: {} (glidelab check says more)", contradiction_words(of), contradiction_causes(of));
  }
  std::string operator()(const core::MuFromIncline& of) const {
    return fmt::format("motion in one direction: µ rests on the stated inclination, {}",
                       base::value_and_sd_text(of.deg, of.sd_deg) + "°");
  }
  std::string operator()(const core::GravityAssumed& of) const {
    return fmt::format(
        "µ and α are for gravity of {:.6g} m/s²; their ± includes {:.2g} m/s² ({:.2g} %). State its value at your "
        "place, to more digits or with its uncertainty (gravity_m_s2; for files --gravity)",
        of.gravity_m_s2, of.sd_m_s2, 100.0 * of.sd_m_s2 / of.gravity_m_s2);
  }
  std::string operator()(const core::NoRun& of) const { return of.found + "; " + of.advice; }
  std::string operator()(const core::SteadyFall& of) const {
    return fmt::format(
        "{} at a constant speed, which is the terminal velocity. Positions from before that speed is reached would "
        "give K/m as well",
        of.clips == 1 ? "the body falls" : fmt::format("in all {} clips the body falls", of.clips));
  }
  std::string operator()(const core::RobustFit& of) const {
    return fmt::format("robust: {} of {} positions are outliers and are left out", of.left_out, of.positions);
  }
  std::string operator()(const core::FitScatters& of) const {
    if (of.motions_differ) {
      return fmt::format(
          "the motions fitted together differ from one another by more than their noise explains: the intervals are "
          "those of fits without one motion after another ({:.0f} degrees of freedom)",
          of.degrees);
    }
    return fmt::format(
        "the positions scatter {} times as much about the fitted motion as their noise: the intervals are widened "
        "({:.0f} "
        "degrees of freedom)",
        base::number_text(of.ratio, 3), of.degrees);
  }
};

}  // namespace

std::string lens_words(const core::LensTerms& lens) {
  const std::string kept = fmt::format("{}", fmt::join(lens.kept, ", "));
  if (lens.fisheye) return "fisheye: " + (kept.empty() ? "no terms" : kept);
  std::vector<std::string> tests;
  for (const core::TermTest& test : lens.tests) {
    tests.push_back(
        fmt::format("{}: {} of {}", test.term, base::number_text(test.statistic, 3), base::number_text(test.limit, 3)));
  }
  return fmt::format("distortion: {} (χ² of each term tested, and the threshold to keep it: {})",
                     kept.empty() ? "none" : kept, fmt::join(tests, "; "));
}

std::string note_words(const core::Note& note) {
  return std::visit(AnalysisSentence{}, note);
}

std::vector<std::string> notes_words(const std::vector<core::Note>& notes) {
  std::vector<std::string> sentences;
  for (const core::Note& note : notes) sentences.push_back(note_words(note));
  return sentences;
}

namespace {

/// Words for every choice; a choice without them does not compile.
struct ChoiceSentence {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const core::chosen_by::User&) const { return "given"; }
  std::string operator()(const core::chosen_by::LinesRule& of) const {
    std::string text = fmt::format("least mean squared error of the lines ({:.1f} ms)", 1e3 * of.line_s);
    if (of.raised) {
      text += fmt::format(
          ", widened so that the points are less noisy (the noise of a is {} % of its spread; the lines are biased by "
          "{} %)",
          base::digits_text(100.0 * of.raised->noise_share, 2), base::digits_text(100.0 * of.raised->bias_share, 2));
    }
    return text;
  }
  std::string operator()(const core::chosen_by::FirstSmoothing& of) const {
    return "that of the first smoothing: " +
           (of.rule.empty() ? "no bandwidth gives a line" : "the motion is too short for the rule " + of.rule);
  }
  std::string operator()(const core::chosen_by::Rule& of) const {
    fmt::dynamic_format_arg_store<fmt::format_context> numbers;
    for (const double number : of.numbers) numbers.push_back(number);
    using Edge = core::chosen_by::Rule::Edge;
    return fmt::vformat(fmt::string_view(of.found.data(), of.found.size()), numbers) +
           (of.edge == Edge::narrowest ? " (the narrowest tried)"
            : of.edge == Edge::widest  ? " (the widest tried)"
            : of.edge == Edge::only    ? " (the only one tried)"
                                       : "") +
           (of.converted ? ", converted for a" : "");
  }
  std::string operator()(const core::chosen_by::Truth&) const { return "the least error of a(t), by the truth"; }
  std::string operator()(const core::chosen_by::Likelihood&) const { return "maximum marginal likelihood"; }
  std::string operator()(const core::chosen_by::CrossValidation&) const {
    return "minimum generalised cross-validation";
  }
  std::string operator()(const core::chosen_by::Nothing&) const {
    return "no part of the motion is long enough to be smoothed";
  }
};

}  // namespace

std::string strength_words(const core::StrengthChoice& choice) {
  return std::visit(ChoiceSentence{}, choice);
}

}  // namespace glidelab::report
