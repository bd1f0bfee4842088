/// A camera's numbers from its own flat fields and dark frames: photon transfer according to EMVA standard 1288 (linear
/// model).
///
///     mean code      mu   = offset + K (electrons from light + dark signal * exposure)
///     variance       s²   = K² read² + 1/12 + K (mu - offset)          from frame to frame, K in DN/e-
///     fixed pattern  s_p² = K² DSNU² + (PRNU (mu - mu_dark))²          from pixel to pixel, shading taken out
///
/// So the slope of variance over mean is the gain K, with no light meter. The line is fitted by weighted least squares
/// to all levels up to 70 % of saturation, including the dark frames if their noise shows above the quantisation.
/// Quantum efficiency is not among the results: it requires a calibrated light.
///
/// If the images violate the model, a number is missing, with the reason, rather than wrong. Such are images with a
/// gamma or tone curve (variance over mean or mean over exposure is not a straight line), demosaiced, denoised or
/// compressed images (noise of neighbouring pixels or successive frames is correlated).
///
/// Standard deviations: jackknife over the tiles of the image, widened by the misfit of the line if that is
/// significant, plus what quantisation may hide. That of a dark signal also includes the drift of the dark level from
/// set to set. They include the sampling of patterns: PRNU, DSNU and offset are parameters of the sensor type,
/// estimated from the pixels of this one.
///
/// Source: EMVA standard 1288, release 3.1 (2016), and release 4.0 Linear (2021): temporal variance, gain by regression
/// to 70 % of saturation, dark noise above 0.24 DN² only, linearity error, DSNU, PRNU, high-pass. Differences from the
/// standard: masked hot and dead pixels, tiles, saturation capacity also from the plateau above the peak of the
/// variance.
#pragma once

#include "base/long_work.h"
#include "core/characterize/camera_measurement.h"
#include "core/characterize/flat_field_folder.h"

namespace glidelab::core {

/// InputError for frames that cannot be used (flat_field_stack.h), and if no level is brighter than the dark frames or
/// all are saturated.
CameraMeasurement measure_camera(const FlatFieldFolder& folder, const base::Progress& progress);

}  // namespace glidelab::core
