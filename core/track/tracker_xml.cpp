#include "core/track/tracker_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/track/container/xml_document.h"

namespace glidelab::core {
namespace {

constexpr long kLastFrame = 100'000'000;  // eleven days at 100 frames a second; differences of frames do not overflow
constexpr std::string_view kPanel = "org.opensourcephysics.cabrillo.tracker.TrackerPanel";
constexpr std::string_view kAxes = "org.opensourcephysics.media.core.ImageCoordSystem";
constexpr std::string_view kPointMass = "org.opensourcephysics.cabrillo.tracker.PointMass";

std::string shown(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  constexpr std::size_t kMost = 80;  // characters of a foreign text in a message
  return text.size() > kMost ? text.substr(0, kMost) + "\xE2\x80\xA6" : text;
}

/// The last part of a Java class: "PointMass".
std::string class_of(pugi::xml_node object) {
  const std::string name = object.attribute("class").value();
  return shown(name.substr(name.rfind('.') + 1));
}

/// One object of the project with its properties and its location.
class Object {
 public:
  Object(pugi::xml_node node, std::string path, const std::string& file)
      : node_(node), path_(std::move(path)), file_(file) {}

  bool is(std::string_view class_name) const { return node_.attribute("class").value() == class_name; }
  std::string class_name() const { return class_of(node_); }
  std::string text(const char* name) const { return shown(property(name).text().get()); }
  bool has(const char* name) const { return !property(name).empty(); }
  bool flag(const char* name) const { return std::strcmp(property(name).text().get(), "true") == 0; }
  std::string key(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
  }

  std::optional<Object> object(const char* name) const {
    const pugi::xml_node inner = property(name).child("object");
    if (inner.empty()) return {};
    return Object(inner, key(name), file_);
  }

  Object needed(const char* name) const {
    if (auto inner = object(name)) return *std::move(inner);
    refuse(name, "nothing", "an object, as Tracker writes it");
  }

  /// Java writes NaN for a missing value; empty if the property is missing.
  std::optional<double> number(const char* name) const {
    const pugi::xml_node at = property(name);
    if (at.empty()) return {};
    const std::string_view text = at.text().get();
    if (text == "NaN") return {};
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
      refuse(name, fmt::format("\"{}\"", shown(std::string(text))), "a number");
    }
    return value;
  }

  double needed_number(const char* name) const {
    const auto value = number(name);
    if (!value) refuse(name, "nothing", "a number");
    return *value;
  }

  std::optional<long> whole(const char* name, long least) const {
    const auto value = number(name);
    if (!value) return {};
    if (*value != std::floor(*value) || *value < static_cast<double>(least) ||
        *value > static_cast<double>(kLastFrame)) {
      refuse(name, fmt::format("{}", *value), fmt::format("a whole number from {} to {}", least, kLastFrame));
    }
    return static_cast<long>(*value);
  }

  /// The elements "[n]" of an array with their n, in rising order.
  std::vector<std::pair<long, Object>> array(const char* name) const {
    std::vector<std::pair<long, Object>> elements;
    for (const pugi::xml_node element : property(name).children("property")) {
      const std::string_view index = element.attribute("name").value();
      long n = -1;
      const auto [end, error] =
          std::from_chars(index.data() + std::min<std::size_t>(1, index.size()), index.data() + index.size(), n);
      if (error != std::errc{} || n < 0 || n > kLastFrame || index.substr(0, 1) != "[" ||
          std::string_view(end, index.data() + index.size()) != "]") {
        refuse(name, fmt::format("an element \"{}\"", shown(std::string(index))), "\"[0]\", \"[1]\" and so on");
      }
      if (!elements.empty() && n <= elements.back().first) {
        refuse(name, fmt::format("[{}] after [{}]", n, elements.back().first), "elements in their order");
      }
      const pugi::xml_node object = element.child("object");
      if (!object.empty()) elements.emplace_back(n, Object(object, fmt::format("{}[{}]", key(name), n), file_));
    }
    return elements;
  }

  std::vector<Object> collection(const char* name) const {
    std::vector<Object> items;
    for (const pugi::xml_node item : property(name).children("property")) {
      const pugi::xml_node object = item.child("object");
      if (!object.empty()) items.emplace_back(object, fmt::format("{}[{}]", key(name), items.size()), file_);
    }
    return items;
  }

  /// "{0,3,7}", the form in which an array of whole numbers is written.
  std::vector<long> whole_numbers(const char* name) const {
    std::vector<long> numbers;
    std::string_view text = property(name).child("property").text().get();
    while (!text.empty()) {
      const auto first = text.find_first_of("0123456789");
      if (first == std::string_view::npos) break;
      text.remove_prefix(first);
      long value = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc{}) refuse(name, "a number that is too large", "frames");
      numbers.push_back(value);
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    return numbers;
  }

