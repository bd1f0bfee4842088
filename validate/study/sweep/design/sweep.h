/// A sweep: one scenario, the keys that vary, how their values are combined, and how every run is analysed.
///
/// It is read from one TOML file (docs/reference/sweep.md). A point is one combination of values. Every point is run
/// `replicates` times with different seeds, and run r belongs to point r / replicates. A run depends only on the
/// sweep's seed and its number, so the order of the runs and the number of threads do not matter.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/toml/toml_set.h"
#include "fit/outside/outside_estimator.h"

namespace glidelab::validate {

enum class Level {
  tracks,  ///< true positions at the frames' times and white noise, no images
  clips,   ///< rendered in memory, calibrated and tracked
};

/// Which values a run has, apart from those that are drawn.
///
/// Factorial: the first axis varies slowest. Latin hypercube: the n strata of each axis are visited once each, in
/// random order (a Feistel permutation, so that nothing of the size of the design is stored), at a random position
/// within the stratum. Sobol: the sequence of boost::random::sobol with a random digital shift on each axis, so that
/// its first 2^m points stay a net. In the last two designs a list is divided into equal parts.
enum class Design { factorial, latin_hypercube, sobol };

/// Where the values of a key come from.
struct AxisSource {
  enum class Kind {
    list,         ///< `values`
    linear,       ///< from `from` to `to`: `count` of them (factorial), or anywhere between
    logarithmic,  ///< the same with equal ratios
    uniform,      ///< this and the following: drawn for every run
    log_uniform,
    normal,      ///< `mean`, `sd`
    log_normal,  ///< `mean` is the median, `sd` that of the natural logarithm
  };
  Kind kind = Kind::list;
  std::vector<base::TomlScalar> values;
  double from = 0.0, to = 0.0;
  std::size_t count = 0;
  double mean = 0.0, sd = 0.0;
  bool whole = false;  ///< for ranges and uniform draws: whole numbers only
  bool drawn() const { return kind >= Kind::uniform; }
};

/// Keys that belong together, such as a shutter and its line time. Keys named by other choices of the axis, but not by
/// the chosen one, are removed from the scenario.
struct Choice {
  std::string label;  ///< its value in the database
  std::vector<base::TomlAssignment> keys;
  int line = 0;  ///< of the sweep's file
};

struct Axis {
  std::string name;               ///< its column in the database
  std::vector<std::string> keys;  ///< dotted paths in the scenario, all with one value; or "tracks.noise_m"
  AxisSource source;
  std::vector<Choice> choices = {};  ///< if present, `keys` has the keys of all of them, and `source` lists the labels
  int line = 0;                      ///< line of the keys in the sweep's file
};

/// The rule that knows the truth (validate/made_tracks/oracle_bandwidth.h).
inline constexpr const char* kBestPossible = "best-possible";

/// One way to analyse a run's clips.
struct Analysis {
  std::string estimator;              ///< a name of fit/estimators.h, or kAllPoints (naive_lines.h)
  std::optional<double> bandwidth_s;  ///< given; otherwise chosen
  std::string bandwidth_rule =
      {};                    ///< of core/motion/bandwidth/bandwidth_rule.h, or kBestPossible; empty: the default one
  std::string name() const;  ///< the estimator's, with " h=0.04 s" or " gcv" if the bandwidth is not the default
};

/// A published quantity that falls with mass: mu of the lightest and the heaviest glider on one track, and the smallest
/// R² of its lines.
struct PublishedFall {
  std::string configuration;
  double mu_lightest = 0.0, mu_heaviest = 0.0;
  double r2 = 0.0;
  std::string source;
};

struct Sweep {
  std::filesystem::path file;
  std::string text;  ///< of the file
  std::string name;
  std::filesystem::path scenario_file;
  std::string scenario_text;
  Level level = Level::tracks;
  Design design = Design::factorial;
  std::uint64_t seed = 1;
  std::uint64_t samples = 0;  ///< number of points, for a design other than factorial
  std::uint64_t replicates = 1;
  double noise_m = 0.0;  ///< standard deviation of a track's positions
  /// With rendered clips: the replicates of a point share the calibration of the first one, like recordings by one
  /// camera; otherwise each has its own stills and calibration.
  bool calibrate_once = false;
  std::optional<double> field_m;  ///< width of the plane to be shown in the image: sets the camera's distance
  std::vector<Axis> axes;
  std::vector<Analysis> analyses;
  std::optional<fit::OutsideEstimator> outside = {};  ///< from the command line, not from the file; judged as well
  std::vector<PublishedFall> published_falls = {};    ///< for comparison (validate/study/sweep/mass_study.h)
  /// Texts of the cameras that occur (the scenario's own, or those of an axis), as part of the sweep's identity.
  std::vector<std::string> camera_files;
};

/// Points of the design; InputError (of the sweep's file) if there are more than 2^53.
std::uint64_t point_count(const Sweep& sweep);
std::uint64_t run_count(const Sweep& sweep);

/// One for each axis, in their order.
std::vector<base::TomlScalar> values_of(const Sweep& sweep, std::uint64_t run);

/// Seed of the noise of a run: a function of the sweep's seed and the run's number.
std::uint64_t seed_of(const Sweep& sweep, std::uint64_t run);

/// The value at a quantile u of [0, 1): for a drawn axis by its distribution, otherwise as placed by the hypercube.
/// With equal steps or a uniform draw each whole number has the same part of [0, 1); with equal ratios the nearest is
/// taken.
base::TomlScalar value_at(const AxisSource& source, double u);

/// All values of an axis of a factorial design.
std::vector<base::TomlScalar> all_values(const AxisSource& source);

/// A permutation of 0 … count-1, a different one for each key.
std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key);

}  // namespace glidelab::validate
