/// [sensor] and [codec]: from electrons to the codes in a file.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"

namespace glidelab::render {
namespace {

using base::TomlTable;

void read_converter(const TomlTable& table, Sensor& sensor) {
  sensor.bit_depth = static_cast<int>(table.integer_or("bit_depth", sensor.bit_depth, 8, 16));
  if (!table.has("converter_bits")) return;
  sensor.converter_bits = static_cast<int>(table.integer("converter_bits", 8, 16));
  if (*sensor.converter_bits < sensor.bit_depth) {
    table.reject("converter_bits", fmt::format("{}", *sensor.converter_bits),
                 fmt::format("at least the {} bits of the codes that come out", sensor.bit_depth));
  }
}

void read_charge(const TomlTable& table, Sensor& sensor) {
  const double codes = sensor.largest_converter_code();
  sensor.full_well_e = table.number_or("full_well_e", sensor.full_well_e, {10.0, 1e7, false, false});
  sensor.read_noise_e = table.number_or("read_noise_e", sensor.read_noise_e, base::between(0.0, 1e5));
  sensor.offset_dn = table.number_or("offset_dn", std::round(codes / 128.0), base::between(0.0, 0.5 * codes));
  sensor.gain_dn_per_e =
      table.number_or("gain_dn_per_e", (codes - sensor.offset_dn) / sensor.full_well_e, {0.0, 1e5, true, false});
}

void read_pixels(const TomlTable& table, PixelSpread& pixels) {
  pixels.dark_signal_e_s = table.number_or("dark_signal_e_s", 0.0, base::between(0.0, 1e7));
  pixels.prnu = table.number_or("prnu", 0.0, base::between(0.0, 0.5));
  pixels.dsnu_e = table.number_or("dsnu_e", 0.0, base::between(0.0, 1e5));
  pixels.hot_fraction = table.number_or("hot_fraction", 0.0, base::between(0.0, 1.0));
  pixels.hot_signal_e_s = table.number_or("hot_signal_e_s", 0.0, base::between(0.0, 1e9));
  pixels.dead_fraction = table.number_or("dead_fraction", 0.0, base::between(0.0, 1.0));
  if (pixels.hot_fraction > 0.0 && !(pixels.hot_signal_e_s > 0.0) && !table.has("hot_signal_e_s")) {
    table.reject("hot_signal_e_s", "nothing",
                 "what a hot pixel has beyond the dark signal, where hot_fraction is given");
  }
}

bool rises(const std::vector<double>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!(values[i] > values[i - 1])) return false;
  }
  return values.size() > 1 && values.front() == 0.0 && values.back() == 1.0;
}

void read_tone(const TomlTable& table, ToneCurve& tone) {
  const std::string word = table.word("tone", {"linear", "gamma", "bt709", "table"}, "linear");
  if (word == "gamma") {
    tone.kind = ToneCurve::Kind::gamma;
    tone.gamma = table.number("gamma", base::between(0.2, 5.0));
  } else if (word == "bt709") {
    tone.kind = ToneCurve::Kind::bt709;
  } else if (word == "table") {
    const std::vector<double> from = table.numbers("tone_from", 0), to = table.numbers("tone_to", 0);
    if (rises(from) && rises(to) && from.size() == to.size()) {
      tone = {ToneCurve::Kind::table, tone.gamma, from, to};
      return;
    }
    // The curve is refused and set to linear: code that follows computes with the curve and must not use a missing
    // table.
    table.reject("tone_to", fmt::format("{} numbers, but {} in tone_from", to.size(), from.size()),
                 "as many in both, rising from 0 to 1");
  }
}

void read_colour(const TomlTable& table, Sensor& sensor) {
  if (table.word("colour", {"mono", "bayer"}, "mono") == "mono") return;
  sensor.colour = Colour::bayer;
  if (const auto response = table.maybe_numbers("colour_response", 3, {0.01, 1.0, false, false})) {
    sensor.colour_response = {(*response)[0], (*response)[1], (*response)[2]};
  }
}

void read_white(const TomlTable& table, const Scenario& scenario, Exposure& exposure) {
  exposure.quantum_efficiency = table.number_or("quantum_efficiency", 1.0, {0.0, 1.0, true, false});
  exposure.white_photons_s = table.maybe_number("white_photons_s", base::above(0.0));
  const bool linear = scenario.sensor.tone.kind == ToneCurve::Kind::linear;
  const base::Range levels{0.01, linear ? 10.0 : 1.0, false, false};
  if (!exposure.white_photons_s) {
    exposure.white_level = table.number_or("white_level", exposure.white_level, levels);
    if (!(electrons_of_white(scenario) > 0.0)) {
      table.reject("white_level", fmt::format("{}", exposure.white_level), "a white above the offset");
    }
  } else if (table.has("white_level")) {
    table.reject("white_level", "a level as well as white_photons_s", "one of the two");
    table.number("white_level");
  }
}

void read_sensor(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  Sensor& sensor = scenario.sensor;
  read_converter(*table, sensor);
  read_charge(*table, sensor);
  read_pixels(*table, sensor.pixels);
  read_tone(*table, sensor.tone);
  read_colour(*table, sensor);
  read_white(*table, scenario, scenario.exposure);
}

