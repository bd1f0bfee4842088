#include "validate/study/certify/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <ctime>
#include <functional>
#include <numeric>
#include <utility>

#include "base/errors.h"
#include "core/analysis/analyze.h"
#include "core/math/quantile.h"
#include "core/result/estimate.h"
#include "core/result/quantity.h"
#include "diagnose/lines/line_model.h"
#include "diagnose/verdict/diagnose.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

constexpr std::size_t kQuantityCount = core::kQuantities.size();
constexpr std::size_t kHeadline = 3;  // K/m, mu and alpha: the first of kQuantities
// Twins filmed of each change, at a first and at a second look. K/m, mu and alpha have as many errors each: where those
// with and without the change are unrelated, five runs give the ratio of their rms to 26 % and ten to 18 %, which is
// 1/sqrt(3 n); where they share their noise, as most do, far better.
constexpr std::size_t kFirstFilmed = 5, kMostFilmed = 10;
constexpr double kFirstShare = 0.2;   // of the error probability of both looks (Bonferroni)
constexpr double kLeastUseful = 0.1;  // fall of the errors below which a change is not worth a second look
constexpr double kWideConfidence = 1.0 - 0.01 / static_cast<double>(kQuantityCount);  // Bonferroni

/// One quantity of one configuration in one twin.
struct Outcome {
  std::optional<double> truth;
  core::Quantity found;
};

/// The outcomes for each configuration of the truth, each with its quantities.
struct TwinOutcome {
  std::vector<std::array<Outcome, kQuantityCount>> configurations;
  double noise_m = 0.0;
};

const core::ConfigurationResult* result_of(const core::AnalysisResults& results, const TrueConfiguration& truth) {
  for (const core::ConfigurationResult& result : results.configurations) {
    if (std::find(result.clips.begin(), result.clips.end(), truth.clips.front()) != result.clips.end()) return &result;
  }
  return nullptr;
}

std::vector<Truth> truths_of(const RecordingTwin& twin, bool nominal = false) {
  std::vector<Truth> truths;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, twin.explanations.size()); ++k) {
    truths.push_back(truth_of(twin, k, nominal));
  }
  return truths;
}

/// The twins, and the data shared by all of them.
struct Twins {
  const RecordingTwin& twin;
  std::vector<Truth> truths;  ///< by explanation
  const CertifyOptions& options;
  TwinStudios& studios;
  base::Progress progress;
};

core::AnalysisResults analysis_of(const MadeTracks& made, const CertifyOptions& options) {
  const core::MotionOptions how{.bandwidth_s = options.bandwidth_s, .lines = options.estimator.lines};
  return options.estimator.estimate(analyze_tracks(made, how), {});
}

TwinOutcome outcome_of(const Twins& twins, const TwinChange& change, std::uint64_t seed) {
  core::AnalysisResults results;
  std::optional<std::string> refusal;
  TwinOutcome outcome;
  try {
    results = analysis_of(record_twin(twins.twin, change, seed, twins.studios, twins.progress), twins.options);
    outcome.noise_m = median_noise(results);
  } catch (const base::InputError& error) {  // a twin that the analysis refuses has no values
    refusal = error.what();
  } catch (const base::NumericalError& error) {
    refusal = error.what();
  }
  for (const TrueConfiguration& truth : twins.truths[explanation_of(twins.twin, seed)].configurations) {
    auto& of = outcome.configurations.emplace_back();
    const core::ConfigurationResult* result = result_of(results, truth);
    for (std::size_t q = 0; q < kQuantityCount; ++q) {
      of[q].truth = core::value_of(truth, core::kQuantities[q].which);
      if (result != nullptr) {
        of[q].found = core::value_of(*result, core::kQuantities[q].which);
      } else if (refusal) {
        of[q].found = core::undetermined(core::unknown::Told{*refusal});
      }
    }
  }
  return outcome;
}

using Outcomes = std::vector<TwinOutcome>;

Outcomes record_all(const Twins& twins, std::size_t runs, const std::function<void()>& done) {
  Outcomes outcomes(runs);
  base::for_each_parallel(runs, twins.options.jobs, [&](std::size_t r) {
    outcomes[r] = outcome_of(twins, {}, derived_seed(twins.options.seed, r));
    done();
  });
  return outcomes;
}

