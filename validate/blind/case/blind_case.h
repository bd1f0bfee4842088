/// One blind case: an experiment with a known truth; the diagnosis sees only its folder.
///
/// Drawn from (seed, index) alone: a design; nothing, one effect, two, or one outside the library; a strength by its
/// detectability, the log likelihood that the right model gains on the nominal one fitted to the same positions
/// (blind_strength.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

enum class BlindKind { none, single, pair, outside };

/// "none", "single", "pair", "outside".
std::string_view word(BlindKind kind);

struct BlindCause {
  std::string id;
  double size = 0.0;                         ///< in the effect's own unit
  std::map<std::string, double> parameters;  ///< as in effects.md; empty outside the library
  std::string variable;                      ///< for an outside effect: the variable in which it lies
  double gain = 0.0;                         ///< log likelihood, beside the other one if there are two
};

/// What is drawn for every case, with tracks or clips.
struct DrawnCase {
  std::uint64_t seed = 0;
  std::size_t index = 0;
  BlindKind kind = BlindKind::none;
  std::vector<BlindCause> causes;
};

/// The beginning of its truth: format, seed, case, kind, causes.
nlohmann::ordered_json truth_of(const DrawnCase& one);

struct BlindCase : DrawnCase {
  BlindDesign design;
  std::vector<std::vector<double>> x_m;  ///< of each clip's frames, noise included
};

struct BlindDraw {
  std::string only;                 ///< an effect that every case has; empty: all kinds
  std::function<void()> look = {};  ///< called often, since a case may take seconds; may throw to stop
};

/// NumericalError if none of many designs shows the requested effect.
BlindCase make_blind_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw = {});

/// experiment.toml and tracks/*.csv, nothing else; the folder is made.
void write_blind_folder(const BlindCase& one, const std::filesystem::path& folder);

/// truth_of(), K, mu, the noise, and the true inclinations and masses.
std::string blind_truth_json(const BlindCase& one);

}  // namespace glidelab::validate
