// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/rig_calibration_file.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/auxiliary_recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/attitude/regime_smoother.hpp"

namespace tumble::scenarios {

/// Returns the settings of rate/tumble, with the library's defaults.
const Settings<RateSmoother::Params>& rate_tumble_settings();

/// Returns the names of the noise densities that a recording may state.
const std::vector<std::string>& stated_densities();

/// Returns `params` with the lever arm, noise densities and ranges of an IMU record.
RateSmoother::Params stated_params(const sim::ImuRecord& record, RateSmoother::Params params);

/// Returns the parameters of the rate smoother for an IMU record. The values in `parameters` override the values of the
/// IMU record, which override the defaults of `settings`.
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const Settings<RateSmoother::Params>& settings,
                                     const sim::Values& parameters);

/// Returns the parameters of RegimeSmoother for a recording, with the gravity of the recording.
RegimeSmoother::Params regime_params(const sim::Sensors& sensors, const RateSmoother::Params& rate);

/// Converts the auxiliary IMUs: all IMUs after the primary IMU except `imu_reference`, at most kAuxiliaryImusMax.
/// Returns the first error that the conversion of a record reports.
Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out);

/// Runs rate/tumble with the saved calibration `given` (null: none), and writes the new calibration to `found` (may be
/// null). The run leaves `found` unchanged if its status is not ok, or if it estimated neither rig constants nor a
/// saturation level (learnt). The covariance of `given` is multiplied by four, because rigs change between runs, but
/// limited to the default prior.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found);

/// Runs the streaming method rate/tumble_lag with a saved calibration, like run_rate_tumble. The method saves its
/// calibration only if the covariance decreased during the run.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                             std::optional<CalibratedRig>* found);

/// RigCalibrationUse is a calibration with which several runs on one rig start, and which each run updates.
struct RigCalibrationUse {
  std::optional<CalibratedRig> given;  ///< empty: start without calibration
  std::optional<CalibratedRig> of_batch, of_stream;
  /// Returns the calibration to save, or null if no run estimated a calibration. The function prefers the calibration
  /// from the smoother over the whole recording. If the smoother found only saturation levels and the stream found
  /// more, the function returns the calibration of the stream.
  const CalibratedRig* found() const;
};

/// Returns a copy of `method` that starts with the calibration in `learning` and updates it. The object `learning` must
/// outlive the returned method. If `learning` contains a calibration at the start, the method also runs without this
/// calibration. If the two resulting calibrations differ (calibration_distance), the estimate gets a failed health
/// check and the calibration is not saved. Throws BadInput unless the method is rate/tumble or rate/tumble_lag.
Method calibrating_method(const Method& method, RigCalibrationUse& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