/// Calls `use` with the run and the outcome of each of these quantities whose truth is known.
template <class Use>
void for_each_outcome(const Outcomes& outcomes, std::size_t first_quantity, std::size_t quantities,
                      const std::optional<std::size_t>& configuration, const Use& use) {
  for (std::size_t r = 0; r < outcomes.size(); ++r) {
    for (std::size_t c = 0; c < outcomes[r].configurations.size(); ++c) {
      if (configuration && *configuration != c) continue;
      for (std::size_t q = first_quantity; q < first_quantity + quantities; ++q) {
        if (outcomes[r].configurations[c][q].truth) use(r, outcomes[r].configurations[c][q]);
      }
    }
  }
}

std::vector<RunCount> counts_of(const Outcomes& outcomes, std::size_t first_quantity, std::size_t quantities,
                                const std::optional<std::size_t>& configuration) {
  std::vector<RunCount> counts(outcomes.size());
  for_each_outcome(outcomes, first_quantity, quantities, configuration, [&](std::size_t r, const Outcome& one) {
    if (!one.found.estimate) return;
    ++counts[r].of;
    if (one.found.estimate->low95 <= *one.truth && *one.truth <= one.found.estimate->high95) ++counts[r].holds;
  });
  return counts;
}

CertifiedQuantity certified(const Outcomes& outcomes, std::size_t quantity,
                            const std::optional<std::size_t>& configuration) {
  CertifiedQuantity result;
  result.setup = configuration;
  result.quantity = core::kQuantities[quantity].key;
  std::vector<double> sds(outcomes.size()), counts(outcomes.size());
  double square = 0.0, stated = 0.0;
  for_each_outcome(outcomes, quantity, 1, configuration, [&](std::size_t r, const Outcome& one) {
    ++result.asked;
    if (!one.found.estimate) {
      ++result.failed;
      result.why = one.found.why;
      return;
    }
    const double error = one.found.estimate->value - *one.truth, sd = one.found.estimate->sd;
    sds[r] += error / sd;
    counts[r] += 1.0;
    square += error * error;
    stated += sd * sd;
  });
  if (result.answered() == 0) return result;
  const std::vector<RunCount> held = counts_of(outcomes, quantity, 1, configuration);
  result.coverage = share_of(held, kCertifiedConfidence);
  result.wide_coverage = share_of(held, kWideConfidence);
  result.bias_sds = mean_of(sds, counts);
  result.rms = std::sqrt(square / static_cast<double>(result.answered()));
  result.stated_sd = std::sqrt(stated / static_cast<double>(result.answered()));
  return result;
}

/// Squared errors of the runs that answer both with and without the change, over the configurations that do.
struct Squares {
  std::vector<double> before, after;
  std::vector<bool> known;
};

Squares squares_of(const Outcomes& before, const Outcomes& after, std::size_t quantity) {
  Squares squares;
  for (std::size_t r = 0; r < after.size(); ++r) {
    double sum_before = 0.0, sum_after = 0.0;
    for (std::size_t c = 0; c < after[r].configurations.size(); ++c) {
      const Outcome &one = before[r].configurations[c][quantity], &other = after[r].configurations[c][quantity];
      if (!one.truth || !one.found.estimate || !other.found.estimate) continue;
      sum_before += std::pow(one.found.estimate->value - *one.truth, 2);
      sum_after += std::pow(other.found.estimate->value - *other.truth, 2);
    }
    squares.before.push_back(sum_before);
    squares.after.push_back(sum_after);
    squares.known.push_back(sum_before > 0.0 && sum_after > 0.0);
  }
  return squares;
}

/// The fall over the runs in which all of these quantities are known; empty for fewer than kFewestRuns.
std::optional<RunFall> fall_of_all(const std::vector<Squares>& all, double confidence) {
  constexpr std::size_t kFewestRuns = 5;
  std::vector<std::vector<double>> before(all.size()), after(all.size());
  if (all.empty()) return std::nullopt;
  for (std::size_t r = 0; r < all.front().known.size(); ++r) {
    if (!std::all_of(all.begin(), all.end(), [r](const Squares& one) { return one.known[r]; })) continue;
    for (std::size_t q = 0; q < all.size(); ++q) {
      before[q].push_back(all[q].before[r]);
      after[q].push_back(all[q].after[r]);
    }
  }
  if (before.front().size() < kFewestRuns) return std::nullopt;
  return fall_of(before, after, confidence);
}

struct WantedChange {
  TwinChange change;
  TwinLimit limit;
  std::vector<std::string> causes = {};
};

/// Runs of each change at the first look and at the last.
struct ChangeRuns {
  std::size_t first = 0, most = 0;
};

ChangeRuns runs_of_change(const RecordingTwin& twin, const CertifyOptions& options) {
  if (!twin.filmed) return {options.runs, options.runs};
  return {std::min(kFirstFilmed, options.runs), std::min(kMostFilmed, options.runs)};
}

