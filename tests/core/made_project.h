/// Small projects as Tracker writes them, and archives of them, for the tests of core/.
#pragma once

#include <fmt/format.h>
#include <zip.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace glidelab::tests {

inline std::string object_text(const std::string& class_name, const std::string& inner) {
  return fmt::format("<object class=\"org.opensourcephysics.{}\">\n{}</object>\n", class_name, inner);
}

inline std::string property_text(const std::string& name, const std::string& type, const std::string& inner) {
  return fmt::format("<property name=\"{}\" type=\"{}\">{}</property>\n", name, type, inner);
}

inline std::string number_text(const std::string& name, double value) {
  return property_text(name, "double", fmt::format("{}", value));
}

/// Axes of a frame: origin in pixels, angle in degrees, pixels a unit of length.
struct MadeAxes {
  long frame = 0;
  double origin_x = 0.0, origin_y = 0.0, angle_deg = 0.0, scale = 100.0;
};

struct MadeMass {
  std::string name;
  std::vector<std::pair<long, std::pair<double, double>>> points;  ///< frame, pixels
  std::string key_frames = {};                                     ///< "{0,3}"
  std::string class_name = "cabrillo.tracker.PointMass";
};

struct MadeProject {
  std::vector<MadeMass> masses;
  std::vector<MadeAxes> axes = {{}};
  bool fixed = true;
  std::string unit = "m";
  std::string clip = "<property name=\"startframe\" type=\"int\">0</property>";
  double frame_ms = 10.0;
  std::string more = {};  ///< properties of the panel

  std::string text() const {
    const std::string fix = fixed ? "true" : "false";
    std::string frames, tracks;
    for (const MadeAxes& at : axes) {
      frames += property_text(fmt::format("[{}]", at.frame), "object",
                              object_text("media.core.ImageCoordSystem$FrameData",
                                          number_text("xorigin", at.origin_x) + number_text("yorigin", at.origin_y) +
                                              number_text("angle", at.angle_deg) + number_text("xscale", at.scale) +
                                              number_text("yscale", at.scale)));
    }
    tracks += property_text("item", "object",
                            object_text("cabrillo.tracker.TapeMeasure", property_text("name", "string", "tape")));
    for (const MadeMass& mass : masses) {
      std::string points;
      for (const auto& [frame, place] : mass.points) {
        points += property_text(fmt::format("[{}]", frame), "object",
                                object_text("cabrillo.tracker.PointMass$FrameData",
                                            number_text("x", place.first) + number_text("y", place.second)));
      }
      std::string inner = number_text("mass", 1.0) + property_text("name", "string", mass.name) +
                          property_text("framedata", "array", points);
      if (!mass.key_frames.empty())
        inner += property_text("keyFrames", "array", property_text("array", "string", mass.key_frames));
      tracks += property_text("item", "object", object_text(mass.class_name, inner));
    }
    std::string panel =
        property_text("videoclip", "object", object_text("media.core.VideoClip", clip)) +
        property_text("clipcontrol", "object",
                      object_text("media.core.StepperClipControl", number_text("delta_t", frame_ms))) +
        property_text("coords", "object",
                      object_text("media.core.ImageCoordSystem", property_text("fixedorigin", "boolean", fix) +
                                                                     property_text("fixedangle", "boolean", fix) +
                                                                     property_text("fixedscale", "boolean", fix) +
                                                                     property_text("framedata", "array", frames))) +
        more + property_text("tracks", "collection", tracks);
    if (!unit.empty()) panel += property_text("length_unit", "string", unit);
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + object_text("cabrillo.tracker.TrackerPanel", panel);
  }
};

/// `count` marks in frames `first`, `first` + 1 and so on, at the pixels that `at` gives for 0, 1 and so on.
inline MadeMass made_mass(const std::string& name, long count,
                          const std::function<std::pair<double, double>(double)>& at, long first = 0) {
  MadeMass mass{name, {}};
  for (long i = 0; i < count; ++i) mass.points.push_back({first + i, at(static_cast<double>(i))});
  return mass;
}

inline std::filesystem::path write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// A zip archive with these files.
inline std::filesystem::path write_zip(const std::filesystem::path& file,
                                       const std::vector<std::pair<std::string, std::string>>& entries) {
  zip_t* const zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  if (zip == nullptr) throw std::runtime_error("no zip archive " + file.string());
  for (const auto& [name, bytes] : entries) {
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, bytes.data(), bytes.size(), 0), 0);
  }
  if (zip_close(zip) != 0) throw std::runtime_error("no zip archive " + file.string());
  return file;
}

}  // namespace glidelab::tests
