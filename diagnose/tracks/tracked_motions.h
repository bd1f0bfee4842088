/// The measured motions of an experiment as a diagnosis takes them: positions, their noise, and the statements; whole,
/// thinned, or cut if a force drives them to and fro.
#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/local_gravity.h"
#include "core/result/results.h"
#include "diagnose/model/track_model.h"
#include "diagnose/result/note.h"

namespace glidelab::diagnose {

/// The noise that neighbouring frames of a filmed clip share (whitening.h); amplitudes are relative to the white noise.
struct NoiseShape {
  double pixels = 0.0, pixels_px = 0.4;
  double phase = 0.0, phase_px = 10.0;
  double lasting = 0.0, lasting_frames = 2.0;
  double jitter_s = 0.0;
};

/// The noise as the positions alone show it (position_noise.h).
struct PositionNoise {
  NoiseShape shape;
  double jitter_gain = 0.0, jitter_log_evidence = 0.0;  ///< of timing jitter, relative to the likeliest noise without
                                                        ///< it
  double jitter_s = 0.0, jitter_sd_s = 0.0;
  double lasting_gain = 0.0, lasting_log_evidence = 0.0;  ///< of errors that a codec passes on from frame to frame
};

/// An unmodelled remainder as a covariance in addition to the noise (causes/remainder.h): in units of the noise, 1 + U
/// L U' with U'U = 1.
struct Remainder {
  Eigen::MatrixXd span;    ///< U, one row a point
  Eigen::VectorXd shrink;  ///< 1 - 1/sqrt(1 + L): the reduction by whitening along each column of U
};

/// One stretch of motion without a collision or a rest in it; it may turn.
struct TrackedMotion {
  std::size_t clip = 0;     ///< index in TrackSet::clips
  std::size_t group = 0;    ///< index in TrackSet::groups
  std::size_t mass = 0;     ///< index in TrackSet::masses
  double start_s = 0.0;     ///< from the clip's first frame to the motion's first point
  std::vector<double> t_s;  ///< from the clip's first frame
  std::vector<double> x_m;
  std::vector<char> outlier;                  ///< 1: lies far from the cubic through its neighbours; not fitted
  double sd_m = 0.0;                          ///< noise of one position, from neighbouring positions alone
  std::vector<double> wider;                  ///< noise of each position over sd_m; empty: 1
  std::vector<double> coarser;                ///< part of `wider` that is due to a coarser last digit; empty: 1
  std::vector<std::vector<double>> shared_m;  ///< as in FreeBlock, or empty
  /// Index among them at which the errors by sub-pixel position begin (track_set.h).
  std::size_t first_pixel_mode = std::numeric_limits<std::size_t>::max();
  double step_m = 0.0;           ///< all positions of its clip are rounded to whole multiples of it, or the
                                 ///< coarsest of their steps; 0: not rounded
  double scale_sd = 0.0;         ///< relative
  double m_per_px = 0.0;         ///< along the motion; 0: not filmed
  std::vector<double> row_px;    ///< image row of the marker; empty: not filmed
  std::vector<double> along_px;  ///< image coordinate along the motion; empty: not filmed, or hardly moving
  /// For consecutive blocks of points, which together contain all: turns their noise over sd_of() into white noise
  /// (whitening.h). Empty: it is white.
  std::vector<Eigen::MatrixXd> whitening;
  Remainder remainder;  ///< none: its span has no columns
  KnownForce known;     ///< if one was recorded

