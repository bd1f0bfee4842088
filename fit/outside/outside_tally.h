/// How the runs of an outside estimator went, counted by what went wrong.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::fit {

enum class OutsideFailure { none, exit_status, signal, time_out, no_output, bad_output, raised };
inline constexpr std::array kOutsideFailures = {OutsideFailure::exit_status, OutsideFailure::signal,
                                                OutsideFailure::time_out,    OutsideFailure::no_output,
                                                OutsideFailure::bad_output,  OutsideFailure::raised};

/// In files: "exit_status".
std::string_view key_of(OutsideFailure failure);

/// How one run went.
struct OutsideRun {
  OutsideFailure failure = OutsideFailure::none;
  std::string what;  ///< "exit status 1: ValueError: …"; empty if it did not fail
  double seconds = 0.0;
};

/// Why a quantity of a failed run is undetermined: "the estimator failed (time_out): not done after 60 s".
std::string why_of(const OutsideRun& failed);
/// How every why_of() of this kind begins: "the estimator failed (time_out)".
std::string why_begins(OutsideFailure failure);

/// Many runs, counted.
struct OutsideTally {
  struct Kind {
    std::size_t count = 0;
    std::string first;  ///< message of the first of them
  };
  std::string name;
  std::string command;  ///< its words
  std::size_t runs = 0;
  std::array<Kind, kOutsideFailures.size()> failures = {};  ///< as in kOutsideFailures
  double seconds = 0.0;                                     ///< mean per run; 0 if it was not recorded
  double longest_s = 0.0;

  std::size_t failed() const;
};
OutsideTally tally_of(std::string name, std::string command, const std::vector<OutsideRun>& runs);

}  // namespace glidelab::fit
