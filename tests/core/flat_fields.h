/// Flat fields of a camera whose numbers are known, made by a generator of the tests' own (std::mt19937_64, Poisson,
/// normal, fixed patterns), and written as a folder for read_flat_field_folder.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <string>
#include <vector>

#include "base/files/file_io.h"

namespace glidelab::tests {

struct TrueCamera {
  int width = 128;
  int height = 96;
  int bit_depth = 12;
  double gain_dn_per_e = 0.4;
  double read_noise_e = 6.0;
  double offset_dn = 64.0;
  double full_well_e = 9000.0;
  double dark_signal_e_s = 0.0;
  double prnu = 0.01;
  double dsnu_e = 3.0;
  double shading = 0.0;                             ///< how much darker the corners are, relative
  double mosaic = 1.0;                              ///< answer of three of the four colours beside the first one's
  std::function<double(double)> tone;               ///< on codes / largest code, before rounding
  std::function<void(cv::Mat&)> after;              ///< on the codes as CV_32F, before rounding: denoising and the like
  std::vector<std::pair<cv::Point, double>> hot_e;  ///< extra electrons in these pixels
  std::vector<cv::Point> dead;                      ///< pixels that see no light
  int largest_code() const { return (1 << bit_depth) - 1; }
};

/// One sensor of that make, with patterns of its own; a stream of random numbers.
class FlatFieldCamera {
 public:
  FlatFieldCamera(TrueCamera camera, unsigned seed) : camera_(std::move(camera)), random_(seed) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < camera_.width * camera_.height; ++i) {
      answer_.push_back(1.0 + camera_.prnu * normal(random_));
      extra_dn_.push_back(camera_.gain_dn_per_e * camera_.dsnu_e * normal(random_));
      extra_e_.push_back(0.0);
      const int x = i % camera_.width;
      const int y = i / camera_.width;
      const double u = 2.0 * x / camera_.width - 1.0;
      const double v = 2.0 * y / camera_.height - 1.0;
      answer_.back() *= 1.0 - 0.5 * camera_.shading * (u * u + v * v);
      if (x % 2 != 0 || y % 2 != 0) answer_.back() *= camera_.mosaic;
    }
    for (const auto& [at, electrons] : camera_.hot_e) extra_e_[index(at)] = electrons;
    for (const cv::Point& at : camera_.dead) answer_[index(at)] = 0.0;
  }

  cv::Mat frame(double light_e, double exposure_s) {
    std::normal_distribution<double> read(0.0, camera_.read_noise_e);
    cv::Mat codes(camera_.height, camera_.width, CV_32F);
    for (std::size_t i = 0; i < answer_.size(); ++i) {
      const double expected = light_e * answer_[i] + camera_.dark_signal_e_s * exposure_s + extra_e_[i];
      double electrons = 0.0;
      if (expected > 0.0) electrons = static_cast<double>(std::poisson_distribution<long>(expected)(random_));
      electrons = std::min(electrons, camera_.full_well_e);
      if (camera_.read_noise_e > 0.0) electrons += read(random_);
      double code = camera_.gain_dn_per_e * electrons + camera_.offset_dn + extra_dn_[i];
      if (camera_.tone)
        code = camera_.tone(std::clamp(code / camera_.largest_code(), 0.0, 1.0)) * camera_.largest_code();
      codes.ptr<float>()[i] = static_cast<float>(code);
    }
    if (camera_.after) camera_.after(codes);
    cv::Mat rounded;  // convertTo rounds and stops at the ends of 16 bits
    cv::Mat(cv::min(codes, camera_.largest_code())).convertTo(rounded, CV_16U);
    if (camera_.bit_depth == 8) rounded.convertTo(rounded, CV_8U);
    return rounded;
  }

  const TrueCamera& camera() const { return camera_; }

 private:
  std::size_t index(cv::Point at) const { return static_cast<std::size_t>(at.y * camera_.width + at.x); }

  TrueCamera camera_;
  std::mt19937_64 random_;
  std::vector<double> answer_;
  std::vector<double> extra_dn_;
  std::vector<double> extra_e_;
};

inline void write_png(const std::filesystem::path& file, const cv::Mat& codes) {
  cv::imwrite(file.string(), codes, {cv::IMWRITE_PNG_COMPRESSION, 1});
}

/// Which frames a folder gets. Levels in expected electrons.
struct FlatFieldPlan {
  std::vector<double> light_e;
  int flat_frames = 2;
  int dark_frames = 8;
  double exposure_s = 0.01;
  std::vector<double> dark_exposures_s;  ///< of dark-0, dark-1, …
  bool by_exposure = false;              ///< levels differ by exposure, at 1e6 e-/s
  std::function<double(int)> flicker;    ///< factor on the light of each frame of a level
};

/// `count` levels from dark to `most_e`, evenly.
inline std::vector<double> even_levels(int count, double most_e) {
  std::vector<double> levels;
  for (int i = 1; i <= count; ++i) levels.push_back(most_e * i / count);
  return levels;
}

inline std::string settings(const TrueCamera& camera, const FlatFieldPlan& plan) {
  std::string text = fmt::format("format = 1\nname = \"test camera\"\nbit_depth = {}\nexposure_s = {}\n",
                                 camera.bit_depth, plan.exposure_s);
  text += "[exposures_s]\n";
  for (std::size_t i = 0; i < plan.dark_exposures_s.size(); ++i) {
    text += fmt::format("dark-{} = {}\n", i, plan.dark_exposures_s[i]);
  }
  for (std::size_t i = 0; plan.by_exposure && i < plan.light_e.size(); ++i) {
    text += fmt::format("flat-{:02} = {}\n", i, plan.light_e[i] / 1e6);
  }
  return text;
}

inline void write_flat_fields(const std::filesystem::path& folder, FlatFieldCamera& camera, const FlatFieldPlan& plan) {
  namespace fs = std::filesystem;
  const auto write = [&](const std::string& set, int frames, double light_e, double exposure_s) {
    fs::create_directories(folder / set);
    for (int f = 0; f < frames; ++f) {
      const double factor = plan.flicker ? plan.flicker(f) : 1.0;
      write_png(folder / set / fmt::format("{:03}.png", f), camera.frame(light_e * factor, exposure_s));
    }
  };
  write("dark", plan.dark_frames, 0.0, plan.exposure_s);
  for (std::size_t i = 0; i < plan.dark_exposures_s.size(); ++i) {
    write(fmt::format("dark-{}", i), plan.dark_frames, 0.0, plan.dark_exposures_s[i]);
  }
  for (std::size_t i = 0; i < plan.light_e.size(); ++i) {
    write(fmt::format("flat-{:02}", i), plan.flat_frames, plan.light_e[i],
          plan.by_exposure ? plan.light_e[i] / 1e6 : plan.exposure_s);
  }
  base::write_file(folder / "characterize.toml", settings(camera.camera(), plan));
}

}  // namespace glidelab::tests
