/// x(t) of one clip, as it enters the smoothing: from a video by tracking and restitution, or read from a CSV or
/// another program's table.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

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
  std::vector<std::string> notes;
};

/// Every point of a track from a file is a frame in which the object was seen; the frame rate is one over the median
/// time step.
void take_rows_as_frames(TrackData& track);

/// A track from a table that another program exported (column_table.h): which column is x, which is its time.
///
/// x is the column that is asked for, by its header, its name or its number from 1 on; otherwise the one that is called
/// x, position, distance or displacement (or the like in German, French, Spanish), if there is just one. Its time is
/// the nearest column to the left that is called t or time or has a unit of time, of the same run where runs are
/// stated; else the only one there is. In a file without header the first column is the time. Units: m, dm, cm, mm, um,
/// km, in, ft; s, ms, us, min. Where none is stated metres and seconds are taken, and a note says so. Rows without time
/// or x are left out (columns of several runs differ in length), and a note counts those that lie between others.
///
/// x is multiplied by `downhill`. InputError: no or several columns that x may be, a unit that is no length or time,
/// times that do not rise, fewer points than kFewestTrackPoints.
TrackData import_track(const std::filesystem::path& file, const std::string& column, int downhill);

/// Reads a motion that was tracked elsewhere: a CSV with the header `t_s,x_m` or `t_s,x_m,force_n`, or what another
/// program exported. x and the force are multiplied by `downhill` (+1 or -1), so that both are positive downhill. Times
/// stay those of the file. InputError, up to ten issues named by line: no number, a time that does not rise, too few
/// points.
///
/// A file whose header has no `t_s`, or of which a column is asked for, goes to import_track().
TrackData read_track_csv(const std::filesystem::path& file, int downhill, const std::string& column = {});

}  // namespace glidelab::core
