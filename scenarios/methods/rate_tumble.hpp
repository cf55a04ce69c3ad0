// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/rate_regimes.hpp"
#include "scenarios/methods/rig_calibration_file.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

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

/// Result of the rate smoother on a recording. The result includes the rates of the hand-held smoother if the hand-held
/// smoother ran (join_regimes).
struct SmoothedRates {
  std::vector<RateState> rates;  ///< one per sample
  RateReport report;
  CarriedBody carried;  ///< result of join_regimes
  std::size_t auxiliary_imus = 0;
};

/// Smooths the rates of `samples`, which may differ from the recording's readings. Adds the smoother's report to the
/// health and the failed checks of `result`.
Status tumble_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateSmoother::Params params,
                    SmoothedRates& out, Estimate& result);

/// Adds the readings of auxiliary IMUs, at the stamps of `samples`. Uses the first auxiliary IMUs except
/// `imu_reference`, at most kAuxiliaryImusMax, and writes their calibrated mountings to `model`. Returns the first
/// error of the conversion of a record.
Status auxiliary_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateModelParams& model,
                          std::vector<std::vector<AuxiliaryReading>>& out);

/// Runs rate/tumble from the saved calibration `given` (null: none) and writes the new calibration to `found` (may be
/// null). `found` is unchanged if the status is not ok. `found` is also unchanged if the run neither estimated the
/// constants nor is certain of a saturation level (with_rails). The covariance of `given` is multiplied by four,
/// because rigs change between runs, but never exceeds the default prior.
Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                         std::optional<LearntRig>* found);

/// Runs the streaming method rate/tumble_lag with a saved calibration, like run_rate_tumble. The method saves its
/// calibration only if the covariance decreased.
Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                             std::optional<LearntRig>* found);

/// Sets the smoother's priors from a saved calibration: lever arm and inertia with four times their covariance, and the
/// saturation levels. Saved biases are not used, because biases change at every switch-on.
void start_from_learnt(const LearntRig& rig, RateSmoother::Params& params);

/// Returns the calibration before a run: `given`, or the prior in `model` if `given` is null.
LearntRig known_before(const LearntRig* given, const RateModelParams& model);

/// Calibration from which several runs on one rig start, and which each run updates.
struct Learning {
  std::optional<LearntRig> given;  ///< empty: start without calibration
  std::optional<LearntRig> of_batch, of_stream;
  /// Returns the calibration to save; null if none. Prefers the result of the smoother over the whole recording. If the
  /// smoother only found saturation levels and the stream found more, returns the streaming result.
  const LearntRig* found() const;
};

/// Returns the distance between two calibrations: the larger of the Mahalanobis distances of lever arm and inertia,
/// each divided by the square root of the number of unknowns. Two runs on an unchanged rig gave 0.14 to 1.0 in 18
/// pairs. An inertia error of 30 % gave at least 2.3. Like start_from, the function multiplies the covariance of
/// `before` by `trust`.
double distance_of_rigs(const RigCalibration& before, const RigCalibration& now, double trust);

/// Returns `method` with a calibration that starts from and updates `learning`. `learning` must outlive the returned
/// method. If `learning` has a start calibration, the method also runs without this calibration. If the results of the
/// two runs differ (distance_of_rigs), the estimate gets a failed health check and no calibration is saved. Throws
/// BadInput unless the method is rate/tumble or rate/tumble_lag.
Method learning_method(const Method& method, Learning& learning);

Method rate_tumble_lag();

}  // namespace tumble::scenarios
