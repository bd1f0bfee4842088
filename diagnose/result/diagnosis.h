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
#include "diagnose/result/line_comparison.h"
#include "diagnose/result/next_step.h"
#include "diagnose/result/note.h"

namespace glidelab::diagnose {

struct DiagnosedParameter {
  std::string key;  ///< with its unit, as in the list of effects
  double value = 0.0;
  double sd = 0.0;        ///< 0: not fitted
  std::string text = {};  ///< a word (a codec's name) instead of value and sd
  std::string why = {};   ///< why the data do not determine it; its value is then not a number
};

/// One of several effects that would look the same.
struct AlikeEffect {
  std::string id, words;
  std::optional<double> probability;  ///< none where no weighed explanation holds it: it counts under another's
};

struct DiagnosedEffect {
  std::string id;
  Stage stage = Stage::dynamics;
  std::string words;
  double probability = 0.0;                ///< that it acts, alone or with another
  std::vector<std::string> equivalent_to;  ///< effects that these data cannot tell from it
  std::vector<DiagnosedParameter> parameters;
  double joint_probability = 0.0;  ///< that it or one of `equivalent_to` acts
  /// It and those, by falling probability; empty where it stands alone.
  std::vector<AlikeEffect> alike = {};
};

struct RankedExplanation {
  Explanation explanation;
  double probability = 0.0;
  double log_evidence_gain = 0.0;  ///< against the nominal model
  double log_likelihood_gain = 0.0;
  std::size_t parameters = 0;                   ///< more than the nominal model has
  std::optional<double> gap_after;              ///< of held-out clips; where it was fitted in full
  std::optional<ImpossibleSize> left_out = {};  ///< why it was not weighed, where it was not
  bool converged = true;                        ///< false: its fit did not reach a minimum; it gains at least this much
};

struct GapRegion {
  GapVariable variable = GapVariable::time;
  double from = 0.0, to = 0.0;
  double excess = 0.0;  ///< size over its standard deviation, where that is largest
  double size = 0.0;    ///< the largest
  std::string unit;     ///< of size: N, m/s², m, N s/m
  GapKind what = GapKind::force;
  std::string clip;  ///< where it is one clip's
  /// What the nominal model lacks at most, in the size's unit, where the size is far more than that: not to be
  /// believed.
  std::optional<double> lacking = {};
  std::optional<double> size_sd = {};  ///< of the size; none where it is not from a curve or from lines
  int direction = 0;                   ///< sign of v of its lines; 0 for both directions, and where there are no lines
  std::optional<double> at = {};       ///< the variable where a curve has that size
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
  std::string quantity, against, group;
  std::optional<double> z_before = {}, z_after = {};  ///< none where it cannot be determined
  /// Of a part of the data alone, against all: the nominal model's fits, in the quantity's unit.
  std::optional<DiagnosedParameter> alone = {}, together = {};
};

/// 95 %, over clips (gap_sizes.h).
struct GapInterval {
  double low = 0.0, high = 0.0;
};

struct GapIntervals {
  std::optional<GapInterval> before, after, shrink, acceleration_before, acceleration_after;
  std::optional<std::size_t> too_few = {};  ///< number of clips, where it is the reason for the missing interval
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
  std::vector<PhaseBin> bins;     ///< by rising speed
};

/// How large the gap is in one domain, over what the noise alone would make (1).
struct GapDomain {
  std::string domain;  ///< positions, phase_plane, parameters, picture
  double before = 0.0;
  std::optional<double> after = {};  ///< none where it cannot be determined
};

/// There is a gap from this many standard errors above the floor. Three would do if the noise were exactly white and
/// normal; half as many more leave room for noise that is not.
inline constexpr double kClearGap = 4.5;

struct GapSizes {
  double before = 0.0, after = 0.0;
  double standard_error = 0.0;  ///< of a gap at the floor
  double floor = 1.0;           ///< below 1 where the best fit shows that the noise was taken as too large
  std::optional<double> shrink;
  std::vector<std::string> held_out;
  std::vector<double> before_by_clip, after_by_clip;
  std::optional<double> acceleration_before, acceleration_after;  ///< m/s²; none of lines, which hold no motion
  GapIntervals interval95;
  std::vector<GapOfParameter> parameters;
  std::vector<PhaseGap> phase_plane;  ///< all masses together, then each; empty of lines
  std::vector<GapDomain> domains;
};

/// Residuals of one motion for the plots, in metres, and the noise of each position.
struct ResidualCurve {
  std::string clip;
  std::vector<double> t_s, x_m, v_m_s, before_m, after_m;
  std::vector<double> noise_m = {};
};

/// Two effects are called alike from this cosine on: the second one then explains 90 % of what the first one gains.
inline constexpr double kAlike = 0.95;

/// Parts of the gap's excess that two explanations leave are the same within this: by causes/cause_odds.h it makes odds
/// of twenty.
inline constexpr double kSameLeft = 0.24;

/// How alike the changes by two effects are: the cosine of the angle between them, everything fitted projected out.
struct Isolability {
  std::vector<std::string> ids;
  std::vector<double> least_seen;           ///< size of each that makes one standard deviation
  std::vector<std::vector<double>> cosine;  ///< absolute
};

/// What the images of filmed clips say of one effect, whether or not it moves the positions.
struct PictureFinding {
  std::string id;
  Stage stage = Stage::optics;
  bool seen = false;
  double log_evidence = 0.0;  ///< of its presence against its absence, from the images alone
  bool stated = false;        ///< the file itself says so: named only for what it does to the positions
  std::vector<DiagnosedParameter> parameters;
  std::string words;  ///< a sentence
};

/// A measurement in the images for the plots: `lengthening` (px², of the marker's image over px/s), `brightness`
/// (relative, over time), `drift across`, `drift down` (px, of the fixed scene over time), `noise` (codes², a pixel's
/// variance over its level in codes).
struct PictureCurve {
  std::string what, clip;
  std::vector<double> at, value, sd;
  std::vector<double> expected, fitted;  ///< as stated, and as found; empty where there is none
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
  std::vector<std::string> ids;  ///< effects that it holds; none: the nominal model
  double probability = 1.0;      ///< beside the others of the list
  // What it leaves, as a random acceleration (causes/remainder.h).
  double q_m2_s3 = 0.0;     ///< spectral density of the white part
  double force_m_s2 = 0.0;  ///< sd from clip to clip of friction, and of inclination
  double drag = 0.0;        ///< relative sd from clip to clip of K
};

/// Positions of one clip as the analysis has them, for the comparison with a twin.
struct MeasuredMotion {
  std::string clip;
  double start_s = 0.0;      ///< of the twin's clip, after the data's first frame
  double noise_m = 0.0;      ///< of one position
  double bandwidth_s = 0.0;  ///< of the analysis' smoothing
  std::vector<double> t_s, x_m;
  std::vector<double> v_m_s, a_m_s2;  ///< smoothed, of the points that the lines rest on
};

/// What a reader must know before the verdict (verdict_details.h); also in the notes.
struct VerdictLimits {
  std::vector<NegativeLoss> driving;
  std::vector<ContradictedIncline> contradicted;
  std::optional<SetAside> set_aside;
};

/// One cause in the sequence that explains the gap, each added beside those before it.
struct ExplainedCause {
  std::string id;
  double share = 0.0;                                ///< (g²_{i-1} - g²_i)/(g²_0 - 1), g the gap of held-out clips
  std::optional<GapInterval> share_interval95 = {};  ///< over clips, or lines
  double gap_after = 0.0;                            ///< g_i
};

/// What is left of the gap beside the named causes.
struct GapRemainder {
  double share = 1.0;              ///< of the excess g²_0 - 1: what the causes' shares leave to 1
  double gap = 1.0;                ///< of held-out clips, with all causes in the model
  double acceleration_m_s2 = 0.0;  ///< rms of the random acceleration that would make it (remainder.h); 0: none is seen
  double clip_scatter_m_s2 = 0.0;  ///< sd, from clip to clip, of the acceleration by friction and inclination
  double drag_scatter = 0.0;       ///< relative sd, from clip to clip, of K
  std::vector<GapRegion> regions = {};
};

/// Gaps of held-out clips, or of fits, with parameters that are a clip's own, a configuration's (mass and set-up), or
/// common to all; all are root mean squares of residuals over the noise, corrected for the degrees of freedom that the
/// fits take.
struct GapLevels {
  double all = 1.0;
  std::optional<double> configuration = {};  ///< none where there is only one configuration
  std::optional<double> clip = {};           ///< none where there is only one clip
  /// K/m and mu of each configuration by itself, for the table: where configuration_friction or configuration_drag is
  /// named, or the law holds within configurations and not across them.
  bool holds_within = false;
};

/// K/m, mu, alpha, v_lim of one configuration with the named causes in the model; the intervals count the remainder.
struct RecoveredConfiguration {
  std::string group;
  double mass_kg = 0.0;
  double incline_deg = 0.0;                               ///< as stated
  std::vector<std::string> with = {};                     ///< ids of the causes in the model
  core::Quantity k_over_m_1_s, mu, alpha_deg, v_lim_m_s;  ///< undetermined ones say why
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  std::size_t points = 0;  ///< positions that took part
  std::vector<DiagnosedEffect> effects;
  double none = 0.0, unknown = 0.0;
  std::vector<RankedExplanation> ranking;
  std::optional<Stage> stage;  ///< where the gap is
  std::vector<GapRegion> regions;
  std::vector<GapCurve> curves;
  std::optional<GapSizes> gap;
  std::vector<ExplainedCause> explained;  ///< in order
  std::optional<GapRemainder> remainder;  ///< none where the gap before is not above its floor, or of lines
  std::vector<std::string> traces;        ///< ids: seen, but of no consequence to gap or parameters
  std::optional<GapLevels> levels;        ///< none of lines
  std::vector<RecoveredConfiguration> recovered;
  NextStep next;
  VerdictLimits limits;
  Isolability isolability;
  std::optional<LineComparison> lines;  ///< where the data are a table of published lines
  std::vector<ResidualCurve> residuals;
  std::vector<PictureFinding> pictures;  ///< empty for tracks
  std::vector<PictureCurve> picture_curves;
  std::vector<CalibrationRests> calibrations;  ///< of each folder with a pattern
  std::vector<Note> notes;
  std::string twin;  ///< the fitted motions as a scenario file; empty for a table of lines
  std::vector<TwinLack> twin_lacks;
  std::vector<LikelyTwin> likely_twins;  ///< the reported explanation first; empty for a table of lines
  double twin_from_m = 0.0;              ///< x of the data where the twin's x is 0
  std::vector<MeasuredMotion> measured;  ///< of the clips that a twin repeats; empty for a table of lines
};

/// Whether the nominal model follows the positions to within their noise, and the verdict is unknown only because of
/// what is stated: an inclination that the motion contradicts, a drag or friction below zero.
bool only_statements_fail(const Diagnosis& diagnosis);

/// An explanation that names effects and nothing else.
struct NamedExplanation {
  std::vector<std::string> ids;
  double probability = 0.0;
};

/// Takes effects that these data cannot tell apart as one set: which effects are in it, and how likely it is that one
/// of them acts. Fills `alike` and `joint_probability` of each effect of a diagnosis that has its `equivalent_to`: the
/// sum over all explanations that hold it or one of those, each counted once. `words` says what an id is for a person.
void join_alike(const std::vector<NamedExplanation>& explanations,
                const std::function<std::string(const std::string& id)>& words, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
