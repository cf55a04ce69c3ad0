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

/// Returns the parameters of rate/tumble with the library's defaults.
const Settings<RateSmoother::Params>& rate_tumble_settings();

/// Returns the names of the noise densities that a recording may state.
const std::vector<std::string>& stated_densities();

/// Returns `params` with the lever arm, noise and ranges of an IMU record.
RateSmoother::Params stated_params(const sim::ImuRecord& record, RateSmoother::Params params);

/// Returns the smoother's parameters. `parameters` override the values of the record, which override the defaults of
/// `settings`.
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const Settings<RateSmoother::Params>& settings,
                                     const sim::Values& parameters);

/// Returns the parameters of RegimeSmoother with the gravity of the recording.
RegimeSmoother::Params regime_params(const sim::Sensors& sensors, const RateSmoother::Params& rate);

/// Converts the auxiliary IMUs: the first ones except `imu_reference`, at most kAuxiliaryImusMax. Returns the first
/// error of the conversion of a record.
Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out);

/// Runs rate/tumble from the saved calibration `given` (null: none) and writes the new calibration to `found` (may be
/// null). `found` is unchanged if the status is not ok, or if the run estimated neither the constants nor a saturation
/// level (learnt). The covariance of `given` is multiplied by four,
/// because rigs change between runs, but never exceeds the default prior.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found);

/// Runs the streaming method rate/tumble_lag with a saved calibration, like run_rate_tumble. The method saves its
/// calibration only if the covariance decreased.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                             std::optional<CalibratedRig>* found);

/// Calibration from which several runs on one rig start, and which each run updates.
struct RigCalibrationUse {
  std::optional<CalibratedRig> given;  ///< empty: start without calibration
  std::optional<CalibratedRig> of_batch, of_stream;
  /// Returns the calibration to save; null if none. Prefers the result of the smoother over the whole recording. If the
  /// smoother only found saturation levels and the stream found more, returns the streaming result.
  const CalibratedRig* found() const;
};

/// Returns `method` with a calibration that starts from and updates `learning`. `learning` must outlive the returned
/// method. If `learning` has a start calibration, the method also runs without this calibration. If the results of the
/// two runs differ (calibration_distance), the estimate gets a failed health check and no calibration is saved. Throws
/// BadInput unless the method is rate/tumble or rate/tumble_lag.
Method calibrating_method(const Method& method, RigCalibrationUse& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
