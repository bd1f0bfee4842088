#include "core/track/tracker_project.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/math/angles.h"
#include "core/experiment/file_names.h"
#include "core/track/column_table.h"
#include "core/track/container/zip_archive.h"
#include "core/track/table_columns.h"
#include "core/track/tracker_xml.h"
#include "core/track/workbook.h"

namespace glidelab::core {
namespace {

namespace fs = std::filesystem;

constexpr double kSlantedRad = 3.0 * base::kRadPerDegree;  // off the axis: positions are too short by 0.14 %
constexpr double kMostAcrossOverAlong = 1e-3;  // variance across a line of motion over that along it; above this the
                                               // line has no angle
constexpr double kFilledPx = 1e-6;  // off a straight line between two marks; manual marks are never that accurate

std::string last_part(const std::string& name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

/// Files that Apple's archiver puts beside each file are not the user's.
bool is_project_name(const std::string& name) {
  const std::string last = last_part(name);
  return lower_extension(last) == ".trk" && !last.starts_with("._");
}

std::vector<TrackerProject> projects_of_archive(const fs::path& file) {
  const ZipArchive archive(file);
  std::vector<ZipArchive::Entry> entries;
  for (const ZipArchive::Entry& entry : archive.entries()) {
    if (is_project_name(entry.name)) entries.push_back(entry);
  }
  if (entries.empty() || entries.size() > kMostProjects) {
    const bool none = entries.empty();
    throw base::InputError(
        base::Issue{file.string(), 0, "", fmt::format("a zip archive with {} Tracker projects (.trk)", entries.size()),
                    none ? "one or more, or a workbook of Excel (.xlsx)" : fmt::format("at most {}", kMostProjects)});
  }
  std::vector<TrackerProject> projects;
  for (const ZipArchive::Entry& entry : entries) {
    projects.push_back(parse_tracker_project(archive.read(entry, kMostProjectBytes),
                                             fmt::format("{}: {}", file.string(), entry.name)));
    projects.back().name = last_part(entry.name);
  }
  return projects;
}

constexpr std::size_t kLookedAt = 64;  // bytes: a byte-order mark and some blanks may come first

std::vector<TrackerProject> projects_of(const fs::path& file) {
  if (is_zip_archive(first_bytes_of(file, kLookedAt))) return projects_of_archive(file);
  std::error_code ignored;  // read_file reports the error
  const auto size = fs::file_size(file, ignored);
  if (!ignored && size > kMostProjectBytes) {
    throw base::InputError(base::Issue{file.string(), 0, "", fmt::format("XML of {} bytes", size),
                                       fmt::format("a Tracker project of at most {}", kMostProjectBytes)});
  }
  std::vector<TrackerProject> projects;
  projects.push_back(parse_tracker_project(base::read_file(file), file.string()));
  return projects;
}

/// A point mass and the project that it belongs to.
struct Candidate {
  const TrackerProject* project;
  const TrackerMass* mass;
  std::string full_name;  ///< "cups.trk: cup 3" in an archive of several projects
};

std::vector<Candidate> candidates_of(const std::vector<TrackerProject>& projects) {
  std::vector<Candidate> candidates;
  for (const TrackerProject& project : projects) {
    for (const TrackerMass& mass : project.masses) {
      candidates.push_back({&project, &mass, projects.size() > 1 ? project.name + ": " + mass.name : mass.name});
    }
  }
  return candidates;
}

std::string names_text(const std::vector<Candidate>& candidates) {
  if (candidates.empty()) return "no point mass";
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates) {
    names.push_back(fmt::format("{} \"{}\"", names.size() + 1, candidate.full_name));
  }
  return fmt::format("point mass{} {}", names.size() > 1 ? "es" : "", fmt::join(names, ", "));
}

Candidate choose(const fs::path& file, const std::vector<TrackerProject>& projects, const std::string& asked) {
  const std::vector<Candidate> all = candidates_of(projects);
  const auto refuse = [&](std::string found, std::string expected) {
    throw base::InputError(base::Issue{file.string(), 0, "column", std::move(found), std::move(expected)});
  };
  if (asked.empty() && all.size() == 1) return all.front();
  if (asked.empty()) {
    refuse(names_text(all),
           all.empty() ? "a Tracker project with a marked point mass"
                       : "the name of one of them (--column, or column = \"\xE2\x80\xA6\" in experiment.toml)");
  }
  const auto of_name = [&](auto matches) {
    std::vector<Candidate> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found), matches);
    return found;
  };
  const std::string small = lower(asked);
  std::vector<Candidate> found =
      of_name([&](const Candidate& one) { return one.mass->name == asked || one.full_name == asked; });
  if (found.empty()) {
    found =
        of_name([&](const Candidate& one) { return lower(one.mass->name) == small || lower(one.full_name) == small; });
  }
  if (found.size() == 1) return found.front();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
  const bool is_number = error == std::errc{} && end == asked.data() + asked.size();
  if (found.empty() && is_number && number >= 1 && number <= all.size()) return all[number - 1];
  for (const TrackerProject& project : projects) {
    if (std::find(project.models.begin(), project.models.end(), asked) == project.models.end()) continue;
    refuse(fmt::format("\"{}\", which moves by a model or as a mean of others", asked),
           "a point mass that was marked in the images; there is " + names_text(all));
  }
  refuse(fmt::format("{} of the name or number \"{}\"", found.empty() ? "none" : "several", asked),
         "one of " + names_text(all));
  return all.front();  // not reached
}