  [[noreturn]] void refuse(std::string_view name, std::string found, std::string expected) const {
    throw base::InputError(base::Issue{file_, 0, key(name), std::move(found), std::move(expected)});
  }

 private:
  pugi::xml_node property(const char* name) const { return node_.find_child_by_attribute("property", "name", name); }

  pugi::xml_node node_;
  std::string path_;
  const std::string& file_;
};

constexpr const char* kWanted = "a project of Tracker (.trk, or .trz with one in it), or a table of positions as text";

/// In Tracker, a value that is not fixed holds from its key frame to the next one; of a fixed value, the last one
/// stated counts in all frames.
std::map<long, TrackerAxes> axes_of(const Object& panel) {
  if (panel.has("referenceframe")) {
    panel.refuse("referenceframe", "axes that move with \"" + panel.text("referenceframe") + "\"",
                 "axes of the image (in Tracker: Coordinate System, Reference Frame, Default)");
  }
  const Object coords = panel.needed("coords");
  if (!coords.is(kAxes)) {
    panel.refuse("coords", "axes of the kind " + coords.class_name(),
                 "axes of the image (in Tracker: Coordinate System, Reference Frame, Default)");
  }
  std::map<long, TrackerAxes> axes;
  for (const auto& [frame, object] : coords.array("framedata")) {
    TrackerAxes& at = axes[frame];
    at = {object.needed_number("xorigin"), object.needed_number("yorigin"),
          object.needed_number("angle") * base::kRadPerDegree, object.needed_number("xscale"),
          object.needed_number("yscale")};
    for (const char* const scale : {"xscale", "yscale"}) {
      if (object.needed_number(scale) <= 0.0)
        object.refuse(scale, object.text(scale), "pixels a unit of length, above 0");
    }
  }
  if (!axes.contains(0)) coords.refuse("framedata", axes.empty() ? "nothing" : "axes without those of frame 0", "axes");
  const TrackerAxes last = axes.rbegin()->second;
  for (auto& [frame, at] : axes) {
    if (coords.flag("fixedorigin"))
      std::tie(at.origin_x_px, at.origin_y_px) = std::tie(last.origin_x_px, last.origin_y_px);
    if (coords.flag("fixedangle")) at.angle_rad = last.angle_rad;
    if (coords.flag("fixedscale")) std::tie(at.scale_x_px, at.scale_y_px) = std::tie(last.scale_x_px, last.scale_y_px);
  }
  return axes;
}

TrackerMass mass_of(const Object& track) {
  TrackerMass mass{track.text("name"), {}, track.whole_numbers("keyFrames")};
  for (const auto& [frame, object] : track.array("framedata")) {
    const auto x = object.number("x"), y = object.number("y");
    if (x && y) mass.points.push_back({frame, *x, *y});
  }
  return mass;
}

/// Models, and centroids of other masses: each has the properties of a point mass but no marks.
bool is_model(const Object& track) {
  const std::string name = track.class_name();
  return name == "CenterOfMass" || name.ends_with("Particle") || name.starts_with("Dynamic") ||
         name.starts_with("ParticleDataTrack");
}

}  // namespace

bool is_xml(std::string_view first_bytes) {
  if (first_bytes.starts_with("\xEF\xBB\xBF")) first_bytes.remove_prefix(3);
  const auto first = first_bytes.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && first_bytes[first] == '<';
}

TrackerProject parse_tracker_project(std::string_view xml, const std::string& shown_as) {
  TrackerProject project;
  project.shown_as = shown_as;
  const pugi::xml_document document = parse_xml(xml, shown_as, kWanted);
  const pugi::xml_node root = document.document_element();
  const Object panel(root, "", shown_as);
  if (std::strcmp(root.name(), "object") != 0 || !panel.is(kPanel)) {
    const bool is_object = std::strcmp(root.name(), "object") == 0;
    throw base::InputError(base::Issue{
        shown_as, 0, "",
        fmt::format("XML with {}", is_object ? "a " + panel.class_name() : fmt::format("<{}>", shown(root.name()))),
        kWanted});
  }
  project.length_unit = panel.text("length_unit");
  const Object clip = panel.needed("videoclip");
  project.first_frame = clip.whole("startframe", 0).value_or(0);
  project.step = clip.whole("stepsize", 1).value_or(1);
  project.steps = clip.whole("stepcount", 1);
  project.start_ms = clip.number("starttime").value_or(0.0);
  const Object control = panel.needed("clipcontrol");
  project.frame_ms = control.needed_number("delta_t");
  if (project.frame_ms <= 0.0)
    control.refuse("delta_t", control.text("delta_t"), "milliseconds from frame to frame, above 0");
  project.axes = axes_of(panel);
  for (const Object& track : panel.collection("tracks")) {
    if (track.is(kPointMass)) {
      project.masses.push_back(mass_of(track));
    } else if (is_model(track)) {
      project.models.push_back(track.text("name"));
    }
  }
  return project;
}

}  // namespace glidelab::core