  double sd_of(std::size_t point) const { return wider.empty() ? sd_m : sd_m * wider[point]; }
  /// Of a position by itself, whether or not its neighbours have the same error.
  double own_sd_of(std::size_t point) const { return coarser.empty() ? sd_m : sd_m * coarser[point]; }
};

struct TrackedMass {
  double mass_kg = 0.0;
  double sd_kg = 0.0;
};

struct InclineStatement {
  double alpha_rad = 0.0;
  double sd_rad = 0.0;
  Against against = Against::stated;  ///< the plumb line, or a reading
};

struct TrackGroup {
  std::string name;
  double stated_rad = 0.0;
  std::vector<InclineStatement> statements;  ///< those with a known uncertainty
  double x_mid_m = 0.0;                      ///< middle of the range of x
};

/// core::is_fall() of the stated inclination.
bool is_fall(const TrackGroup& group);

struct TrackedClip {
  std::string name;
  double frame_rate_hz = 0.0;
  double duration_s = 0.0;
  std::size_t frames = 0;
  double bandwidth_s = 0.0;  ///< of the analysis's smoothing
  /// As the analysis finds them (core/motion/free/lost_frames.h), in the file's times, from the clip's first frame.
  std::vector<core::LostFrames> lost = {};
};

struct TrackSet {
  double gravity_m_s2 = core::kStandardGravity_m_s2;
  double gravity_sd_m_s2 = 0.0;  ///< 0: exact
  std::vector<TrackedClip> clips;
  std::vector<TrackGroup> groups;
  std::vector<TrackedMass> masses;
  std::vector<TrackedMotion> motions;
  double x_mid_m = 0.0;      ///< middle of the range of x of all set-ups
  std::size_t modes = 0;     ///< shared errors of camera and plane
  bool pieces = false;       ///< clips are pieces of a single one (cut_driven_motions())
  bool images = false;       ///< at least one clip was filmed
  bool plain_scale = false;  ///< and no folder has a pattern: one stated scale, which holds somewhere along the path
  bool lossy = false;        ///< at least one clip has been through a lossy codec,
  bool handed_on = false;    ///< and one through a codec that predicts images from earlier ones:
  double held_m_s = 0.0;     ///< below this speed such a codec may hold the marker in place (0: none does)
  double camera_drift_m_s = 0.0;  ///< of a camera that images show to drift: an error of every speed
  std::optional<PositionNoise> position_noise;
  bool weight_open = false;   ///< what drives the falls, up to their weight, is fitted, as of a body in a liquid
  bool through_air = false;   ///< falls_through_air(); K then gives way to a quadratic drag (fit/drag_of_air.h)
  bool mass_assumed = false;  ///< nobody states a mass: forces, c and k are those of 1 kg
  bool no_drag = false;       ///< K is held at 0 whatever acts: for what a fall without any drag would do
  std::vector<Note> notes;
  /// Frames that the analysis took for a hand or a stop and that could belong to a motion.
  std::size_t disputed = 0;
  std::size_t left_out = 0;  ///< of these, all or none
  std::size_t moving = 0;    ///< frames of free motion, and disputed ones
};

/// The number of positions of all motions.
std::size_t points_of(const TrackSet& set);

/// The mass of the lightest body, in kg.
double lightest_kg(const TrackSet& set);

/// Whether only falls were recorded.
bool only_falls(const TrackSet& set);

/// Whether the motions are falls at speeds at which the drag of air is not viscous: only falls of 88 degrees and more
/// were recorded (below, something guides the body), no force drives them, and the mean speed over some quarter of a
/// motion (or two or three, or all of it) is above 0.5 m/s by more than three standard deviations of its noise.
///
/// Stokes drag needs a Reynolds number of about 1 or less. A sphere of radius r and density rho_s that falls at its
/// terminal velocity v = 2/9 (rho_s/rho - 1) g r²/nu with 2 r v = nu has v = (nu g (rho_s/rho - 1)/18)^(1/3): 0.2 m/s
/// for water drops in air (nu = 1.5e-5 m²/s). What falls faster through air is braked by its density. A large bead in a
/// thick liquid may be as fast at a Reynolds number of 10, with a power of the speed of 1.3: the size of the drag tells
/// it (weigh/air_odds.h).
bool falls_through_air(const TrackSet& set);

/// Whether the uncertainty of g counts in these motions: some set-up is a fall, or has an inclination alpha that is
/// known so well that the relative error of sin(alpha) is at most twice that of g. Elsewhere alpha takes it up.
bool gravity_matters(const TrackSet& set);

/// Whether a recorded force drives any of the motions: the next clip is then not a launch.
bool is_driven(const TrackSet& set);

/// Points from, from + every, ... before `to` of a motion; without its whitening.
TrackedMotion some_points(const TrackedMotion& motion, std::size_t from, std::size_t to, std::size_t every = 1);

/// Keeps every second, third, ... of more than 30,000 positions in all (except for motions with a recorded force:
/// cut_driven_motions()), with a note: enough for any law. Effects of single frames need neighbours, and show less
/// then. Motions with fewer than `fewest` points left are dropped.
void thin_out(TrackSet& set, std::size_t fewest);

/// Cuts motions that a recorded force drives to and fro into pieces.
///
/// An error of the modelled force is integrated twice over time, and a turn that comes a little early starts the next
/// run elsewhere. Over tens of turns chi² then has a local minimum for every order in which the modelled motion turns
/// and rests, and no fit converges to the right one. A piece turns twice, so that it holds both directions, and has a
/// start of its own. It is cut half way between turns, where the glider is fast. What shows only over more than one
/// piece, such as a slow drift, is lost.
///
/// Motions with a recorded force that turn more than four times are cut. At most 40 pieces and 8000 of their positions
/// are used, both spread evenly over clips and time (notes say so). Pieces of fewer than `fewest` points are dropped.
/// The pieces of a single clip become clips of their own, so that each can be held out.
void cut_driven_motions(TrackSet& set, std::size_t fewest);

/// The points at which a motion turns: it comes back from them by more than its noise or a jitter explains.
std::vector<std::size_t> turns_of(const TrackedMotion& motion);

}  // namespace glidelab::diagnose
