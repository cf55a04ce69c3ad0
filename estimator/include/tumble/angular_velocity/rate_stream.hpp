// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/device_uncertainty.hpp"
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_stream_params.hpp"
#include "tumble/angular_velocity/detail/rate_stream_state.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/sensor_health.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates angular velocity sample by sample with a fixed lag, also while the gyro is saturated. AngularRateStream
/// uses the measurement models of AngularRateSmoother over a sliding window of fixed length. By default,
/// AngularRateStream makes one Gauss-Newton step per sample. At sample rates of 400 Hz and above, AngularRateStream
/// makes one Gauss-Newton step for all samples within 5 ms. The equations are in docs/maths/rate_stream.md.
///
/// AngularRateStream detects the saturation limits of gyro and accelerometer from the readings. If AngularRateStream
/// starts with the calibration of an earlier run, its rate error is 1.1 times the rate error of AngularRateSmoother.
/// Without the calibration of an earlier run, the rate error is 1.6 times the rate error of AngularRateSmoother. The
/// limitations of AngularRateSmoother also apply to AngularRateStream.
///
/// Cost: O(window) per step. AngularRateStream allocates memory only in start().
class AngularRateStream {
 public:
  using Params = AngularRateStreamParams;
  using Knot = AngularRateStreamKnot;
  using State = AngularRateStreamState;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit AngularRateStream(const Params& params);

  State start() const;

  /// `out` receives the angular velocity at the sample that is `lag_s` older than `sample`. While the window fills,
  /// `out` is empty. On error (`non_finite`, `time_order`, `gap`), the state is unchanged and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<AngularRateState>& out) const {
    return push(sample, {}, state, out);
  }
  /// `auxiliary_imus` is empty, or contains one reading per entry of AngularRateModelParams::auxiliary_imus,
  /// interpolated at the time of `sample`. If the number of readings is wrong, push() returns `insufficient_data`.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<AngularRateState>& out) const;

  /// Returns the provisional angular velocity at the newest sample, or an empty result before the first sample.
  std::optional<AngularRateState> newest(const State& state) const;

  /// Appends the angular velocities at the samples in the window to `out`, oldest first. Call flush() at the end of a
  /// run.
  void flush(const State& state, std::vector<AngularRateState>& out) const;

  /// Reports current faults of the IMU: axes that stopped updating (FrozenAxes), and wrong signs of the accelerometer
  /// (FlightSignCheck).
  SensorHealth health(const State& state) const;

  /// Returns true while the estimated lever arm is no more accurate than its prior.
  bool calibration_is_prior(const State& state) const;

  RigCalibration calibration(const State& state) const { return {state.rig, inflated_calibration_covariance(state)}; }

  /// Returns the scale, misalignment, g-sensitivity and delay errors that are currently subtracted from the readings,
  /// with their covariance.
  KnownSensorErrors sensor_errors(const State& state) const;

 private:
  void marginalise_oldest_knots(State& state) const;
  void marginalise(std::size_t first, State& state) const;
  void marginalise_sensor_errors(const arrow::Block& block, arrow::ErrorMatrix& errors, State& state) const;
  void discard_marginalised_information(State& state) const;
  void reset_rig(State& state) const;
  double max_accel_delay_s() const { return ImpactDelayCorrelation::kDelayMax_samples * params_.period_s; }
  std::ptrdiff_t force_delay_samples(const State& state) const;
  void pair_force_with_rate(std::size_t k, State& state) const;
  std::size_t pair_newest_force(State& state) const;
  void add_impact_to_delay_correlation(State& state) const;
  TriadDelay estimate_delay_from_impacts(const State& state) const;
  void update_delay(State& state) const;
  void set_accelerometer_delay(double delay_s, bool found, State& state) const;
  void refine_delay(State& state) const;
  void add_sensor_error_covariance(const arrow::BorderVector& rig_step, State& state) const;
  Eigen::Matrix3d sensor_error_rate_covariance(std::size_t k, const State& state) const;
  void predict_covariance(State& state) const;
  double rate_change_since_marginalised(const Knot& oldest, const State& state) const;
  void append_knot(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state) const;
  void reclassify_window_clipping(State& state) const;
  void classify_window_clipping(bool all, State& state) const {
    classify_clipping_from(all ? 0 : state.window.size() - 1, state);
  }
  void classify_clipping_from(std::size_t changed, State& state) const;
  void mark_undetected_clipping(std::size_t k, State& state) const;
  void clear_suspected_saturation(State& state) const;
  void mark_possible_saturation(State& state) const;
  bool is_near_saturation_limit(const ImuSample& sample, int axis, int sign, const State& state) const;
  static double plateau_slope(int axis, std::size_t first, std::size_t last, const State& state);
  void mark_suspected_plateau(int axis, std::size_t first, std::size_t last, State& state) const;
  static Eigen::Vector3d min_recent_increase_rad_s(const std::vector<Knot>& window);
  static void store_slope_before_clipping(const Knot& leaving, const Knot& next, State& state);
  void add_misalignment_prior(const State& state, arrow::Corner& corner) const;
  void predict_new_knot(Knot& knot, const Knot& previous, const State& state) const;
  void compute_flight_weight(State& state) const;
  bool step(State& state) const;
  RigConstants::Matrix inflated_calibration_covariance(const State& state) const;
  bool is_possibly_saturated(std::size_t at, const State& state) const;
  bool in_long_flight(std::size_t at, const State& state) const;
  double saturation_deficit_from_slopes_rad_s(std::size_t at, int axis, const State& state) const;
  Eigen::Matrix3d inflated_rate_covariance(std::size_t at, const State& state) const;
  void extrapolate_estimate(std::size_t at, double late_s, const State& state, AngularRateState& out) const;
  AngularRateState rate_state_of_knot(std::size_t at, const State& state) const;

  Params params_;
  StreamingClippingFinder clipping_finder_;
  RestDetector rest_detector_;
  RepeatDetector repeat_detector_;
  FrozenAxes frozen_axes_;
  FlightSignCheck flight_axis_sign_check_;
  AngularRateModel model_;
  SensorErrorUncertainty sensor_error_uncertainty_;
  std::size_t window_knots_;
  std::size_t samples_per_step_;        ///< number of samples per Gauss-Newton step
  double prior_accelerometer_delay_s_;  ///< prior delay of the accelerometer relative to the gyro
  bool delay_is_estimated_;
};

}  // namespace tumble
