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
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

/// Returns the settings of rate/tumble, with the library's defaults.
const Settings<RateSmoother::Params>& rate_tumble_settings();

/// Returns the names of the noise densities that a recording may contain.
const std::vector<std::string>& stated_densities();

/// Returns `params` with the lever arm, the noise densities and the ranges of an IMU record.
RateSmoother::Params stated_params(const sim::ImuRecord& record, RateSmoother::Params params);

/// Returns the parameters of the rate smoother for an IMU record. `parameters` has priority over the record, which has
/// priority over the defaults of `settings`.
RateSmoother::Params smoother_params(const sim::ImuRecord& record, const Settings<RateSmoother::Params>& settings,
                                     const sim::Values& parameters);

/// Returns the parameters of RegimeSmoother, with the gravity of the recording.
RegimeSmoother::Params regime_params(const sim::Sensors& sensors, const RateSmoother::Params& rate);

/// Converts the auxiliary IMUs: at most kAuxiliaryImusMax IMUs after the primary IMU, without `imu_reference`. Returns
/// the first error of a conversion.
Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out);

/// Runs rate/tumble from the saved calibration `given` (null: none), and writes the new calibration to `found` (may be
/// null). If the status is not ok, or the run estimated neither rig constants nor a saturation limit (learnt), `found`
/// stays unchanged. The covariance of `given` is multiplied by four and limited to the default prior, because rigs
/// change between runs.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found);

/// Runs the streaming method rate/tumble_lag from a saved calibration, like run_rate_tumble. The new calibration is
/// written only if its covariance decreased during the run.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                             std::optional<CalibratedRig>* found);

/// RigCalibrationUse is the calibration of one rig over several runs: each run starts with it and updates it.
struct RigCalibrationUse {
  std::optional<CalibratedRig> given;  ///< empty: start without calibration
  std::optional<CalibratedRig> of_batch, of_stream;
  /// Returns the calibration to save, or null if no run estimated one. The calibration of the smoother over the whole
  /// recording has priority, unless it contains only saturation limits and the stream estimated more.
  const CalibratedRig* found() const;
};

/// Returns a copy of `method` that starts with the calibration in `learning` and updates it. `learning` must outlive
/// the copy. If `learning` contains a calibration, the method also runs without it. If the two resulting calibrations
/// differ (calibration_distance), the estimate gets a failed health check and the calibration is not saved. Throws
/// BadInput if the method is neither rate/tumble nor rate/tumble_lag.
Method calibrating_method(const Method& method, RigCalibrationUse& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
