/// The results of blind cases: a file, a text, a page; with the targets, and the meaning of a score in words.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/blind/blind_run.h"
#include "report/html/html.h"
#include "validate/blind/blind_score.h"

namespace glidelab::report {

struct BlindTarget {
  std::string what;
  validate::BlindShare share;
  double wanted = 0.0;  ///< required value of the share
  bool at_most = false;
};
/// All targets, whether or not there are cases that bear on them.
std::vector<BlindTarget> blind_targets(const validate::BlindScore& score);

/// The share of a key; a share of no cases if there is none.
validate::BlindShare share_of(const std::map<std::string, validate::BlindShare>& shares, const std::string& key);

/// Whether the share reaches the required value; meaningless for a share of no cases.
bool is_met(const BlindTarget& target);

/// "at least 95 %"
std::string wanted_text(const BlindTarget& target);

/// "96 % (122 of 127)"; a dash if there are none.
std::string blind_percent(const validate::BlindShare& share);

/// The value of a verdict on an experiment like these: how often it is right, with the 95 % interval of Clopper and
/// Pearson, whether its probabilities can be trusted, and which targets are missed. HTML.
std::string blind_meaning(const validate::BlindScore& score);

/// The score and every case's outcome, with a newline at its end. No number in it is NaN.
std::string blind_json(const BlindRun& run);

/// Targets, decision methods and confusions as tables for a terminal.
std::string blind_text(const BlindRun& run);

/// The same as a page, with its meaning first and all cases last. EnvironmentError if gnuplot fails.
Page blind_page(const BlindRun& run);

}  // namespace glidelab::report