struct Place {
  long step = 0;
  double X = 0.0, Y = 0.0;  ///< metres, along the project's axes
};

/// For each position, whether it lies on the straight line between the two adjacent marks and is not a mark itself.
std::vector<bool> filled_in(const TrackerMass& mass) {
  const std::set<long> keys(mass.key_frames.begin(), mass.key_frames.end());
  const auto& points = mass.points;
  std::vector<bool> filled(points.size(), false);
  std::optional<std::size_t> last_key;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!keys.contains(points[i].frame)) continue;
    for (std::size_t k = last_key ? *last_key + 1 : i; k < i; ++k) {
      const TrackerPoint &a = points[*last_key], &b = points[i], &here = points[k];
      const double part = static_cast<double>(here.frame - a.frame) / static_cast<double>(b.frame - a.frame);
      filled[k] = std::hypot(a.x_px + part * (b.x_px - a.x_px) - here.x_px,
                             a.y_px + part * (b.y_px - a.y_px) - here.y_px) < kFilledPx;
    }
    last_key = i;
  }
  return filled;
}

const TrackerAxes& axes_at(const TrackerProject& project, long frame) {
  return std::prev(project.axes.upper_bound(frame))->second;
}

std::vector<Place> places_of(const TrackerProject& project, const TrackerMass& mass, double metres,
                             std::vector<Note>& notes) {
  std::vector<Place> places;
  const std::vector<bool> is_filled = filled_in(mass);
  std::size_t filled = 0, outside = 0;
  for (std::size_t i = 0; i < mass.points.size(); ++i) {
    const TrackerPoint& point = mass.points[i];
    const long since = point.frame - project.first_frame;
    if (since < 0 || since % project.step != 0 || (project.steps && since / project.step >= *project.steps)) {
      ++outside;
      continue;
    }
    if (is_filled[i]) {
      ++filled;
      continue;
    }
    const TrackerAxes& axes = axes_at(project, point.frame);
    const double u = (point.x_px - axes.origin_x_px) / axes.scale_x_px;
    const double w = -(point.y_px - axes.origin_y_px) / axes.scale_y_px;
    const double cosine = std::cos(axes.angle_rad), sine = std::sin(axes.angle_rad);
    places.push_back({since / project.step, metres * (u * cosine + w * sine), metres * (w * cosine - u * sine)});
  }
  if (outside > 0) {
    notes.emplace_back(PositionsOutsideClip{outside});
  }
  if (filled > 0) {
    notes.emplace_back(PositionsFilledIn{filled});
  }
  return places;
}

double extent(const std::vector<Place>& places, double Place::*coordinate) {
  const auto [low, high] = std::minmax_element(
      places.begin(), places.end(), [&](const Place& a, const Place& b) { return a.*coordinate < b.*coordinate; });
  return (*high).*coordinate - (*low).*coordinate;
}

/// The coordinate of larger extent; along Y, the direction that points to the image's lower edge.
Downhill found_downhill(const TrackerProject& project, const std::vector<Place>& places) {
  if (extent(places, &Place::Y) <= extent(places, &Place::X)) return Downhill::plus_x;
  const bool up_in_image = std::cos(axes_at(project, project.first_frame).angle_rad) >= 0.0;
  return up_in_image ? Downhill::minus_y : Downhill::plus_y;
}