bool is_linear(const std::vector<sim::ConfigurationSetup>& configurations) {
  return std::all_of(configurations.begin(), configurations.end(),
                     [](const sim::ConfigurationSetup& setup) { return sim::linear_law(setup.body).has_value(); });
}

/// Effects of the most likely explanation that has forces besides the law, without those of one that has none; empty if
/// there is no such force.
std::optional<std::vector<std::string>> causes_beside_law(const RecordingTwin& twin) {
  const TwinExplanation *likeliest = nullptr, *linear = nullptr;
  for (const TwinExplanation& one : twin.explanations) {
    const TwinExplanation*& best = is_linear(one.configurations) ? linear : likeliest;
    if (best == nullptr || one.probability > best->probability) best = &one;
  }
  if (likeliest == nullptr) {
    if (is_linear(twin.scenario.motion.configurations)) return std::nullopt;
    return twin.causes;
  }
  std::vector<std::string> causes = likeliest->ids;
  if (linear != nullptr) {
    for (const std::string& id : linear->ids) std::erase(causes, id);
  }
  return causes;
}

std::vector<WantedChange> wanted_changes(const RecordingTwin& twin) {
  std::vector<WantedChange> wanted;
  if (twin.filmed) {
    wanted.push_back({{.noise = 0.5}, TwinLimit::pixel_noise});
    wanted.push_back({{.marker = 2.0}, TwinLimit::marker});
  } else {
    wanted.push_back({{.noise = 0.5}, TwinLimit::position_noise});
    wanted.push_back({{.double_rate = true}, TwinLimit::frame_rate});
  }
  const bool by_scale = twin.scale_sd_relative > 0.0;
  if (by_scale || (twin.filmed && !twin.by_scale))
    wanted.push_back({{.camera_known = true}, by_scale ? TwinLimit::scale : TwinLimit::calibration});
  if (twin.filmed && render::lossy(twin.scenario.codec)) wanted.push_back({{.lossless = true}, TwinLimit::codec});
  if (std::any_of(twin.clips.begin(), twin.clips.end(), [](const ClipNoise& clip) { return clip.rounding_m > 0.0; }))
    wanted.push_back({{.unrounded = true}, TwinLimit::rounding});
  if (const auto causes = causes_beside_law(twin)) wanted.push_back({{.nominal = true}, TwinLimit::cause, *causes});
  if (std::any_of(twin.explanations.begin(), twin.explanations.end(),
                  [](const TwinExplanation& one) { return one.probability > 0.1 && !one.leaves_nothing(); }))
    wanted.push_back({{.alike = true}, TwinLimit::clip_scatter});
  wanted.push_back({{.twice = true}, TwinLimit::few_clips});
  return wanted;
}

std::vector<CertifiedExplanation> explanations_of(const RecordingTwin& twin, const std::vector<RunCount>& held,
                                                  std::uint64_t seed) {
  std::vector<std::vector<RunCount>> by(twin.explanations.size());
  double sum = 0.0;
  for (const TwinExplanation& one : twin.explanations) sum += std::max(0.0, one.probability);
  for (std::size_t r = 0; r < held.size() && !by.empty(); ++r) {
    by[explanation_of(twin, derived_seed(seed, r))].push_back(held[r]);
  }
  std::vector<CertifiedExplanation> explanations;
  for (std::size_t k = 0; k < by.size(); ++k) {
    const TwinExplanation& one = twin.explanations[k];
    if (by[k].empty()) continue;
    explanations.push_back({one.ids, one.probability / sum, by[k].size(), share_of(by[k], kCertifiedConfidence)});
  }
  return explanations;
}

/// The falls of one change; its tests have this error probability, those of single quantities together.
ChangedTwin changed_twin(const WantedChange& wanted, const Outcomes& before, const Outcomes& after,
                         double error_probability) {
  ChangedTwin result;
  result.limit = wanted.limit;
  result.causes = wanted.causes;
  result.runs = after.size();
  std::vector<Squares> headline;
  std::vector<std::pair<std::size_t, Squares>> all;
  for (std::size_t q = 0; q < kQuantityCount; ++q) {
    Squares squares = squares_of(before, after, q);
    if (!fall_of_all({squares}, kCertifiedConfidence)) continue;
    if (q < kHeadline) headline.push_back(squares);
    all.emplace_back(q, std::move(squares));
  }
  for (const auto& [q, squares] : all) {
    QuantityFall fall{std::string(core::kQuantities[q].key), *fall_of_all({squares}, kCertifiedConfidence), false};
    fall.significant = fall_of_all({squares}, 1.0 - error_probability / static_cast<double>(all.size()))->low > 0.0;
    result.quantities.push_back(std::move(fall));
  }
  result.together = fall_of_all(headline, kCertifiedConfidence);
  result.stands_out = result.together && fall_of_all(headline, 1.0 - error_probability)->low > 0.0;
  return result;
}

