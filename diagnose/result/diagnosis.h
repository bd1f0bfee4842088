/// What a diagnosis says, as plain data. report/ writes it as diagnosis.json and a page.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "diagnose/result/explanation.h"
#include "diagnose/result/gap_place.h"
#include "diagnose/result/image_fact.h"
#include "diagnose/result/line_comparison.h"
#include "diagnose/result/next_step.h"
#include "diagnose/result/note.h"

namespace glidelab::diagnose {

struct DiagnosedParameter {
  std::string key;  ///< with its unit, as in the list of effects
  double value = 0.0;
  double sd = 0.0;                           ///< 0: not fitted
  std::string text = {};                     ///< a word (a codec's name) instead of value and sd
  std::optional<core::WhyUnknown> why = {};  ///< why the data do not determine it; its value is then not a number
  bool at_end = false;                       ///< at an end of the range that is searched
};

/// One of several effects that would look the same.
struct AlikeEffect {
  std::string id, words;
  std::optional<double> probability;  ///< none if no weighed explanation contains it: it counts under another's
};

struct DiagnosedEffect {
  std::string id;
  Stage stage = Stage::dynamics;
  std::string words;
  double probability = 0.0;                ///< that it acts, alone or with another
  std::vector<std::string> equivalent_to;  ///< effects that these data cannot tell from it
  std::vector<DiagnosedParameter> parameters;
  double joint_probability = 0.0;  ///< that it or one of `equivalent_to` acts
  /// It and those, by decreasing probability; empty if it stands alone.
  std::vector<AlikeEffect> alike = {};
  bool by_stated = false;  ///< known by the inclinations that are stated, not by a part of the gap
};

struct RankedExplanation {
  Explanation explanation;
  double probability = 0.0;
  double log_evidence_gain = 0.0;  ///< relative to the nominal model
  double log_likelihood_gain = 0.0;
  std::size_t parameters = 0;                   ///< in addition to those of the nominal model
  std::optional<double> gap_after;              ///< of held-out clips, if it was fitted in full
  std::optional<ImpossibleSize> left_out = {};  ///< why it was not weighed, if it was not
  bool converged = true;                        ///< false: its fit did not reach a minimum; the gain is a lower bound
};

struct GapRegion {
  GapVariable variable = GapVariable::time;
  double from = 0.0, to = 0.0;
  double excess = 0.0;  ///< size over its standard deviation, where that is largest
  double size = 0.0;    ///< the largest
  std::string unit;     ///< of size: N, m/s², m, N s/m
  GapKind what = GapKind::force;
  std::string clip;  ///< set if it belongs to one clip
  /// The most that the nominal model can lack, in the size's unit, if the size is far more than that and therefore not
  /// credible.
  std::optional<double> lacking = {};
  std::optional<double> size_sd = {};  ///< of the size; none if it is not from a curve or from lines
  int direction = 0;                   ///< sign of v of its lines; 0 for both directions, and if there are no lines
  std::optional<double> at = {};       ///< the value of the variable at which a curve has that size
};

/// A function of one variable that would explain the gap, for the plots.
struct GapCurve {
  GapVariable variable = GapVariable::time;
  GapKind what = GapKind::force;
  std::string unit;
  double log_evidence = 0.0;
  std::vector<double> at, size, sd;
};

struct GapOfParameter {
  std::string quantity;
  Against against = Against::stated;
  std::string group;
  std::optional<double> z_before = {}, z_after = {};  ///< none if undetermined
  /// From a part of the data alone, and from all: fits of the nominal model, in the quantity's unit.
  std::optional<DiagnosedParameter> alone = {}, together = {};
};

/// 95 % interval, over clips (gap_sizes.h).
struct GapInterval {
  double low = 0.0, high = 0.0;
};

struct GapIntervals {
  std::optional<GapInterval> before, after, shrink, acceleration_before, acceleration_after;
  std::optional<std::size_t> too_few = {};  ///< number of clips, if that is the reason for the missing interval
};

/// A difference with its standard deviation.
struct GapValue {
  double value = 0.0, sd = 0.0;
};

/// Measured minus modelled acceleration over an interval of speeds (domain_gaps.h), m/s².
struct PhaseBin {
  double from_m_s = 0.0, to_m_s = 0.0;
  double v_m_s = 0.0;  ///< mean over its points
  std::size_t points = 0;
  GapValue before, after;
};

struct PhaseGap {
  std::optional<double> mass_kg;  ///< none: all masses together
  std::vector<PhaseBin> bins;     ///< by increasing speed
};

/// The size of the gap in one domain, relative to that due to noise alone (1).
struct GapDomain {
  GapDomainKind domain = GapDomainKind::positions;
  double before = 0.0;
  std::optional<double> after = {};  ///< none if undetermined
};

/// A gap exists if it is this many standard errors above the floor. Three would do if the noise were exactly white and
/// normal; half as many again leave room for noise that is not.
inline constexpr double kClearGap = 4.5;

struct GapSizes {
  double before = 0.0, after = 0.0;
  double standard_error = 0.0;  ///< of a gap at the floor
  double floor = 1.0;           ///< below 1 if the best fit shows that the noise was overestimated
  std::optional<double> shrink;
  std::vector<std::string> held_out;
  std::vector<double> before_by_clip, after_by_clip;
  std::optional<double> acceleration_before, acceleration_after;  ///< m/s²; none for lines, which contain no motion
  GapIntervals interval95;
  std::vector<GapOfParameter> parameters;
  std::vector<PhaseGap> phase_plane;  ///< all masses together, then each; empty for lines
  std::vector<GapDomain> domains;
};

/// Residuals of one motion for the plots, in metres, and the noise of each position.
struct ResidualCurve {
  std::string clip;
  std::vector<double> t_s, x_m, v_m_s, before_m, after_m;
  std::vector<double> noise_m = {};
};

/// Two effects are called alike if their cosine is at least this: the second then explains 90 % of the gain of the
/// first.
inline constexpr double kAlike = 0.95;

/// Parts of the gap's excess that two explanations leave count as equal within this: by causes/cause_odds.h it
/// corresponds to odds of twenty.
inline constexpr double kSameLeft = 0.24;

/// How similar the changes due to two effects are: the cosine of the angle between them, all fitted parameters
/// projected out.
struct Isolability {
  std::vector<std::string> ids;
  std::vector<double> least_seen;           ///< size of each that makes one standard deviation
  std::vector<std::vector<double>> cosine;  ///< absolute
};

/// What the images of filmed clips say about one effect, whether or not it moves the positions.
struct ImageFinding {
  std::string id;
  Stage stage = Stage::optics;
  bool seen = false;
  double log_evidence = 0.0;  ///< for its presence against its absence, from the images alone
  bool stated = false;        ///< the file itself says so: named only for its effect on the positions
  std::vector<DiagnosedParameter> parameters;
  ImageFact fact;
};

/// A measurement in the images for the plots: `lengthening` (px², of the marker's image over px/s), `brightness`
/// (relative, over time), `drift across`, `drift down` (px, of the fixed scene over time), `noise` (codes², a pixel's
/// variance over its level in codes).
struct ImageCurve {
  std::string what, clip;
  std::vector<double> at, value, sd;
  std::vector<double> expected, fitted;  ///< as stated, and as found; empty if there is none
};

/// The residuals of the pattern's corners about a camera's fit.
struct CalibrationRests {
  std::string experiment;
  core::CornerMap rests;
};

/// What a twin lacks because no scenario can express it.
struct TwinLack {
  std::string what;  ///< an effect, or words
  std::string why;
};

/// One explanation of the motions, as a scenario file: its forces and starts. The camera is that of Diagnosis::twin.
struct LikelyTwin {
  std::string toml;
  std::vector<std::string> ids;  ///< effects in it; none: the nominal model
  double probability = 1.0;      ///< relative to the others of the list
  // What it leaves unexplained, as a random acceleration (causes/remainder.h).
  double q_m2_s3 = 0.0;     ///< spectral density of the white part
  double force_m_s2 = 0.0;  ///< sd from clip to clip of friction, and of inclination
  double drag = 0.0;        ///< relative sd from clip to clip of K
};

/// Positions of one motion as the analysis has them, for the comparison with a twin.
struct MeasuredMotion {
  std::string clip;          ///< of the twin
  std::size_t recorded = 0;  ///< clip of the results of the analysis
  double start_s = 0.0;      ///< of the twin's clip, after the data's first frame
  double noise_m = 0.0;      ///< of one position
  double bandwidth_s = 0.0;  ///< of the analysis's smoothing
  std::vector<double> t_s, x_m;
  std::vector<double> v_m_s, a_m_s2;  ///< smoothed, at the points to which the lines are fitted
};

/// What a reader must know before the verdict (verdict_details.h); also in the notes.
struct VerdictLimits {
  std::vector<NegativeLoss> driving;
  std::vector<ContradictedIncline> contradicted;
  std::vector<ContradictedIncline> resolved;  ///< by the nominal model, where none is left with the named effects
  std::optional<SetAside> set_aside;
};

/// One cause in the sequence that explains the gap, each added beside those before it.
struct ExplainedCause {
  std::string id;
  double share = 0.0;                                ///< (g²_{i-1} - g²_i)/(g²_0 - 1), g the gap of held-out clips
  std::optional<GapInterval> share_interval95 = {};  ///< over clips, or lines
  double gap_after = 0.0;                            ///< g_i
};

/// What is left of the gap after the named causes.
struct GapRemainder {
  double share = 1.0;              ///< of the excess g²_0 - 1: 1 minus the causes' shares
  double gap = 1.0;                ///< of held-out clips, with all causes in the model
  double acceleration_m_s2 = 0.0;  ///< rms of the random acceleration that would cause it (remainder.h); 0: none is
                                   ///< seen
  double clip_scatter_m_s2 = 0.0;  ///< sd, from clip to clip, of the acceleration by friction and inclination
  double drag_scatter = 0.0;       ///< relative sd, from clip to clip, of K
  std::vector<GapRegion> regions = {};
};

/// Gaps of held-out clips, or of fits, with parameters that are a clip's own, a configuration's (mass and set-up), or
/// common to all; all are root mean squares of residuals over the noise, corrected for the degrees of freedom that the
/// fits take.
struct GapLevels {
  double all = 1.0;
  std::optional<double> configuration = {};  ///< none if there is only one configuration
  std::optional<double> clip = {};           ///< none if there is only one clip
  /// K/m and mu of each configuration by itself, for the table: if configuration_friction or configuration_drag is
  /// named, or the law holds within configurations but not across them.
  bool holds_within = false;
};

/// K/m, mu, alpha, v_lim of one configuration with the named causes in the model; the intervals include the remainder.
struct RecoveredConfiguration {
  std::string group;
  double mass_kg = 0.0;
  double incline_deg = 0.0;                               ///< as stated
  bool is_named_by_incline = false;                       ///< nobody named the group: `group` is its inclination
  std::vector<std::string> with = {};                     ///< ids of the causes in the model
  core::Quantity k_over_m_1_s, mu, alpha_deg, v_lim_m_s;  ///< undetermined ones say why
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  std::size_t points = 0;  ///< positions used
  std::vector<DiagnosedEffect> effects;
  double none = 0.0, unknown = 0.0;
  std::vector<RankedExplanation> ranking;
  std::optional<Stage> stage;  ///< where the gap is
  std::vector<GapRegion> regions;
  std::vector<GapCurve> curves;
  std::optional<GapSizes> gap;
  std::vector<ExplainedCause> explained;  ///< in order
  std::optional<GapRemainder> remainder;  ///< none if the gap before is not above its floor, and for lines
  std::vector<std::string> traces;        ///< ids: seen, but of no consequence to gap or parameters
  std::optional<GapLevels> levels;        ///< none for lines
  std::vector<RecoveredConfiguration> recovered;
  NextStep next;
  VerdictLimits limits;
  Isolability isolability;
  std::optional<LineComparison> lines;  ///< if the data are a table of published lines
  std::vector<ResidualCurve> residuals;
  std::vector<ImageFinding> images;  ///< empty for tracks
  std::vector<ImageCurve> image_curves;
  std::vector<CalibrationRests> calibrations;  ///< of each folder with a pattern
  std::vector<Note> notes;
  std::string twin;  ///< the fitted motions as a scenario file; empty for a table of lines
  std::vector<TwinLack> twin_lacks;
  std::vector<LikelyTwin> likely_twins;          ///< the reported explanation first; empty for a table of lines
  double twin_from_m = 0.0;                      ///< x of the data where the twin's x is 0
  std::vector<MeasuredMotion> measured;          ///< of the clips that a twin repeats; empty for a table of lines
  std::vector<core::LeftOutClip> left_out = {};  ///< clips that are not part of it
};

/// The explanations of the ranking with a probability of 1 % or more whose fits did not reach a minimum; none if all
/// did.
std::optional<FitsCutOff> fits_cut_off(const std::vector<RankedExplanation>& ranking);

/// Whether the nominal model follows the positions to within their noise, and the verdict is unknown only because of a
/// statement: an inclination that the motion contradicts, or a drag or friction below zero.
bool only_statements_fail(const Diagnosis& diagnosis);

/// Whether the nominal model follows the positions to within their noise.
bool is_at_floor(const Diagnosis& diagnosis);

/// An explanation that consists only of named effects.
struct NamedExplanation {
  std::vector<std::string> ids;
  double probability = 0.0;
};

/// Treats effects that these data cannot tell apart as one set: which effects are in it, and how likely it is that one
/// of them acts. Fills `alike` and `joint_probability` of each effect of a diagnosis that has its `equivalent_to`: the
/// sum over all explanations that contain it or one of those, each counted once. `words` translates an id into words.
void join_alike(const std::vector<NamedExplanation>& explanations,
                const std::function<std::string(const std::string& id)>& words, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
