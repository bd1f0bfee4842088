#include "report/check/finding_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <variant>

#include "core/result/results.h"
#include "core/result/uphill.h"
#include "report/analysis/note_words.h"
#include "report/analysis/row_words.h"
#include "report/analysis/statement_words.h"
#include "report/text/why_words.h"

namespace glidelab::report {
namespace {

namespace found = core::found;

std::string percent_text(double share) {
  return fmt::format("{:.3g} %", 100.0 * share);
}

/// To the millisecond, however late it is.
std::string instant_text(double t_s) {
  std::string text = fmt::format("{:.3f}", t_s);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

/// At most six names, and how many more there are.
std::string first_names(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  const std::size_t shown = std::min(kMost, names.size());
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string times_text(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

std::string lengths_text(const core::LengthSources& lengths) {
  std::vector<std::string> keys;
  if (lengths.square) keys.emplace_back("square_m");
  if (lengths.scale) keys.emplace_back("[scale]");
  if (lengths.tracks) keys.emplace_back("the unit of x in the tracks (metres)");
  return fmt::format("{}", fmt::join(keys, ", "));
}

/// Words for every kind; a kind without them does not compile.
struct FindingSentence {
  FindingWords operator()(const core::Note& of) const { return {note_words(of), ""}; }

  FindingWords operator()(const found::NoCamera& of) const {
    return {of.failure,
            fmt::format("the pattern was found in {} of {} images; retake them: the whole board in view, sharp, evenly "
                        "lit, with a white border, and inner_corners as printed",
                        of.with_pattern, of.images)};
  }
  FindingWords operator()(const found::NoPatternIn& of) const {
    return {"no pattern is found in " + first_names(of.files),
            "retake these images with all inner corners in view and the board evenly lit, or remove them"};
  }
  FindingWords operator()(const found::FewViews& of) const {
    return {fmt::format("the calibration uses {} views", of.views),
            "take about a dozen, tilted in all directions, near and far"};
  }
  FindingWords operator()(const found::CornersOff& of) const {
    return {fmt::format("corners lie {:.2g} px (rms) from where the camera model places them", of.rms_px),
            "glue the board to a flat plate, keep it still and sharp in every image, and leave zoom and focus alone"};
  }
  FindingWords operator()(const found::LittleCovered& of) const {
    return {fmt::format("the views cover {} of the image", percent_text(of.share)),
            "hold the board near the edges and corners of the image as well: the lens is known only where the board "
            "was seen"};
  }
  FindingWords operator()(const found::LittleTilt& of) const {
    return {fmt::format("the board is tilted by at most {:.0f} degrees", of.most_deg),
            "tilt it by 30 to 45 degrees in some views; otherwise the focal length is hardly determined"};
  }
  FindingWords operator()(const found::PlaneViewsOff& of) const {
    return {fmt::format("the corners of the plane views lie {:.2g} px (rms) from where the camera places them; their "
                        "noise explains {:.2g} px",
                        of.rms_px, of.expected_px),
            "retake the plane view with the same focus, zoom and image size as all others, the board flat and still"};
  }

  FindingWords operator()(const found::NotTracked& of) const {
    return {of.failure,
            of.images
                ? "check that the file plays, that the marker is in the image and moves, and that [marker] describes it"
                : "repair the file, or state what it lacks"};
  }
  FindingWords operator()(const found::FewPositions& of) const {
    const std::string points = fmt::format("the track has {} points", of.positions);
    if (of.unmarked == 0) return {points, "record at a higher rate"};
    return {fmt::format("{}; another {} rows are empty", points, of.unmarked),
            "mark the object in every frame of the video"};
  }
  FindingWords operator()(const found::FewSightings& of) const {
    return {fmt::format("the marker is seen in only {} frames", of.frames),
            "film at a higher rate, or let the glider run a longer distance in the image"};
  }
  FindingWords operator()(const found::SightingsMissing& of) const {
    return {fmt::format("the marker is seen in {} of the {} frames between its first and its last sighting", of.seen,
                        of.spanned),
            "make sure that nothing hides it; increase the contrast, reduce the blur"};
  }
  FindingWords operator()(const found::UnseenAtEnd& of) const {
    return {fmt::format("the marker is {} seen in frame {} of {}", of.at_start ? "first" : "last", of.frame, of.frames),
            of.at_edge
                ? ""
                : fmt::format("the marker is not at the edge of the image there: if the glider is fast, shorten the "
                              "exposure and use more light; otherwise {}",
                              of.at_start ? "begin the clip where the hand lets go (start_s)"
                                          : "end the clip where the glider stops or is caught (end_s)")};
  }
  FindingWords operator()(const found::SmallMarker& of) const {
    return {fmt::format("the marker is {:.2g} px wide", of.width_px), "move closer or use a bigger one"};
  }
  FindingWords operator()(const found::LongExposure& of) const {
    return {fmt::format("the marker lengthens with its speed as it would with an exposure of {:.2g} ms{}",
                        1e3 * of.exposure_s, of.stated ? "; exposure_s is less than half of that" : ""),
            "read the exposure from the camera, and shorten it"};
  }
  FindingWords operator()(const found::Smeared& of) const {
    return {fmt::format("at its top speed, {:.3g} m/s, the marker is smeared by {}{:.3g} px; it is {:.3g} px wide",
                        of.speed_m_s, of.known ? "" : "up to ", of.blur_px, of.marker_px),
            of.known ? "shorten the exposure and use more light"
                     : "state exposure_s in [camera] (this is the smear of an exposure as long as the frame time)"};
  }
  FindingWords operator()(const found::OutsidePattern& of) const {
    return {fmt::format("{} of the marker's path lies outside the region in which the pattern was seen",
                        percent_text(of.share)),
            "take views of the pattern that cover the region in which the glider runs"};
  }

  FindingWords operator()(const found::MarkerSaturated&) const {
    return {"the marker is saturated", "shorten the exposure until it is grey: saturation displaces its edge"};
  }
  FindingWords operator()(const found::PixelsSaturated& of) const {
    return {fmt::format("{} of the pixels are saturated", percent_text(of.share)),
            "shorten the exposure, or cover bright surfaces"};
  }
  FindingWords operator()(const found::Dark& of) const {
    return {fmt::format("the brightest parts reach only {} of the camera's range", percent_text(of.brightest)),
            "use more light: dark images are noisy"};
  }
  FindingWords operator()(const found::LittleContrast& of) const {
    return {fmt::format("the marker differs from its surroundings by only {} of the camera's range",
                        percent_text(of.contrast)),
            "put a darker (or brighter) sheet behind it, or use a retroreflective marker with a lamp at the camera"};
  }
  FindingWords operator()(const found::NoisyContrast& of) const {
    return {fmt::format("the marker's contrast is {:.3g} times the noise of a pixel", of.over_noise),
            "use more light and less gain (ISO)"};
  }
  FindingWords operator()(const found::LitFromOneSide& of) const {
    const auto length = [&](double px) {
      return of.px_per_m ? fmt::format("{:.2g} px ({:.2g} mm)", px, 1e3 * px / *of.px_per_m)
                         : fmt::format("{:.2g} px", px);
    };
    const std::string off = fmt::format(
        "light from one side: the marker's brightness is centred {} from its outline's centre, ", length(of.pull_px));
    if (!of.changes) return {off + fmt::format("the same along the path to within ±{}", length(of.change_px)), ""};
    return {off + fmt::format("and that changes by ±{} along the path", length(of.change_px)),
            "light the track evenly, with a second lamp from the other side or through a diffuser: the analysis fits "
            "the outline, which is less certain where only the lit part stands out"};
  }
  FindingWords operator()(const found::ContrastFalls& of) const {
    return {fmt::format("the marker's contrast falls to {} of its largest along the path", percent_text(of.least)),
            "move lamps, and bright or dark objects in the background, away from the marker's path"};
  }
  FindingWords operator()(const found::ShadowEdge& of) const {
    std::vector<std::string> frames;
    for (const auto& one : of.frames) {
      if (frames.size() == 3) break;
      frames.push_back(one.first == one.last ? fmt::format("{}", one.first)
                                             : fmt::format("{} to {}", one.first, one.last));
    }
    return {fmt::format("a shadow's edge{} lies at x = {:.3g} m: the brightness {} the marker falls by {:.2g} % {} "
                        "within one diameter (frames {} of {})",
                        of.of_marker ? "" : ", or that of another surface,", of.x_m, of.of_marker ? "of" : "around",
                        100.0 * of.fall, of.downhill ? "downhill" : "uphill", fmt::join(frames, ", "), of.clip),
            "move the lamp, or what casts the shadow: at such an edge the marker's centre is less certain"};
  }
  FindingWords operator()(const found::LightFalls& of) const {
    using Towards = found::LightFalls::Towards;
    const char* const where = of.towards == Towards::right    ? "to the right"
                              : of.towards == Towards::left   ? "to the left"
                              : of.towards == Towards::bottom ? "downwards"
                                                              : "upwards";
    return {fmt::format("the light{} falls by {:.2g} % per metre {} in the image: it displaces the centroid of the "
                        "marker by {:.2g} mm at most",
                        of.of_marker ? "" : " around the marker", 100.0 * of.part_per_m, where, 1e3 * of.displaces_m),
            ""};
  }
  FindingWords operator()(const found::LightFlickers& of) const {
    return {fmt::format(
                "the light flickers: the brightness of the image varies by ±{:.2g} % at {:.4g} Hz{}, which displaces "
                "the marker by up to {:.2g} mm at its top speed",
                100.0 * of.depth, of.f_hz,
                std::abs(of.f_hz - of.seen_hz) > 0.01 * of.f_hz
                    ? fmt::format(" (it looks like {:.3g} Hz at this frame rate)", of.seen_hz)
                    : "",
                1e3 * of.displaces_m),
            "use daylight or a lamp on direct current"};
  }
  FindingWords operator()(const found::StrongCompression& of) const {
    return {fmt::format("strong compression: steps between pixels are {} larger at the edges of 8 × 8 blocks than "
                        "elsewhere, and the marker's centre errs with them over several frames",
                        percent_text(of.block_steps)),
            "record or export at a higher bit rate, or without loss"};
  }

  FindingWords operator()(const found::Interlaced& of) const {
    return {
        "the film is interlaced: in each frame the odd rows were seen half a frame earlier or later than the even "
        "ones, and what moves has edges like combs",
        fmt::format("make one frame of each field (ffmpeg -vf bwdif) and state frame_rate_hz = {:.6g}, or film without "
                    "interlacing",
                    2.0 * of.frame_rate_hz)};
  }
  FindingWords operator()(const found::OtherRateInFile& of) const {
    if (core::is_playback(of.file_hz, of.stated_hz)) {
      return {fmt::format("the file is played at {:.6g} frames per second; the rate in experiment.toml, {:.6g}, counts",
                          of.file_hz, of.stated_hz),
              ""};
    }
    return {fmt::format("the file states {:.6g} frames per second, experiment.toml {:.6g}", of.file_hz, of.stated_hz),
            fmt::format("check that the clip was filmed at {:.6g} frames per second: a wrong rate scales every speed",
                        of.stated_hz)};
  }
  FindingWords operator()(const found::UnevenStamps& of) const {
    return {fmt::format("the file's time stamps depart from even spacing by {:.3g} frames; {} steps are irregular",
                        of.drift_frames, of.irregular_steps),
            of.by_rate ? "set time = \"container\" in [camera] if the camera films at a varying rate; otherwise find "
                         "out which program dropped frames"
                       : ""};
  }
  FindingWords operator()(const found::Jumps& of) const {
    return {
        fmt::format("the marker jumps {} by the distance of one or more frames: frames are missing",
                    times_text(of.jumps)),
        "record to a faster disk or in a smaller format; set time = \"container\" if the file's time stamps are true"};
  }
  FindingWords operator()(const found::FramesRepeated& of) const {
    const std::string identical =
        fmt::format("{} of {} frames are identical to the frame before", of.repeated, of.frames);
    const std::string stalls = fmt::format("the body stands still for a frame {} in mid-motion", times_text(of.stalls));
    return {of.stalls == 0
                ? identical
                : fmt::format("{}{}: frames are repeated{}", stalls, of.repeated > 0 ? ", and " + identical : "",
                              of.times_hold ? " (the analysis leaves them out)" : ""),
            "export the clip at the rate at which it was filmed and at a high bit rate (strong compression repeats "
            "frames too), with a converter that adds no frames"};
  }
  FindingWords operator()(const found::AssumedForFile& of) const {
    const std::string mass = of.mass_kg ? fmt::format("mass is taken as {:.6g} kg", *of.mass_kg) : "";
    if (!of.incline_deg) {
      return {"a single file: its " + mass,
              "use --mass to state another; where no force is recorded, K/m, µ and α do not depend on it"};
    }
    const std::string angle = fmt::format("{:.4g}°", *of.incline_deg);
    if (!of.mass_kg) {
      return {"a single file: its inclination is taken as " + angle,
              "use --incline to state another; where no force is recorded, K/m, µ and α do not depend on it"};
    }
    return {fmt::format("a single file: its {} and its inclination as {}", mass, angle),
            "use --mass and --incline to state others; where no force is recorded, K/m, µ and α do not depend on them"};
  }
  FindingWords operator()(const found::NoPlumbAngle& of) const { return {of.failure, ""}; }

  FindingWords operator()(const found::MassesApart& of) const {
    std::vector<std::string> heavy;
    for (const auto& one : of.heavy) heavy.push_back(fmt::format("{} ({:.6g})", one.clip, one.mass_kg));
    return {fmt::format("mass_kg of {} is {:g} or more times that of {} ({:.6g})", first_names(heavy), of.ratio,
                        of.lightest.clip, of.lightest.mass_kg),
            "state every mass in kilograms: one of them looks like grams"};
  }
  FindingWords operator()(const found::MarkerSizeOff& of) const {
    const char* const length = of.by_scale ? "[scale]" : "square_m";
    return {fmt::format("the marker is {:.3g} px wide; diameter_m and {} predict {:.3g} px: {:.0f} % off", of.seen_px,
                        length, of.expected_px, 100.0 * of.off),
            fmt::format("measure diameter_m and {} again: one of these lengths is wrong; if it is not diameter_m, all "
                        "speeds and accelerations are wrong too",
                        length)};
  }
  FindingWords operator()(const found::BeyondTrack& of) const {
    return {fmt::format("the glider runs {:.3g} m, but length_m in [track] is {:.3g} m", of.distance_m, of.length_m),
            fmt::format("measure the track again, and check {}", lengths_text(of.lengths))};
  }
  FindingWords operator()(const found::InclineOff& of) const {
    if (core::seems_uphill(of.contradiction)) {
      return {contradiction_words(of.contradiction), contradiction_causes(of.contradiction)};
    }
    return {
        contradiction_words(of.contradiction),
        fmt::format("one of these differs from the real set-up: {}, gravity_m_s2, {}{}; a wrong length also makes the "
                    "terminal velocity wrong{}",
                    of.contradiction.stated.by, lengths_text(of.lengths),
                    of.filmed ? ", frame_rate_hz (its square enters)" : "", of.filmed ? ", a wrong rate K/m too" : "")};
  }
  FindingWords operator()(const found::AgainstStatedLaunch& of) const {
    const bool many = of.against > 1;
    const std::string whose =
        many ? fmt::format("in {} of {} clips the glider moves opposite to the stated launch, most clearly in {}: ",
                           of.against, of.clips, of.clip)
             : "";
    const std::string keys =
        fmt::format("launched = \"{}\" and {}", of.launched,
                    of.downhill ? fmt::format("downhill = \"{}\"", *of.downhill) : "no stated downhill");
    using Stated = found::AgainstStatedLaunch::Stated;
    return {fmt::format("{}{}, as {} say; that is {} of its free motion", whose, launch_words(of.motion), keys,
                        percent_text(of.motion.share)),
            fmt::format("check which of the two is wrong: launched of {}, or downhill in {}; if neither is, state in "
                        "start_s when the hand lets go",
                        many ? "these clips" : "this clip",
                        of.stated == Stated::in_either  ? "[track] or [group]"
                        : of.stated == Stated::in_group ? "[group]"
                                                        : "[track]")};
  }

  FindingWords operator()(const found::LengthInUnit& of) const {
    const double metres = of.value / core::per_metre(of.unit);
    return {fmt::format("{} = {:.6g} looks like {} ({:.6g} m)", of.key, of.value, core::name_of(of.unit).many, metres),
            fmt::format("state it in metres: {} = {:.6g}", of.key, metres)};
  }
  FindingWords operator()(const found::ScaleInUnit& of) const {
    const double per_metre = of.px_per_m * core::per_metre(of.unit);
    return {fmt::format("px_per_m = {:.6g} looks like pixels per {} ({:.6g} per metre)", of.px_per_m,
                        core::name_of(of.unit).one, per_metre),
            fmt::format("state it per metre: px_per_m = {:.6g}", per_metre)};
  }
  FindingWords operator()(const found::MassInGrams& of) const {
    return {fmt::format("mass_kg = {:.6g} looks like grams ({:.6g} kg)", of.mass_kg, of.mass_kg / 1000.0),
            fmt::format("state masses in kilograms: {:.6g}", of.mass_kg / 1000.0)};
  }
  FindingWords operator()(const found::TrackInUnit& of) const {
    const double per_metre = core::per_metre(of.unit);
    return {fmt::format("x covers {:.4g}, which looks like {} ({:.3g} m)", of.distance_m, core::name_of(of.unit).many,
                        of.distance_m / per_metre),
            fmt::format("give x in metres: divide the column by {:.0f}, or name its unit in the header", per_metre)};
  }
  FindingWords operator()(const found::InclineInRadians& of) const {
    return {fmt::format("incline_deg = {:.4g} looks like radians ({:.3g}°, and the motion says {:.3g}°)", of.stated_deg,
                        of.as_radians_deg, of.motion_deg),
            fmt::format("state it in degrees: incline_deg = {:.3g}", of.as_radians_deg)};
  }
  FindingWords operator()(const found::WrongFrameRate& of) const {
    return {fmt::format("frame_rate_hz = {:.6g} does not fit the motion: with the file's {:.6g} the inclination is "
                        "{:.3g}°, as stated",
                        of.stated_hz, of.file_hz, of.incline_deg),
            fmt::format("state the rate at which it was filmed: frame_rate_hz = {:.6g}", of.file_hz)};
  }

  FindingWords operator()(const found::MotionFault& of) const {
    found::FaultWords words = found::fault_words(of);
    return {std::move(words.found), std::move(words.advice)};
  }
  FindingWords operator()(const found::FallAboveGravity& of) const {
    const double ratio = of.acceleration_m_s2 / of.gravity_m_s2;
    return {fmt::format("it falls at about {:.3g} m/s², {:.0f} % above gravity: x is {:.0f} % too long, or the frames "
                        "are {:.0f} % longer than stated",
                        of.acceleration_m_s2, 100.0 * (ratio - 1.0), 100.0 * (ratio - 1.0),
                        100.0 * (std::sqrt(ratio) - 1.0)),
            "measure the scale again, with a known length where the body falls, and the frame rate, with a clock in "
            "the image"};
  }
  FindingWords operator()(const found::LongRun& of) const {
    return {fmt::format("x covers {:.3g} m", of.distance_m),
            "check the unit of x: it may be centimetres, millimetres, an angle, or a speed"};
  }
  FindingWords operator()(const found::Pushed& of) const {
    return {
        fmt::format("until {} s it speeds up by up to {:.2g} m/s², more than any incline gives: it is pushed",
                    instant_text(of.until_s), of.acceleration_m_s2),
        fmt::format("use the part that is free: start_s = {}, or leave out the rows before", instant_text(of.until_s))};
  }
  FindingWords operator()(const found::SlowFrames& of) const {
    return {fmt::format("its positions are {:.3g} s apart", of.apart_s),
            "check the unit of the times: they may be milliseconds, or frame numbers"};
  }
  FindingWords operator()(const found::FallsSlowly& of) const {
    return {slow_fall_words(of.fall), "find out which of these it is; until then K/m is no drag"};
  }
  FindingWords operator()(const found::Gaps& of) const {
    return {fmt::format("{} of its time lies in gaps of up to {:.3g} s between positions", percent_text(of.share),
                        of.longest_s),
            "record at an even rate, and track every frame: no acceleration is measured across a gap"};
  }
  FindingWords operator()(const found::Interrupted& of) const {
    const std::string more = of.count == 1   ? ""
                             : of.count == 2 ? ", and once more later"
                                             : fmt::format(", and {} times more later", of.count - 1);
    return {
        fmt::format("from {} s to {} s it does not move as before and after{}: a blow, a stop, a hand, or a force that "
                    "acts only there",
                    instant_text(of.from_s), instant_text(of.to_s), more),
        "let it run freely, or make each free run a clip of its own, with start_s and end_s"};
  }
  FindingWords operator()(const found::SlowSensor& of) const {
    return {report::row_words(of.values),
            "log at the rate of the sensor; where rows come faster, an analysis sees steps in place of a motion"};
  }
  FindingWords operator()(const found::Smoothed& of) const {
    return {
        fmt::format("the positions follow a smooth curve to {:.0e} of the distance covered: they were smoothed or "
                    "integrated before export",
                    of.share),
        "export the positions as measured: their noise is estimated from them, and every uncertainty depends on it"};
  }
};

std::string about_words(const core::Subject& about) {
  using Part = core::Subject::Part;
  switch (about.part) {
    case Part::clips:
      return first_names(about.clips);
    case Part::pattern:
      return "pattern";
    case Part::marker:
      return "marker";
    case Part::scale:
      return "scale";
    case Part::track:
      return "track";
    case Part::masses:
      return "masses";
    case Part::plumb_line:
      return "plumb line";
  }
  return "";
}

}  // namespace

FindingWords finding_words(const core::Found& found) {
  return std::visit(FindingSentence{}, found);
}

std::string WordedFinding::headline() const {
  const std::size_t many = follow.size();
  if (many == 0) return found;
  return fmt::format("{} (this explains {} other finding{})", found, many, many == 1 ? "" : "s");
}

std::vector<WordedFinding> worded(const std::vector<core::Finding>& findings) {
  std::vector<WordedFinding> all;
  std::vector<std::vector<std::string>> about;  // subjects of each
  for (const core::Finding& finding : findings) {
    FindingWords words = finding_words(finding.found);
    WordedFinding one{finding.severity, about_words(finding.about), std::move(words.found), std::move(words.advice)};
    const auto same = std::find_if(all.begin(), all.end(), [&](const WordedFinding& before) {
      return std::tie(before.severity, before.found, before.advice) == std::tie(one.severity, one.found, one.advice);
    });
    if (same != all.end() && finding.follow.empty()) {
      about[static_cast<std::size_t>(same - all.begin())].push_back(one.about);
      continue;
    }
    for (const core::Finding& of : finding.follow) {
      one.follow.push_back(about_words(of.about) + ": " + finding_words(of.found).found);
    }
    about.push_back({one.about});
    all.push_back(std::move(one));
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (about[i].size() > 1) all[i].about = first_names(about[i]);
  }
  return all;
}

}  // namespace glidelab::report
