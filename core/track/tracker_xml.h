/// What a project of Tracker (Open Source Physics) states about its clip, its axes and its point masses, as plain data.
///
/// The format is that of Tracker 4 to 6: XML objects named by their Java class, each with properties. These are read
/// from the TrackerPanel: length_unit; videoclip (startframe, stepsize, stepcount, starttime); clipcontrol (delta_t);
/// coords (fixedorigin, fixedangle, fixedscale, framedata: xorigin, yorigin, angle, xscale, yscale); tracks (PointMass:
/// name, framedata: x, y; keyFrames). Everything else is ignored: images, views, plots, models.
///
/// Positions are pixels of the video, x to the right and y down, the first pixel's corner at (0, 0).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::core {

/// The axes of one frame. With u = (x - origin_x) / scale_x and w = -(y - origin_y) / scale_y a pixel is at
/// X = u cos(angle) + w sin(angle), Y = w cos(angle) - u sin(angle).
struct TrackerAxes {
  double origin_x_px = 0.0, origin_y_px = 0.0;
  double angle_rad = 0.0;                     ///< from the image's x to the X axis, counterclockwise as seen
  double scale_x_px = 1.0, scale_y_px = 1.0;  ///< pixels per unit of length, along the image's x and y
};

struct TrackerPoint {
  long frame = 0;
  double x_px = 0.0, y_px = 0.0;
};

struct TrackerMass {
  std::string name;
  std::vector<TrackerPoint> points;  ///< frames rise
  std::vector<long> key_frames;      ///< marked by hand; may nevertheless be empty
};

struct TrackerProject {
  std::string shown_as;     ///< the file and, within an archive, the entry, for messages
  std::string name;         ///< name of the entry of an archive, without its folders
  std::string length_unit;  ///< empty if none is stated
  double start_ms = 0.0;    ///< of the first frame
  double frame_ms = 0.0;    ///< from one frame to the next
  long first_frame = 0, step = 1;
  std::optional<long> steps;         ///< empty: to the end
  std::map<long, TrackerAxes> axes;  ///< each from its frame on; of frame 0 at least
  std::vector<TrackerMass> masses;
  std::vector<std::string> models;  ///< names of masses that move by a model or as a centroid: they have no marks

  double time_s(long frame) const { return 1e-3 * (start_ms + static_cast<double>(frame - first_frame) * frame_ms); }
};

/// Enough for about 40,000 marked positions; the parsed tree of the worst such text takes half a gigabyte.
inline constexpr std::size_t kMostProjectBytes = std::size_t{32} << 20;

/// Whether the text begins like XML.
bool is_xml(std::string_view first_bytes);

/// InputError: XML that is not well formed, a DTD (no entity is ever resolved), not a project of Tracker, no frame
/// time, a number that is invalid or out of range, axes that follow a track.
TrackerProject parse_tracker_project(std::string_view xml, const std::string& shown_as);

}  // namespace glidelab::core
