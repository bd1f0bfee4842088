/// x(t) of one clip, as it enters the smoothing: from a video by tracking and restitution, or read from a CSV or
/// another program's table.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/result/picture_record.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Fewer points than this say nothing about an acceleration: a local cubic has four coefficients, and as many points
/// again are left for their noise.
inline constexpr std::size_t kFewestTrackPoints = 8;

/// Positions along the line of motion, positive downhill. All vectors have one length; times rise strictly.
struct TrackData {
  std::vector<double> t_s;  ///< frames in which the marker was found, middle of exposure
  std::vector<double> x_m;
  std::vector<double> force_n;     ///< known applied force along x; empty where there is none
  std::vector<std::size_t> frame;  ///< the frame that each point comes from
  std::vector<double> frame_t_s;   ///< times of all frames, with and without marker
  double frame_rate_hz = 0.0;
  double scale_sd_relative = 0.0;  ///< relative uncertainty of one px_per_m
  /// How all positions change by one standard deviation of each independent error of the camera and the plane (the
  /// calibration's modes); one entry for every mode of the whole analysis, empty where it does not touch this track.
  std::vector<std::vector<double>> shared_m;
  std::vector<MarkerSighting> sightings;          ///< empty for a track from a file
  std::shared_ptr<const PictureRecord> pictures;  ///< where they were asked for
  bool dark_marker = false;  ///< seen as darker than its surroundings, without a colour that says so
  std::vector<Note> notes;
};

/// Every point of a track from a file is a frame in which the object was seen; the frame rate is one over the median
/// time step. Times that are even but for the digits they are written with are put back on their even places
/// (written_times.h), and a note says so where a digit is more than a thousandth of a frame.
void take_rows_as_frames(TrackData& track);

/// A motion that is given as numbers: times in seconds that rise, positions in metres, and the known force in newtons
/// (empty where there is none), all positive downhill. `what` names it in messages: "clip \"up\"". InputError, up to
/// ten issues named by place: not as many of each, a number that is not finite, a time that does not rise, too few
/// points.
TrackData track_of_numbers(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> force_n,
                           const std::string& what);

/// A track from a table that another program exported (column_table.h): which column is x, which is its time.
///
/// Which columns are x and t: table_columns.h. Units: m, dm, cm, mm, um, km, in, ft; s, ms, us, min. Where none is
/// stated metres and seconds are taken, and a note says so. Rows without time or x are left out (columns of several
/// runs differ in length), and a note counts those that lie between others.
///
/// x is multiplied by `downhill`. Where that is not stated and x is a height that nobody asked for, it is counted along
/// the motion (count_along_motion()). InputError: no or several columns that x may be, a curved path, a unit that is no
/// length or time, times that do not rise or have a gap that is too long (core/math/time_gap.h), fewer points than
/// kFewestTrackPoints.
TrackData import_track(const std::filesystem::path& file, const std::string& column, std::optional<int> downhill);

/// Counts x positive the way that the body moves, where it hardly turns; else the way that it accelerates. A note says
/// so where that turns the sign: of a height, and of a distance from a sensor that a body falls towards.
void count_along_motion(TrackData& track);

/// Reads a motion that was tracked elsewhere: a CSV with the header `t_s,x_m` or `t_s,x_m,force_n`, or what another
/// program exported. x and the force are multiplied by `downhill` (+1 or -1; 1 where it is not stated), so that both
/// are positive downhill. Times stay those of the file but for take_rows_as_frames(). InputError, up to ten issues
/// named by line: no number, a time that does not rise, a gap that is too long (core/math/time_gap.h), too few points.
///
/// A file whose header has no `t_s`, or of which a column is asked for, goes to import_track().
TrackData read_track_csv(const std::filesystem::path& file, std::optional<int> downhill,
                         const std::string& column = {});

}  // namespace glidelab::core
