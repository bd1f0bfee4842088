/// A small film of a scenario's motions, one above the other, each from its own start.
///
/// The renderer draws them (render/) as a perfect camera would take them (render/film/ideal_frames.h), from 3 m before
/// the middle of the track and square to it, so that the track and all of the motions are in the image. Motions, track,
/// glider and light are the scenario's; its camera is not. Frame k shows k / frame_rate_hz after the start; a motion
/// that ends before the longest one keeps its last image.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glidelab::teach {

struct LawFilm {
  std::string mp4;  ///< H.264, as browsers play it: the file's bytes
  int width_px = 0;
  int height_px = 0;
  std::size_t frames = 0;
  double frame_rate_hz = 0.0;
  std::vector<std::string> clips;  ///< of the rows, from above; all are of one height
};

struct LawFilmOptions {
  int width_px = 800;  ///< even
  double frame_rate_hz = 25.0;
  int jobs = 1;  ///< threads that draw what stands still
};

/// InputError for what is wrong with the scenario; EnvironmentError where there is no encoder, or no place for a
/// temporary file.
LawFilm film_law(const std::filesystem::path& scenario, const LawFilmOptions& options = {});

}  // namespace glidelab::teach
