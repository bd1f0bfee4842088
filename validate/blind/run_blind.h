/// Blind cases, one after another or a few at once: each is made, diagnosed by another process, and only then its truth
/// is written; finally all are scored.
///
///     OUT/run.json                     what was asked for; a run with other seeds or effects is refused
///     OUT/cases/0012/                  the experiment folder: all that the diagnosing process is told of
///     OUT/diagnoses/0012/              diagnosis.json, or failure.txt where it could not be diagnosed
///     OUT/diagnoses/0012/left-out/     the same of the diagnosis without the case's effect
///     OUT/diagnoses/0012/seconds.txt   of everyday cases: how long it took
///     OUT/truth/0012.json              written after the diagnosis
///
/// With images a case is rendered in OUT/making-0012/, which is gone before the diagnosis begins.
///
/// A repeated run continues where the last one stopped: a case counts as done when its truth exists.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "fit/outside/outside_estimator.h"
#include "validate/blind/blind_score.h"
#include "validate/blind/case/blind_filmed_case.h"

namespace glidelab::validate {

inline constexpr std::size_t kMostBlindCases = 100000;

struct BlindOptions {
  std::uint64_t seed = 1;
  std::size_t cases = 0;
  bool leave_out = false;  ///< diagnose each case of one effect again, with its effect removed from the list
  std::string only;        ///< an effect that every case has
  bool images = false;     ///< filmed experiments instead of tracks
  bool everyday = false;   ///< tracks with several small imperfections (everyday_case.h)
  int jobs = 1;
  /// Judged on the same everyday cases. It gets a copy of the experiment folder, alone: no truth is in it.
  /// Its answers are not kept: a run that continues asks it about every case again, while the diagnoses stay.
  std::optional<fit::OutsideEstimator> outside = {};
};

/// Diagnoses the folder and leaves diagnosis.json in `out`, in another process; returns "" or the error.
using Diagnoser = std::function<std::string(const std::filesystem::path& folder, const std::filesystem::path& out,
                                            const std::vector<std::string>& without)>;

/// How many cases are complete in `out`: a run continues after them.
std::size_t kept_cases(const BlindOptions& options, const std::filesystem::path& out);

/// InputError for no cases, for an unknown effect, for choices that exclude each other, and if OUT holds another run.
/// `render` is for images only.
std::vector<BlindOutcome> run_blind(const BlindOptions& options, const std::filesystem::path& out,
                                    const Diagnoser& diagnose, const base::Progress& progress = base::no_progress,
                                    const FilmRenderer& render = {});

/// How the estimator's runs went, over the outcomes that have its answer.
fit::OutsideTally tally_of(const fit::OutsideEstimator& estimator, const std::vector<BlindOutcome>& outcomes);

}  // namespace glidelab::validate
