/// Which explanation the data bear out: nothing, one effect of the list, two, or something without a name.
///
/// Score tests make a short list; each of it is fitted in full, alone and with a second one, and so are pairs that show
/// together only (pair_scan.h); the log evidence is that
/// of the linear neighbourhood (sizes and shapes averaged over their prior) with the gain of the full fit in place of
/// the linear one. Something unnamed competes as unnamed.h has it, beside nothing and beside each leading explanation:
/// what an effect leaves unexplained counts against its name, unless it shows weakly in a filmed experiment, and is
/// worth less than a hundredth of the effect.
///
/// Prior odds: nothing 0.3, one effect 0.4 (shared by those that these data can show), two 0.1, unnamed 0.2.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "diagnose/frames/frame_effects.h"
#include "diagnose/frames/missing_frames.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/unnamed/unnamed.h"

namespace glidelab::diagnose {

struct Hypothesis {
  std::vector<std::size_t> effects;  ///< none, one or two, in the order found; more where pictures show them
  bool unnamed = false;              ///< and something besides
  double gain = 0.0;                 ///< log likelihood, against nothing
  double log_evidence = 0.0;         ///< against nothing, sizes averaged over their priors
  double probability = 0.0;
  int fit = -1;                       ///< index in Comparison::fits
  double unnamed_log_evidence = 0.0;  ///< the part of it that something unnamed has, beside effects or alone
};

struct Comparison {
  std::vector<MotionFit> fits;      ///< the nominal one first
  std::vector<Hypothesis> all;      ///< by falling probability
  std::vector<EffectScan> scans;    ///< around the nominal fit, as effect_list()
  std::vector<FrameEffect> frames;  ///< jitter, tails
  MissingFrames missing;
  std::vector<UnnamedFamily> unnamed;       ///< around nothing
  int left_fit = 0;                         ///< index of the best named explanation's fit
  std::vector<UnnamedFamily> unnamed_left;  ///< beside that named explanation with which they are likeliest
  int beside_fit = 0;                       ///< index of its fit
  std::set<std::size_t> in_pictures;        ///< effects that the pictures speak for or against
  double none = 0.0, unknown = 0.0;
  std::vector<double> effect_probability;  ///< of each of effect_list(), alone or with another
};

struct PictureEvidence;

/// `without` are effects that are not considered; `pictures`, what filmed clips show besides (null for tracks). `done`
/// is told before each fit, from any thread, how much of it is done (0 to 1); what it throws ends the comparison.
Comparison compare_hypotheses(
    const TrackSet& set, const std::vector<std::size_t>& without = {}, int jobs = 1,
    const PictureEvidence* pictures = nullptr, const std::function<void(double)>& done = [](double) {});

}  // namespace glidelab::diagnose