/// Angle between the chosen coordinate and the line fitted to the positions by total least squares; 0 if they do not
/// form a line.
double angle_to_line(const std::vector<Place>& places, bool along_y) {
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  const auto count = static_cast<double>(places.size());
  for (const Place& place : places) {
    mean_x += place.X / count;
    mean_y += place.Y / count;
  }
  for (const Place& place : places) {
    xx += (place.X - mean_x) * (place.X - mean_x);
    xy += (place.X - mean_x) * (place.Y - mean_y);
    yy += (place.Y - mean_y) * (place.Y - mean_y);
  }
  const double half = 0.5 * (xx + yy), apart = std::hypot(0.5 * (xx - yy), xy);
  if (half - apart > kMostAcrossOverAlong * (half + apart)) return 0.0;
  const double from_x = std::abs(0.5 * std::atan2(2.0 * xy, xx - yy));
  return along_y ? 0.5 * std::numbers::pi - from_x : from_x;
}

double metres_of(const fs::path& file, const TrackerProject& project, std::vector<Note>& notes) {
  if (project.length_unit.empty()) {
    notes.emplace_back(NoLengthUnit{});
    return 1.0;
  }
  if (const auto metres = metres_per(project.length_unit)) return *metres;
  throw base::InputError(base::Issue{file.string(), 0, "length_unit", fmt::format("\"{}\"", project.length_unit),
                                     "m, dm, cm, mm, um, km, in or ft"});
}

/// Takes every step from the first position to the last as a frame, whether the mass was marked there or not.
void take_steps_as_frames(const TrackerProject& project, const std::vector<Place>& places, TrackData& track) {
  const auto time_of = [&](long step) { return project.time_s(project.first_frame + step * project.step); };
  const long first = places.front().step;
  constexpr long kMostLost = 1000;      // steps for each position: a mark far after the others is a slip
  constexpr long kMostSteps = 1000000;  // 83 minutes at 200 frames a second
  if (places.back().step - first > std::min(kMostSteps, kMostLost * static_cast<long>(places.size()))) {
    throw base::InputError(
        base::Issue{project.shown_as, 0, "framedata",
                    fmt::format("{} positions over {} steps", places.size(), places.back().step - first),
                    "a mass that is marked in more than one step of a thousand, over a million steps at most"});
  }
  for (long step = first; step <= places.back().step; ++step) track.frame_t_s.push_back(time_of(step));
  for (const Place& place : places) {
    track.t_s.push_back(time_of(place.step));
    track.frame.push_back(static_cast<std::size_t>(place.step - first));
  }
  track.frame_rate_hz = 1e3 / (project.frame_ms * static_cast<double>(project.step));
}

}  // namespace

bool looks_like_tracker_project(const fs::path& file) {
  const std::string first = first_bytes_of(file, kLookedAt);
  return is_zip_archive(first) ? !is_spreadsheet(file) : is_xml(first);
}

std::vector<std::string> point_masses_of(const fs::path& file) {
  const std::vector<TrackerProject> projects = projects_of(file);
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates_of(projects)) names.push_back(candidate.full_name);
  return names;
}

TrackData read_tracker_project(const fs::path& file, std::optional<Downhill> downhill, const std::string& point_mass) {
  const std::vector<TrackerProject> projects = projects_of(file);
  const Candidate chosen = choose(file, projects, point_mass);
  const TrackerProject& project = *chosen.project;
  TrackData track;
  const double metres = metres_of(file, project, track.notes);
  const std::vector<Place> places = places_of(project, *chosen.mass, metres, track.notes);
  if (places.size() < kFewestTrackPoints) {
    throw base::InputError(base::Issue{file.string(), 0, fmt::format("point mass \"{}\"", chosen.mass->name),
                                       fmt::format("{} positions", places.size()), few_points_expectation()});
  }
  const Downhill down = downhill ? *downhill : found_downhill(project, places);
  const bool along_y = is_along_y(down);
  const double sign = sign_of(down);
  for (const Place& place : places) track.x_m.push_back(sign * (along_y ? place.Y : place.X));
  take_steps_as_frames(project, places, track);
  track.notes.emplace_back(PointMassTaken{chosen.full_name, name_of(down), along_y, downhill.has_value()});
  const double off = angle_to_line(places, along_y);
  if (off > kSlantedRad) {
    track.notes.emplace_back(MassMovesAslant{off * base::kDegreesPerRad, 1.0 - std::cos(off), along_y});
  }
  leave_out_false_positions(track);
  return track;
}

}  // namespace glidelab::core
