// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/rig_calibration_file.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/detail/auxiliary_recording.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/attitude/detail/recording_rates.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"

namespace tumble::scenarios {

const Settings<AngularRateSmoother::Params>& rate_tumble_settings();

const std::vector<std::string>& stated_densities();

AngularRateSmoother::Params stated_params(const sim::ImuRecord& record, AngularRateSmoother::Params params);

/// A parameter in `parameters` has priority over the IMU record, which has priority over the defaults of `settings`.
AngularRateSmoother::Params smoother_params(const sim::ImuRecord& record,
                                            const Settings<AngularRateSmoother::Params>& settings,
                                            const sim::Values& parameters);

MotionRegimeSmoother::Params regime_params(const sim::Sensors& sensors, const AngularRateSmoother::Params& rate);

Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out);

/// If the data of one auxiliary IMU are invalid, no auxiliary IMU is used.
RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReadingsToReplace replaced, Estimate& estimate);

/// Starts from the saved calibration `given`, and writes the new calibration to `found`; both may be null. If the run
/// fails, or estimates neither rig constants nor a saturation limit, `found` stays unchanged. The covariance of the
/// calibration `given` is multiplied by four and limited to the default prior, because rigs change between runs.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found);

/// The streaming method writes the new calibration only if the calibration's covariance decreased during the run.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                             std::optional<CalibratedRig>* found);

struct RigCalibrationUse {
  std::optional<CalibratedRig> given;  ///< empty: start without calibration
  std::optional<CalibratedRig> of_batch, of_stream;
  /// Returns the calibration `of_batch` (smoother over the whole recording) or, without it, `of_stream` (streaming
  /// method). If `of_batch` contains only saturation limits and `of_stream` contains more, the function returns
  /// `of_stream`.
  const CalibratedRig* found() const;
};

/// The returned method starts with the rig calibration in `learning`, and stores the new calibration there. The object
/// `learning` must outlive the method. If `learning` contains a rig calibration, the method also runs without this
/// calibration; if the two results differ, the new calibration is not saved.
Method calibrating_method(const Method& method, RigCalibrationUse& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
