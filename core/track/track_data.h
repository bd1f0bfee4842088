/// x(t) of one clip, as it enters the smoothing: obtained from a video by tracking and restitution, or read from a CSV
/// or another program's table.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/analysis_note.h"
#include "core/result/image_record.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Fewer points than this do not determine an acceleration: a local cubic has four coefficients, and as many points
/// again are needed for the noise.
inline constexpr std::size_t kFewestTrackPoints = 8;

/// Below it a position is not that of the body: the default of DeepLabCut (p-cutoff).
inline constexpr double kLeastLikelihood = 0.6;

/// "at least 8: …", for messages about a track of fewer points.
std::string few_points_expectation();

/// Whether a table of speeds without positions is taken.
enum class SpeedsAlone { refused, taken };

/// Positions along the line of motion, positive downhill, or speeds without positions. All vectors have one length;
/// times rise strictly.
struct TrackData {
  std::vector<double> t_s;  ///< frames in which the marker was found, middle of exposure
  std::vector<double> x_m;
  std::vector<double> force_n;     ///< known applied force along x; empty if there is none
  std::vector<std::size_t> frame;  ///< the frame of each point
  std::vector<double> frame_t_s;   ///< times of all frames, with and without marker
  double frame_rate_hz = 0.0;
  double scale_sd_relative = 0.0;  ///< relative uncertainty of one px_per_m
  /// How all positions change for one standard deviation of each independent error of the camera and the plane (the
  /// calibration's modes); one entry for every mode of the whole analysis, empty if the mode does not affect this
  /// track.
  std::vector<std::vector<double>> shared_m;
  std::vector<MarkerSighting> sightings;      ///< empty for a track from a file
  std::shared_ptr<const ImageRecord> images;  ///< if requested
  bool dark_marker = false;                   ///< seen as darker than its surroundings, with no stated colour
  std::vector<Note> notes;
  std::string sensor_column = {};  ///< the header of x if a motion sensor's program wrote it (is_sensor_column())
  std::vector<double> v_m_s = {};  ///< measured speeds in place of positions: x_m and force_n are empty then
};

/// Leaves out the values that a sensor or a tracker writes while it sees nothing, then those that lie anywhere at the
/// ends, then the positions of something else (core/math/false_positions.h), with notes that count them.
void leave_out_false_positions(TrackData& track);

/// Takes every point of a track from a file as a frame in which the object was seen, without false ones and without
/// those in which a film repeats the frame before (core/math/frame_repeats.h); the frame rate is one over the median
/// time step. Times that are uniform except for rounding to written digits are restored to
/// their uniform values (even_times.h); a note says so if a digit is more than a thousandth of a frame.
void take_rows_as_frames(TrackData& track);

/// A motion given as numbers: rising times in seconds, positions in metres, and the known force in newtons (empty if
/// there is none), all positive downhill. `what` names it in messages: "clip \"up\"". InputError, up to ten issues
/// named by index: series of different lengths, a number that is not finite, a time that does not rise, too few points.
TrackData track_of_numbers(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> force_n,
                           const std::string& what);

/// InputError if units of images were stated for this very file, which is `found`.
void refuse_unneeded(const ImageUnits& units, const std::string& file, const std::string& found);

/// A track from a table exported by another program (column_table.h), as text or in a workbook (workbook.h).
///
/// The columns of x and t: table_columns.h. Units: m, dm, cm, mm, um, km, in, ft; s, ms, us, min. If none is stated,
/// metres and seconds are assumed, and a note says so. With `units`, frame numbers are times where no column holds
/// times, and lengths in pixels, or without a unit, are divided by the scale, whose uncertainty all positions share.
/// Rows in which the program that followed the body gives it a likelihood below kLeastLikelihood are left out, with a
/// note that counts them. Rows without time or x are left out (columns of several runs differ in length), and a note
/// counts those that lie between others.
///
/// x is multiplied by `downhill`. If x is a height that was not requested, a note says so (HeightTaken); its sign is
/// that of the table, and core/analysis/clip_to_track.h decides for all clips of a set-up together. InputError: no or
/// several candidates for x, a curved path, a unit that is neither length nor time, times that do not rise or have a
/// gap that is too long (core/math/time_gap.h), fewer points than kFewestTrackPoints. A table with speeds and no
/// positions is an InputError, or gives v_m_s; its units are m/s, cm/s, mm/s or km/h.
TrackData import_track(const std::filesystem::path& file, const std::string& column, std::optional<int> downhill,
                       SpeedsAlone speeds = SpeedsAlone::refused, const ImageUnits& units = {});

/// Reverses x and the force of all tracks, with a note in each; a second time takes the note back. Of tables of speeds,
/// the speeds are reversed.
void reverse(const std::vector<TrackData*>& tracks);

/// Reverses all tracks if the sum of their drops (core/math/signed_drop.h) is negative. The tracks are of one set-up,
/// so that one sign holds for all.
void count_downwards(const std::vector<TrackData*>& tracks);

/// Reads a motion that was tracked elsewhere: a CSV with the header `t_s,x_m` or `t_s,x_m,force_n`, or a table exported
/// by another program. x and the force are multiplied by `downhill` (+1 or -1; 1 if not stated), so that both are
/// positive downhill. Times stay those of the file except for take_rows_as_frames(). InputError, up to ten issues named
/// by line: not a number, a time that does not rise, a gap that is too long (core/math/time_gap.h), too few points.
///
/// With SpeedsAlone::taken also the header `t_s,v_m_s`.
///
/// A file whose header has no `t_s`, or of which a column is requested, goes to import_track().
TrackData read_track_csv(const std::filesystem::path& file, std::optional<int> downhill, const std::string& column = {},
                         SpeedsAlone speeds = SpeedsAlone::refused, const ImageUnits& units = {});

}  // namespace glidelab::core
