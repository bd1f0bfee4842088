/// One case of a challenge: an experiment folder given to estimators, and its truth.
///
/// Drawn from (level, seed, index) alone, and the same, within rounding, with every build of one kChallengeVersion:
///
///     easy      viscous drag and Coulomb friction as in the analysis; four clips of tracks, 200 Hz, 0.02 mm of
///               white noise
///     camera    the same law, two clips filmed and measured by Glidelab: positions carry the errors of a calibration,
///               an exposure and a sensor; images and positions lie in the folder
///     hard      the same law, one clip each way, 25 to 60 Hz, 0.2 to 1.5 mm, and frames that are lost without a trace
///     everyday  tracks as students record them (blind/case/everyday_case.h): the law lacks something
///
/// The folder has the form described in outside_runs.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::validate {

enum class ChallengeLevel { easy, camera, hard, everyday };
inline constexpr std::array kChallengeLevels = {ChallengeLevel::easy, ChallengeLevel::camera, ChallengeLevel::hard,
                                                ChallengeLevel::everyday};
/// Version of the drawn cases: it changes if the same level and seed give different cases.
inline constexpr int kChallengeVersion = 1;

/// "easy", …
std::string_view word(ChallengeLevel level);
/// Empty if there is none of this name.
std::optional<ChallengeLevel> challenge_level(std::string_view word);

/// The truth for the clips of one mass, stated inclination and group; empty if the law has no such quantity.
struct ChallengeConfiguration {
  std::vector<std::string> clips;
  std::optional<double> k_over_m_1_s, mu, alpha_deg, v_lim_m_s;
};

/// Writes the (new) folder and returns the truth. Errors as in rendering, analysis and make_everyday_case().
std::vector<ChallengeConfiguration> make_challenge_case(ChallengeLevel level, std::uint64_t seed, std::size_t index,
                                                        const std::filesystem::path& folder);

}  // namespace glidelab::validate