/// The twins with each change. Those of the first look are recorded first; what they leave open is recorded again up to
/// the last look. `decided` is called for each change that the first look decides.
std::vector<ChangedTwin> record_changes(const Twins& twins, const std::vector<WantedChange>& wanted,
                                        const Outcomes& before, const std::function<void()>& done,
                                        const std::function<void()>& decided) {
  const ChangeRuns runs = runs_of_change(twins.twin, twins.options);
  Twins nominal = twins;
  if (std::ranges::any_of(wanted, [](const WantedChange& one) { return one.change.nominal; }))
    nominal.truths = truths_of(twins.twin, true);
  std::vector<Outcomes> after(wanted.size());
  const auto record = [&](const std::vector<std::size_t>& changes, std::size_t from, std::size_t to) {
    for (const std::size_t c : changes) after[c].resize(to);
    base::for_each_parallel(changes.size() * (to - from), twins.options.jobs, [&](std::size_t i) {
      const std::size_t c = changes[i / (to - from)], r = from + i % (to - from);
      const TwinChange& change = wanted[c].change;
      after[c][r] = outcome_of(change.nominal ? nominal : twins, change, derived_seed(twins.options.seed, r));
      done();
    });
  };
  const double error_probability = wanted.empty() ? 0.05 : 0.05 / static_cast<double>(wanted.size());
  std::vector<std::size_t> all(wanted.size()), open;
  std::iota(all.begin(), all.end(), std::size_t{0});
  record(all, 0, runs.first);
  std::vector<ChangedTwin> changed(wanted.size());
  for (const std::size_t c : all) {
    const bool looks_once = runs.first == runs.most;
    changed[c] = changed_twin(wanted[c], before, after[c], (looks_once ? 1.0 : kFirstShare) * error_probability);
    const std::optional<RunFall>& together = changed[c].together;
    if (looks_once || (together && (changed[c].stands_out || together->high < kLeastUseful))) {
      decided();
    } else {
      open.push_back(c);
    }
  }
  record(open, runs.first, runs.most);
  for (const std::size_t c : open) {
    changed[c] = changed_twin(wanted[c], before, after[c], (1.0 - kFirstShare) * error_probability);
  }
  return changed;
}

void check_runs(std::size_t runs) {
  if (runs < kFewestTwins || runs > kMostTwins) {
    throw base::InputError(base::Issue{"", 0, "twins", fmt::format("{}", runs),
                                       fmt::format("a whole number from {} to {}", kFewestTwins, kMostTwins)});
  }
}

}  // namespace

Certificate certify_twin(const RecordingTwin& twin, const CertifyOptions& options, const base::Progress& progress) {
  check_runs(options.runs);
  Certificate certificate;
  certificate.runs = options.runs;
  certificate.estimator = options.estimator.name;
  certificate.filmed = twin.filmed;
  certificate.causes = twin.causes;
  certificate.without = twin.without;
  certificate.recorded_noise_m = twin.noise_m;
  for (const sim::ConfigurationSetup& setup : twin.scenario.motion.configurations) {
    certificate.motions += setup.motions.size();
    certificate.setups.push_back({setup.name, setup.body.mass_kg, setup.stated_incline_rad});
  }

  certificate.clips = twin.recorded_clips > 0 ? twin.recorded_clips : certificate.motions;
  const std::vector<WantedChange> wanted = options.changes ? wanted_changes(twin) : std::vector<WantedChange>{};
  const ChangeRuns changed_runs = runs_of_change(twin, options);
  std::atomic<std::size_t> all = options.runs + wanted.size() * changed_runs.most, finished = 0;
  const auto tell = [&] { progress("twins", static_cast<double>(finished) / static_cast<double>(all)); };
  const auto done = [&] {
    ++finished;
    tell();
  };
  TwinStudios studios(changed_runs.most);
  const Twins twins{twin, truths_of(twin), options, studios, [&](std::string_view, double) { tell(); }};
  const Outcomes outcomes = record_all(twins, options.runs, done);
  const std::vector<RunCount> held = counts_of(outcomes, 0, kHeadline, std::nullopt);
  certificate.together = share_of(held, kCertifiedConfidence);
  certificate.wide_together = share_of(held, kWideConfidence);
  certificate.explanations = explanations_of(twin, held, options.seed);
  for (std::size_t q = 0; q < kQuantityCount; ++q) {
    CertifiedQuantity quantity = certified(outcomes, q, std::nullopt);
    if (quantity.asked == 0) continue;
    certificate.quantities.push_back(std::move(quantity));
    for (std::size_t c = 0; certificate.setups.size() > 1 && c < certificate.setups.size(); ++c) {
      CertifiedQuantity own = certified(outcomes, q, c);
      if (own.asked > 0) certificate.configurations.push_back(std::move(own));
    }
  }
  std::vector<double> noise_m;
  for (const TwinOutcome& outcome : outcomes) noise_m.push_back(outcome.noise_m);  // 0 for one that failed
  certificate.twin_noise_m = core::median_of(std::move(noise_m));
  certificate.changes =
      record_changes(twins, wanted, outcomes, done, [&] { all -= changed_runs.most - changed_runs.first; });
  std::stable_sort(certificate.changes.begin(), certificate.changes.end(),
                   [](const ChangedTwin& a, const ChangedTwin& b) {
                     return (a.together ? a.together->value : -1e9) > (b.together ? b.together->value : -1e9);
                   });
  return certificate;
}

