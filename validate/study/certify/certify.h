/// Can the stated intervals be trusted on this recording? Twins of it are recorded, analysed as it would be, and
/// compared with their truth.
///
/// Of n twins the stated 95 % intervals that hold the truth are counted (run_shares.h). Changes are then made one at a
/// time to the twin, and the same seeds recorded again: how much the root mean square of the errors falls says what
/// limits the recording. Source: Talts and others 2018, and Sailynoja and others 2025, who calibrate at the posterior.
#pragma once

#include <cstdint>
#include <filesystem>
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

struct CertifyOptions {
  std::size_t runs = 40;
  fit::Estimator estimator = fit::default_estimator();
  std::optional<double> bandwidth_s = {};
  std::uint64_t seed = 1;
  int jobs = 1;
  bool changes = true;  ///< find what limits the recording, too
  core::TrackFileOptions bare = {};
};

/// InputError for what is wrong with a folder or file, for a table of lines, for fewer or more runs than kFewestTwins
/// to kMostTwins, and where the fitted motions are no scenario that can be recorded.
Certificate certify(const std::vector<std::filesystem::path>& folders, const CertifyOptions& options,
                    const base::Progress& progress = base::no_progress);

/// The same of a twin that is made already.
Certificate certify_twin(const RecordingTwin& twin, const CertifyOptions& options,
                         const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
