// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

/// Impl contains the parameters of an AngularRateStream, objects and numbers derived from the parameters, and the
/// functions that update the state.
struct AngularRateStream::Impl {
  explicit Impl(const Params& params);

  void marginalise_oldest_knots(State& state) const;
  void marginalise(std::size_t first, State& state) const;
  void marginalise_sensor_errors(const arrow::Block& block, arrow::ErrorMatrix& errors, State& state) const;
  void discard_marginalised_information(State& state) const;
  void reset_rig(State& state) const;
  double max_accel_delay_s() const { return ImpactDelayCorrelation::kDelayMax_samples * params.period_s; }
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
  BodyImuConstants::Matrix inflated_calibration_covariance(const State& state) const;
  bool is_possibly_saturated(std::size_t at, const State& state) const;
  bool in_long_flight(std::size_t at, const State& state) const;
  double saturation_deficit_from_slopes_rad_s(std::size_t at, int axis, const State& state) const;
  Eigen::Matrix3d inflated_rate_covariance(std::size_t at, const State& state) const;
  void extrapolate_estimate(std::size_t at, double late_s, const State& state, AngularRateState& out) const;
  AngularRateState rate_state_of_knot(std::size_t at, const State& state) const;

  Params params;
  StreamingClippingFinder clipping_finder;
  RestDetector rest_detector;
  RepeatDetector repeat_detector;
  FrozenAxes frozen_axes;
  FlightSignCheck flight_axis_sign_check;
  AngularRateModel model;
  SensorErrorUncertainty sensor_error_uncertainty;
  std::size_t window_knots;
  std::size_t samples_per_step;        ///< number of samples per Gauss-Newton step
  double prior_accelerometer_delay_s;  ///< prior delay of the accelerometer relative to the gyro
  bool delay_is_estimated;
};

}  // namespace tumble
