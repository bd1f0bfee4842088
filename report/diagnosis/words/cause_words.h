/// A sequence of causes (diagnosis.h: explained, remainder, traces, levels, recovered), in words and in rows.
///
/// A cause's share refers to the excess of the squared gap: (g²_{i-1} - g²_i)/(g²_0 - 1), g the gap of held-out clips.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Whether the gap is measured from a fall without any drag, rather than from the nominal model.
bool is_measured_without_drag(const diagnose::Diagnosis& diagnosis);

/// "91 %", "99.7 %" and "0.3 %" within 1 % of the ends, and its interval: "91 % (86 to 95 %)".
std::string share_text(double share, const std::optional<diagnose::GapInterval>& interval = {});

/// With a capital letter.
std::string capital(std::string text);

/// Whether the nominal model leaves no more than noise alone would by chance: two standard errors above 1.
bool leaves_noise_alone(const diagnose::Diagnosis& diagnosis);

/// Whether the causes leave nothing: a remainder whose share prints as 0.0 %, of a gap within a tenth of the noise.
bool leaves_nothing(const diagnose::GapRemainder& remainder);

/// "1.2 times the noise"
std::string over_noise_text(double gap);

/// "3.6 ± 0.2 mm at 0.34 m", or the size alone if it does not come from a curve.
std::string largest_words(const diagnose::GapRegion& region);

/// "at times from 0 to 0.1 s of clip m1-up"
std::string region_words(const diagnose::GapRegion& region);

/// The answer in a sentence or two: the level at which the law holds, how much each cause explains, with its size, and
/// the remainder; for `none`, that nothing matters, and the traces. Empty if there are neither causes nor traces.
std::string sequence_words(const diagnose::Diagnosis& diagnosis);

/// How certain the named causes are, and which are indistinguishable: "Probability: quadratic drag 97 %." Empty without
/// an effect.
std::string sureness_words(const diagnose::Diagnosis& diagnosis);

/// "The law holds within each configuration (gap 1.02); across them it does not (5.3)." If it leaves a gap of more than
/// half the noise, the sentence says only that it fits far better there. Empty otherwise.
std::string holds_within_words(const diagnose::Diagnosis& diagnosis);

/// The gaps of the three levels; empty if there is only one level.
std::string levels_words(const diagnose::Diagnosis& diagnosis);

/// The size of the remainder: a random acceleration, a scatter from clip to clip. Empty if none is seen.
std::string remainder_words(const diagnose::GapRemainder& remainder);

/// Where the remainder is largest, and its size there. Empty if no region stands out.
std::string clearest_words(const diagnose::GapRemainder& remainder, const std::string& subject = "What is left");

/// "with quadratic drag and bowed track in the model", "by the nominal model".
std::string with_words(const std::vector<std::string>& ids);

/// Header, then causes in order and the remainder: name (id in `ids`), share, gap after. Empty without causes.
std::vector<std::vector<std::string>> explained_rows(const diagnose::Diagnosis& diagnosis, bool ids);

/// Configurations that have the same causes in the model, and their rows under a header: name, K/m, µ, α, terminal
/// velocity; "–" if a value is undetermined, with the reasons under `why`.
struct RecoveredTable {
  std::vector<std::string> with;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> why;  ///< "terminal velocity of 0.335 kg, 0°: the track is level"
};
std::vector<RecoveredTable> recovered_tables(const diagnose::Diagnosis& diagnosis);

/// An effect's parameters for each configuration, set-up or clip ("mu.NAME"): header, then one row per name. Empty if
/// it has none of this kind.
std::vector<std::vector<std::string>> member_rows(const diagnose::DiagnosedEffect& effect);

}  // namespace glidelab::report