void sensor_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  const Sensor& sensor = scenario.sensor;
  camera["sensor"] = {{"bit_depth", sensor.bit_depth},
                      {"full_well_e", sensor.full_well_e},
                      {"read_noise_e", sensor.read_noise_e},
                      {"gain_dn_per_e", sensor.gain_dn_per_e},
                      {"offset_dn", sensor.offset_dn},
                      {"converter_bits", sensor.converter_bits.value_or(sensor.bit_depth)},
                      {"dark_signal_e_s", sensor.pixels.dark_signal_e_s},
                      {"prnu", sensor.pixels.prnu},
                      {"dsnu_e", sensor.pixels.dsnu_e},
                      {"hot_fraction", sensor.pixels.hot_fraction},
                      {"dead_fraction", sensor.pixels.dead_fraction},
                      {"tone", name_of(sensor.tone.kind)},
                      {"colour", sensor.colour == Colour::bayer ? "bayer" : "mono"},
                      {"quantum_efficiency", scenario.exposure.quantum_efficiency},
                      {"white_e", electrons_of_white(scenario)}};
}

void read_h264(const TomlTable& table, Scenario& scenario) {
  Compression& compression = scenario.compression;
  compression.gop = static_cast<int>(table.integer_or("gop", compression.gop, 1, 10'000));
  compression.bitrate_kbit_s = table.number_or("bitrate_kbit_s", 0.0, base::between(10.0, 1e6));
  if (table.has("bitrate_kbit_s") && table.has("crf")) {
    table.reject("crf", "a constant rate factor as well as a bit rate", "one of the two");
  }
  compression.crf = table.number_or("crf", compression.crf, base::between(0.0, 51.0));
  const Camera& camera = scenario.camera;
  if (camera.width_px % 2 != 0 || camera.height_px % 2 != 0) {
    table.reject("name", fmt::format("text \"h264\" for {} x {} pixels", camera.width_px, camera.height_px),
                 "even numbers of pixels");
  }
}

void read_container(const TomlTable& table, Scenario& scenario) {
  if (!table.has("container")) return;
  const std::string name = table.word("container", {"mkv", "avi", "mp4"});
  const Container container = name == "mkv" ? Container::mkv : name == "avi" ? Container::avi : Container::mp4;
  scenario.compression.container = container;
  if (!fits(scenario.codec, container)) {
    table.reject("container", fmt::format("text \"{}\" for {}", name, name_of(scenario.codec)),
                 "mkv for magicyuv and ffv1, avi for raw, avi, mkv or mp4 for mjpeg, mp4 or mkv for h264");
  }
}

void read_codec(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  const std::string name = table->word("name", {"magicyuv", "ffv1", "raw", "png", "mjpeg", "h264"});
  for (const Codec codec : {Codec::magicyuv, Codec::ffv1, Codec::raw, Codec::png, Codec::mjpeg, Codec::h264}) {
    if (name == name_of(codec)) scenario.codec = codec;
  }
  Compression& compression = scenario.compression;
  if (scenario.codec == Codec::mjpeg) {
    compression.quality = static_cast<int>(table->integer_or("quality", compression.quality, 1, 100));
  }
  if (scenario.codec == Codec::h264) read_h264(*table, scenario);
  read_container(*table, scenario);
}

/// With more than 8 bits only PNG can store the codes, and not every container stores time stamps.
void settle_codec(const TomlTable& root, Scenario& scenario) {
  const bool deep = scenario.sensor.bit_depth > 8;
  if (const std::optional<TomlTable> table = root.maybe_table("codec"); !table) {
    scenario.codec = deep ? Codec::png : Codec::magicyuv;
  } else if (deep && scenario.codec != Codec::png) {
    table->reject("name", fmt::format("text \"{}\"", name_of(scenario.codec)),
                  fmt::format("\"png\" for {} bits; the others hold 8", scenario.sensor.bit_depth));
  }
  const Container container = scenario.compression.container.value_or(usual_container(scenario.codec));
  if (scenario.recording.clock.variable && (container == Container::avi || container == Container::folder)) {
    root.table("clock").reject("variable", fmt::format("a variable rate for {}", name_of(scenario.codec)),
                               "a codec in mkv or mp4, which hold time stamps");
  }
}

void codec_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  camera["codec"] = name_of(scenario.codec);
}

}  // namespace

const ScenarioSection sections::sensor = {
    .name = "sensor",
    .help = "noise, gain, depth, tone and colours of the sensor, and how bright white is",
    .in_camera_file = true,
    .read = read_sensor,
    .settle = nullptr,
    .truth = sensor_truth,
    .ideal = sections::keep};

const ScenarioSection sections::codec = {.name = "codec",
                                         .help = "how the frames are compressed, and in which container",
                                         .in_camera_file = true,
                                         .read = read_codec,
                                         .settle = settle_codec,
                                         .truth = codec_truth,
                                         .ideal = sections::keep};

}  // namespace glidelab::render
