/// Truth compared with estimate: errors of the recovered values and of the restituted positions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "core/result/why_unknown.h"
#include "fit/outside/outside_tally.h"
#include "validate/truth/cramer_rao.h"
#include "validate/truth/truth_folder.h"

namespace glidelab::validate {

/// One quantity of one configuration. Values that the truth does not have, or that the data do not determine, are
/// empty.
struct QuantityComparison {
  std::string configuration;  ///< its name in the scenario
  double mass_kg = 0.0;
  double incline_deg = 0.0;  ///< as stated
  std::string estimator;
  std::string quantity;  ///< a key of core::kQuantities
  std::optional<double> truth;
  std::optional<double> value;
  std::optional<double> sd;
  std::optional<double> error;               ///< value - truth
  std::optional<core::WhyUnknown> why;       ///< why there is no value
  std::optional<double> cramer_rao_sd = {};  ///< smallest sd that the positions' noise allows (cramer_rao.h)
  std::optional<double> efficiency = {};     ///< (cramer_rao_sd / noise_sd)²
  /// The part of the sd due to the positions' noise: the bound does not include clock, calibration or scale either.
  std::optional<double> noise_sd = {};
};

struct LineComparison {
  std::string clip;
  int direction = 0;
  double r2 = 0.0;
};

/// A restituted position with the true one.
struct RestitutionPoint {
  std::size_t clip = 0;  ///< index into the results' clips
  double t_s = 0.0;
  double x_m = 0.0;      ///< true, in the analysis' coordinate
  double error_m = 0.0;  ///< measured - true
  std::size_t frame = 0;
};

/// Over all frames in which the marker was found.
struct RestitutionComparison {
  double rms_m = 0.0;
  double max_m = 0.0;    ///< largest absolute error
  double field_m = 0.0;  ///< range of the true positions of all clips: the part of the field of view that the motion
                         ///< covers
  std::vector<RestitutionPoint> points;
};

struct Comparison {
  std::vector<QuantityComparison> quantities;
  std::vector<LineComparison> lines;
  RestitutionComparison restitution;
  std::size_t frames = 0;
  std::size_t detected = 0;
  /// If the camera does not see all of a motion; set by the caller that filmed it.
  std::size_t frames_out_of_view = 0;             ///< with the marker's centre outside the image
  std::vector<std::string> out_of_view;           ///< in words, of each clip with such frames
  double wall_s = 0.0;                            ///< of simulation, rendering and analysis; set by the caller that
                                                  ///< measures it
  std::optional<fit::OutsideTally> outside = {};  ///< outcome of an outside estimator's run
};

/// The quantities of one estimator, configuration by configuration: K/m, mu, alpha, v_lim.
std::vector<QuantityComparison> compare_quantities(const core::AnalysisResults& results, const Truth& truth);

/// The same with the bounds of their configurations, and the efficiency if there is a noise_sd.
std::vector<QuantityComparison> with_bounds(std::vector<QuantityComparison> quantities,
                                            const std::vector<LeastSd>& bounds);

/// Quantities of several estimators, those of one configuration together.
std::vector<QuantityComparison> join_estimators(std::vector<QuantityComparison> first,
                                                const std::vector<QuantityComparison>& second);

/// Compares the results with the truth. Configurations are matched through their clips, frames by their number. The
/// field is the range of the true positions and not the width of the view, so that an error relative to it is never
/// made small by an empty margin. InputError if results and truth do not belong to one experiment.
Comparison compare(const core::AnalysisResults& results, const Truth& truth);

}  // namespace glidelab::validate
