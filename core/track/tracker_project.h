/// The motion of a point mass in a project of Tracker (tracker_xml.h), as it is there: in the project's scale, from its
/// origin, along its axes, at its times.
///
/// A project is a .trk (XML), or a .trz or .zip that holds one or more of them beside the images; the images are not
/// read. x is one of the two coordinates: the one along which the mass moves most, or the one that `downhill` names.
/// Step k of the clip is at starttime + k stepsize delta_t. A position counts where its frame is a step of the clip, as
/// in Tracker's own tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// By the file's first bytes: a zip archive or XML. (Whether it is a project read_tracker_project() says.)
bool is_tracker_project(const std::filesystem::path& file);

/// `point_mass`: its name, where several projects have it "PROJECT.trk: NAME", or its number from 1 on; empty where
/// there is only one. Where `downhill` is nothing, x is positive along +X, or along the one of +Y and -Y that points
/// towards the image's lower edge; a note says which.
///
/// Where axes, scale or origin change from frame to frame, each position goes by its frame's. Positions that Tracker
/// filled in on a straight line between two marks are left out. Notes: the coordinate, a line of motion that makes more
/// than three degrees with it, positions that are left out, no unit of length (metres).
///
/// InputError: no such point mass, or several of the name; a model instead of marks; an unknown unit; fewer positions
/// than kFewestTrackPoints; what parse_tracker_project() and ZipArchive refuse. A project has at most
/// kMostProjectBytes, whatever an archive claims, and an archive at most kMostProjects projects.
TrackData read_tracker_project(const std::filesystem::path& file, std::optional<Downhill> downhill,
                               const std::string& point_mass);

/// The names of a project's point masses, or of all of an archive, as `point_mass` above takes them.
/// InputError as read_tracker_project() for what is no project.
std::vector<std::string> point_masses_of(const std::filesystem::path& file);

inline constexpr std::size_t kMostProjects = 50;  ///< of one archive: a course's worth of tabs

}  // namespace glidelab::core