namespace {

/// Scales the pixels' noise, using one pilot twin filmed for this purpose, so that positions scatter as in the
/// recording.
void match_noise(RecordingTwin& twin, const CertifyOptions& options, const base::Progress& progress) {
  constexpr double kAlike = 1.1, kFarthest = 4.0;
  TwinStudios studios(0);
  const Twins twins{twin, truths_of(twin), options, studios, progress};
  const TwinOutcome pilot = outcome_of(twins, {}, derived_seed(options.seed, kMostTwins));
  if (!(pilot.noise_m > 0.0)) return;  // none of its clips could be used: the certificate reports this
  const double factor = twin.noise_m / pilot.noise_m;
  if (factor > 1.0 / kAlike && factor < kAlike) return;
  if (factor < 1.0 / kFarthest || factor > kFarthest) {
    twin.without.emplace_back(lacking::Noise{twin.noise_m, pilot.noise_m});
    return;
  }
  scale_noise(twin.scenario.sensor, factor);
}

/// A twin with every clip twice counts as two.
FilmingSize size_of_filming(const RecordingTwin& twin, const CertifyOptions& options, double one_s) {
  FilmingSize size;
  size.twins = options.runs;
  const ChangeRuns runs = runs_of_change(twin, options);
  for (const WantedChange& wanted : options.changes ? wanted_changes(twin) : std::vector<WantedChange>{}) {
    size.least_of_changes += (wanted.change.twice ? 2 : 1) * runs.first;
    size.most_of_changes += (wanted.change.twice ? 2 : 1) * runs.most;
  }
  size.processor_time_s = static_cast<double>(size.twins + size.most_of_changes) * one_s;
  return size;
}

}  // namespace

Certificate certify(const std::vector<std::filesystem::path>& folders, const CertifyOptions& options,
                    const base::Progress& progress) {
  check_runs(options.runs);
  std::vector<core::ClipSetup> setups;
  std::vector<std::optional<core::CameraSettings>> cameras;
  std::vector<core::Experiment> experiments;
  for (const std::filesystem::path& folder : folders) {
    core::Experiment experiment = diagnose::read_recording(folder, options.bare);
    if (experiment.lines) {
      throw base::InputError(
          base::Issue{experiment.file.string(), 0, "lines", "a table of lines",
                      "clips or tracks: a table of lines holds no motions that a twin could repeat"});
    }
    setups.insert(setups.end(), experiment.clips.begin(), experiment.clips.end());
    cameras.resize(setups.size(), experiment.camera);
    experiments.push_back(std::move(experiment));
  }
  const diagnose::DiagnoseOptions how{.without = {}, .jobs = options.jobs, .twin = true, .bare = options.bare};
  const core::AnalysisResults results = diagnose::analyze_for_diagnosis(folders, how, progress);
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_results(results, setups, how, progress, cameras, experiments);
  RecordingTwin twin = twin_of_recording(results, diagnosis, experiments);
  progress("twins", 0.0);
  if (twin.filmed) {
    std::clock_t start = std::clock();
    const auto pilot = [&](std::string_view what, double) {
      if (what == "stage") start = std::clock();  // drawn once for all twins
      progress("twins", 0.0);
    };
    match_noise(twin, options, pilot);
    const double one_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (options.before_filming) options.before_filming(size_of_filming(twin, options, one_s));
  }
  return certify_twin(twin, options, progress);
}

}  // namespace glidelab::validate
