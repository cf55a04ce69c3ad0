// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/device_doubt.hpp"
#include "tumble/angular_velocity/detail/flight_sense.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/rail_watch.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_stream_params.hpp"
#include "tumble/angular_velocity/detail/rate_stream_state.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// The streaming form of RateSmoother: the same factors over a window of fixed length, one Gauss-Newton step per
/// sample, or every 5 ms where samples come faster; what leaves the window is marginalised into a Gaussian prior on the
/// next sample and on the RigConstants.
///
/// An estimate comes out when its sample is `lag_s` old, and a provisional one at once. A step is O(window): in
/// proportion to the rate of the samples beyond 200 Hz, to its square below; no allocation after the State is made.
/// Rails, upright ones and the tilted planes of a gyro's elements, are learnt as they show themselves (RailWatch); with
/// each that becomes known the window is read again, so that a clipped sample that was believed counts as believed only
/// where it left the window before its rail was seen. With the calibration of an earlier run the error is 1.1 times
/// that of the batch and 99 % lie within three deviations; without it the rig is learnt in the tumble that needs
/// it: 1.6 times, 1.2 with 0.5 s of lag (docs/maths/rate_stream.md has the draws). The samples of a flight err
/// together: the covariance of the rig, and of the rates with it, is inflated while few have been learnt from
/// (`rig_inflation`). What it does not model: see RateSmoother.
class RateStream {
 public:
  using Params = RateStreamParams;
  using Knot = RateStreamKnot;
  using State = RateStreamState;

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RateStream(const Params& params);

  /// A state before the first sample, with all memory that push() needs.
  State start() const;

  /// Takes one sample; `out` is the estimate of the sample that is lag_s old, empty while the window fills. On trouble
  /// (`non_finite`, `time_order`, `gap`) the state is left as it was and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }
  /// The same with what other IMUs on the body read at that time, one per RateModelParams::auxiliary_imus or none at
  /// all; else `too_few`.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;

  /// Provisional estimate of the newest sample; empty before the first.
  std::optional<RateState> newest(const State& state) const;

  /// Estimates of the samples still in the window that push() has not given out, oldest first, appended to `out`.
  void flush(const State& state, std::vector<RateState>& out) const;

  /// Whether the IMU can be believed just now: `out_of_range` with the name of an axis that has frozen (FrozenAxes; its
  /// rates state the fastest rate read as their deviation), or of an accelerometer of the other sense (FlightSense).
  Status doubt(const State& state) const;

  /// What has been learnt of the rig.
  RigCalibration calibration(const State& state) const { return {state.rig, inflated(state)}; }

  /// What readings are corrected for of the device's errors, and what is open of them. A late accelerometer is found
  /// from strokes where the device's sheet leaves it open; see RateStreamDelay.
  KnownSensorErrors sensor_errors(const State& state) const;

  /// True when two states will behave alike for ever (scratch space excluded), bit for bit.
  static bool equal(const State& a, const State& b);

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
  Status check_state(const State& state) const;

 private:
  void forget_oldest(State& state) const;
  void marginalise(std::size_t first, State& state) const;
  void remember_errors(const arrow::Block& block, arrow::ErrorMatrix& errors, State& state) const;
  void forget_left(State& state) const;
  void forget_rig(State& state) const;
  double delay_reach_s() const { return StrokeSums::kMostSamples * params_.period_s; }
  std::ptrdiff_t force_shift(const State& state) const;
  void pair_force(std::size_t k, State& state) const;
  std::size_t pair_newest(State& state) const;
  void count_strokes(State& state) const;
  TriadDelay guessed_delay(const State& state) const;
  void seek_delay(State& state) const;
  void take_delay(double delay_s, bool found, State& state) const;
  void refine_delay(State& state) const;
  void consider_errors(const arrow::BorderVector& rig_step, State& state) const;
  Eigen::Matrix3d of_device(std::size_t k, const State& state) const;
  void predict_covariance(State& state) const;
  double jump_before(const Knot& oldest, const State& state) const;
  void append(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state) const;
  void classify_again(State& state) const;
  void judge(bool all, State& state) const { judge_from(all ? 0 : state.window.size() - 1, state); }
  void judge_from(std::size_t changed, State& state) const;
  void doubt_unseen(std::size_t k, State& state) const;
  void forget_doubts(State& state) const;
  void doubt_possible_rails(State& state) const;
  bool may_clip(const ImuSample& sample, int axis, int sign, const State& state) const;
  static double run_slope(int axis, std::size_t first, std::size_t last, const State& state);
  void doubt_run(int axis, std::size_t first, std::size_t last, State& state) const;
  static Eigen::Vector3d approach(const std::vector<Knot>& window);
  static void remember_entry(const Knot& leaving, const Knot& next, State& state);
  void add_rails(const State& state, arrow::Corner& corner) const;
  void guess(Knot& knot, const Knot& previous, const State& state) const;
  void weigh(State& state) const;
  bool step(State& state) const;
  RigConstants::Matrix inflated(const State& state) const;
  bool near_rails(std::size_t at, const State& state) const;
  bool in_long_flight(std::size_t at, const State& state) const;
  double hidden_by_slopes(std::size_t at, int axis, const State& state) const;
  Eigen::Matrix3d doubted(std::size_t at, const State& state) const;
  void move_later(std::size_t at, double late_s, const State& state, RateState& out) const;
  RateState to_state(std::size_t at, const State& state) const;

  Params params_;
  RailWatch rails_;
  RestDetector rests_;
  HoldWatch holds_;
  FrozenAxes frozen_;
  FlightSense sense_;
  RateModel model_;
  DeviceDoubt device_;
  std::size_t capacity_;
  std::size_t every_;     ///< samples from one step to the next
  double given_delay_s_;  ///< of the accelerometer, as known beforehand
  bool delay_open_;       ///< the device may have another
};

}  // namespace tumble
