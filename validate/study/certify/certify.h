/// Can the stated intervals be trusted on this recording? Twins of it are recorded, analysed in the same way, and
/// compared with their truth.
///
/// For n twins, the stated 95 % intervals that contain the truth are counted (certificate.h). The twin is then changed
/// in one respect at a time and recorded again with the same seeds: the reduction of the rms error shows what limits
/// the recording. Filming takes long: of each change five twins are filmed first, and five more where these leave open
/// whether it helps. Source: Talts et al. 2018, and Sailynoja et al. 2025, who calibrate at the posterior.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/track/bare_track.h"
#include "fit/estimators.h"
#include "validate/study/certify/certificate.h"
#include "validate/study/certify/recording_twin.h"

namespace glidelab::validate {

inline constexpr std::size_t kFewestTwins = 20, kMostTwins = 200;

/// What is about to be filmed.
struct FilmingSize {
  std::size_t twins = 0;                                  ///< of the recording
  std::size_t least_of_changes = 0, most_of_changes = 0;  ///< further twins, each with a change
  double processor_time_s = 0;  ///< for all of them at most, from the first, which is filmed for this purpose
};

struct CertifyOptions {
  std::size_t runs = 40;
  fit::Estimator estimator = fit::default_estimator();
  std::optional<double> bandwidth_s = {};
  std::uint64_t seed = 1;
  int jobs = 1;
  bool changes = true;  ///< also find what limits the recording
  core::TrackFileOptions bare = {};
  std::function<void(const FilmingSize&)> before_filming = {};
};

/// InputError for any error in a folder or file, for a table of lines, for a number of runs outside kFewestTwins to
/// kMostTwins, and if the fitted motions are not a scenario that can be recorded.
Certificate certify(const std::vector<std::filesystem::path>& folders, const CertifyOptions& options,
                    const base::Progress& progress = base::no_progress);

/// The same for a twin that already exists.
Certificate certify_twin(const RecordingTwin& twin, const CertifyOptions& options,
                         const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
