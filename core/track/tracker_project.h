/// The motion of a point mass in a project of Tracker (tracker_xml.h), in the project's own scale, origin, axes and
/// times.
///
/// A project is a .trk (XML), or a .trz or .zip that holds one or more of them together with images; the images are not
/// read. x is the coordinate along which the mass moves most, or the one that `downhill` names. Step k of the clip is
/// at starttime + k stepsize delta_t. A position counts if its frame is a step of the clip, as in Tracker's own tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// A zip archive without a spreadsheet (workbook.h), or XML, by the file's first bytes. (read_tracker_project() decides
/// whether it is a project.) InputError if it begins like a zip archive and is none.
bool looks_like_tracker_project(const std::filesystem::path& file);

/// `point_mass`: its name ("PROJECT.trk: NAME" if several projects have it) or its number from 1 on; empty if there is
/// only one. If `downhill` is empty, x is positive along +X, or along whichever of +Y and -Y points towards the image's
/// lower edge; a note says which.
///
/// If axes, scale or origin change from frame to frame, each position uses those of its frame. Positions that Tracker
/// filled in on a straight line between two marks are left out. Notes: the coordinate, a line of motion at more than
/// three degrees to it, positions left out, no unit of length (metres are assumed).
///
/// InputError: no such point mass, or several of that name; a model instead of marks; an unknown unit; fewer positions
/// than kFewestTrackPoints; anything that parse_tracker_project() and ZipArchive refuse. A project has at most
/// kMostProjectBytes, whatever an archive claims, and an archive at most kMostProjects projects.
TrackData read_tracker_project(const std::filesystem::path& file, std::optional<Downhill> downhill,
                               const std::string& point_mass);

/// The names of a project's point masses, or of all in an archive, in the form that `point_mass` above takes.
/// InputError as in read_tracker_project() if the file is not a project.
std::vector<std::string> point_masses_of(const std::filesystem::path& file);

inline constexpr std::size_t kMostProjects = 50;  ///< in one archive: enough for the tabs of a whole course

}  // namespace glidelab::core
