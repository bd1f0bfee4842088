/// What a sequence of causes says (diagnosis.h: explained, remainder, traces, levels, recovered), in words and in rows.
///
/// A cause's share is of the excess of the squared gap: (g²_{i-1} - g²_i)/(g²_0 - 1), g the gap of held-out clips.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// "91 %", "99.7 %" and "0.3 %" within 1 % of the ends, and its interval: "91 % (86 to 95 %)".
std::string share_text(double share, const std::optional<diagnose::GapInterval>& interval = {});

/// "1.2 times the noise"
std::string over_noise_text(double gap);

/// "3.6 ± 0.2 mm at 0.34 m", or the size alone where a curve is not what tells it.
std::string largest_words(const diagnose::GapRegion& region);

/// "at times from 0 to 0.1 s of clip m1-up"
std::string region_words(const diagnose::GapRegion& region);

/// The answer in a sentence or two: at which level the law holds, how much each cause explains, with its size, and what
/// is left; of `none`, that nothing matters, and its traces. Empty where there is no such sequence, nor traces.
std::string sequence_words(const diagnose::Diagnosis& diagnosis);

/// How sure the named causes are, and which look alike: "Probability: quadratic drag 97 %." Empty without an effect.
std::string sureness_words(const diagnose::Diagnosis& diagnosis);

/// "The law holds within each configuration (gap 1.02); across them it does not (5.3)." Where it leaves more than half
/// the noise besides, it only fits far better there. Empty otherwise.
std::string holds_within_words(const diagnose::Diagnosis& diagnosis);

/// The gaps of the three levels; empty where there is one level alone.
std::string levels_words(const diagnose::Diagnosis& diagnosis);

/// What the remainder amounts to: a random acceleration, a scatter from clip to clip. Empty where none is seen.
std::string remainder_words(const diagnose::GapRemainder& remainder);

/// Where it lies most, and how large it is there. Empty where no place stands out.
std::string clearest_words(const diagnose::GapRemainder& remainder, const std::string& subject = "What is left");

/// "with quadratic drag and bowed track in the model", "by the nominal model".
std::string with_words(const std::vector<std::string>& ids);

/// Header, then causes in order and what is left: name (id in `ids`), share, gap after. Empty without causes.
std::vector<std::vector<std::string>> explained_rows(const diagnose::Diagnosis& diagnosis, bool ids);

/// Configurations that have the same causes in the model, and their rows under a header: name, K/m, µ, α, terminal
/// velocity; "–" where a value is undetermined, with the reasons under `why`.
struct RecoveredTable {
  std::vector<std::string> with;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> why;  ///< "terminal velocity of 0.335 kg, 0°: the track is level"
};
std::vector<RecoveredTable> recovered_tables(const diagnose::Diagnosis& diagnosis);

/// What an effect's parameters say of each configuration, set-up or clip ("mu.NAME"): header, then a row a name. Empty
/// where it has none such.
std::vector<std::vector<std::string>> member_rows(const diagnose::DiagnosedEffect& effect);

}  // namespace glidelab::report
