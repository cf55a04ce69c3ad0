// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_stream_params.hpp"
#include "tumble/angular_velocity/detail/rate_stream_state.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates angular velocity sample by sample with a fixed lag, also while the gyro is saturated. AngularRateStream
/// uses the measurement models of AngularRateSmoother over a sliding window of fixed length. At sample rates below 400
/// Hz, AngularRateStream makes one Gauss-Newton step per sample. At sample rates of 400 Hz and above, AngularRateStream
/// makes one Gauss-Newton step for all samples within 5 ms. The equations are in docs/maths/rate_stream.md.
///
/// AngularRateStream detects the saturation limits of gyro and accelerometer from the readings. If AngularRateStream
/// starts with the calibration of an earlier run, its rate error is 1.1 times the rate error of AngularRateSmoother.
/// Without the calibration of an earlier run, the rate error is 1.6 times the rate error of AngularRateSmoother. The
/// limitations of AngularRateSmoother also apply to AngularRateStream.
///
/// Cost: O(window) per step. AngularRateStream allocates memory only in its constructor and in start().
class AngularRateStream {
 public:
  using Params = AngularRateStreamParams;
  using Knot = AngularRateStreamKnot;
  using State = AngularRateStreamState;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit AngularRateStream(const Params& params);

  State start() const;

  /// `out` receives the angular velocity at the sample that is `lag_s` older than `sample`. While the sliding window
  /// fills at the start of a run, `out` is empty. If push() returns an error (`non_finite`, `time_order`, `gap`), the
  /// state is unchanged and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<AngularRateState>& out) const {
    return push(sample, {}, state, out);
  }
  /// `auxiliary_imus` is empty, or contains one reading per entry of AngularRateModelParams::auxiliary_imus,
  /// interpolated at the time of `sample`. If the number of auxiliary readings is different, push() returns
  /// `insufficient_data`.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<AngularRateState>& out) const;

  /// Returns the provisional angular velocity at the newest sample, or an empty result before the first sample.
  std::optional<AngularRateState> newest(const State& state) const;

  /// Appends the angular velocities at the samples in the sliding window to `out`, oldest first. Call flush() at the
  /// end of a run.
  void flush(const State& state, std::vector<AngularRateState>& out) const;

  /// Reports current faults of the IMU: axes that stopped updating (FrozenAxes), and wrong signs of the accelerometer
  /// (FlightSignCheck).
  SensorHealth health(const State& state) const;

  /// Returns true while the estimated lever arm is no more accurate than its prior.
  bool lever_arm_is_prior(const State& state) const;

  BodyImuCalibration body_imu_calibration(const State& state) const;

  /// Returns the scale, misalignment, g-sensitivity and delay errors that are currently subtracted from the readings,
  /// with their covariance.
  KnownSensorErrors sensor_errors_except_biases(const State& state) const;

 private:
  struct Impl;

  std::shared_ptr<const Impl> impl_;  // constant after construction, so copies of AngularRateStream share one Impl
};

}  // namespace tumble
