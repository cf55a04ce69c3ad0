// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates attitude and angular velocity of hand-held motion sample by sample, with a fixed lag. HandHeldRateStream
/// uses the motion model of HandHeldSmoother in a sliding window of time steps (nodes).
///
/// Memory is allocated only in start().
///
/// Unlike HandHeldSmoother, HandHeldRateStream does not test other numbers of full revolutions during saturation. The
/// rate covariance includes the error of one undetected revolution: carried.md (C41), (C42).
///
/// Cost: O(window) per node while a sample in the window is clipped, and a fifth of this cost otherwise.
class HandHeldRateStream {
 public:
  struct Params {
    HandHeldSmoother::Params body;  ///< `iterations_max` is ignored
    double period_s = 0.01;
    double lag_s = 0.2;
    double window_s = 0.6;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.body);
      visit(p.period_s, {"period_s", "s", 1e-5, 1.0, "nominal time between samples"});
      visit(p.lag_s, {"lag_s", "s", 2e-5, 10.0,
                      "age of a sample when its estimate is reported; a larger value adds delay and makes the estimate "
                      "more accurate"});
      visit(p.window_s,
            {"window_s", "s", 1e-3, 20.0, "length of the sliding window; a longer window costs more computing time"});
    }
  };

  struct Reading {
    ImuSample sample;
    ClipSigns clip_signs;
    /// centre and end of the sample's averaging window, relative to the centre of the first sample's window
    double window_centre_s = 0.0, end_s = 0.0;
    std::int64_t node = 0;  ///< node closest to `window_centre_s`
    bool is_stationary = false;
    RepeatedReading gyro, accel;               ///< age of the readings in a log that repeats readings
    std::optional<AngularRateState> smoothed;  ///< rate of a sample whose node has left the window, not yet returned
  };
  struct Knot {
    hand_held::Node node;
    hand_held::NodeReadings readings;
  };
  struct State {
    std::vector<Reading> readings;  ///< of the nodes in `window`
    std::vector<Knot> window;       ///< oldest first
    std::int64_t first_node = 0;
    Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();
    hand_held::Constants constants;
    hand_held::System::BorderMatrix constants_covariance = hand_held::System::BorderMatrix::Zero();
    // Gaussian prior on the oldest node and on the constants (biases, lever arm), from all earlier data.
    hand_held::System::StateBlock prior;
    hand_held::System::BorderBlock prior_border_block;
    hand_held::Node prior_node;
    hand_held::Constants prior_constants;
    double hand_acceleration_power_ratio = 1.0;  ///< measured / assumed power of the hand's acceleration
    RestDetector::State stationary_state;
    std::int64_t reported_node = -1;
    Eigen::Matrix3d reported_covariance_rad2_s2 = Eigen::Matrix3d::Zero();
    std::int64_t start_ns = 0;
    std::size_t samples = 0;
    std::size_t failures = 0;  ///< Gauss-Newton steps skipped because the normal equations were not positive definite
    /// For each gyro element: duration of the current saturation, and integral of the rate's standard deviation over
    /// this time.
    Eigen::Vector3d clipped_duration_s = Eigen::Vector3d::Zero(), clipped_angle_sigma_rad = Eigen::Vector3d::Zero();
    std::size_t revolutions_ambiguous = 0;  ///< number of saturated intervals that may contain an undetected revolution
    std::vector<hand_held::System::StateBlock> work_blocks;  ///< buffer
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldRateStream(const Params& params);

  /// The returned state has all memory that push() needs.
  State start() const;
  /// Restarts the estimation without allocating memory. Counters keep their values.
  void restart(State& state) const;

  /// Processes one sample. `out` receives the rate at the sample that is `lag_s` older. While the window fills, or if
  /// `wanted` is false, `out` is empty. `known` contains the clip signs of the newest samples, including `sample`, with
  /// the saturation limits known so far. `repeated` states which gyro and accelerometer readings repeat an earlier
  /// reading (sample and hold), and must not be used twice.
  ///
  /// Returns `ok`, `non_finite`, `time_order`, `gap`, `out_of_range` (no clip signs) or `degenerate` (linearly
  /// dependent sensing directions). On error, `state` is unchanged and `out` is empty.
  Status push(const ImuSample& sample, const SensingAxisClipSigns& known, State& state,
              std::optional<AngularRateState>& out, bool wanted = true,
              const RepeatDetector::State& repeated = {}) const;

  /// Appends the rates at those samples in the window that were not yet returned, oldest first.
  void flush(const State& state, std::vector<AngularRateState>& out) const;

 private:
  void append_reading(const ImuSample& sample, const RepeatDetector::State& repeated, State& state) const;
  void add(const Reading& reading, State& state) const;
  bool update_clip_signs(const SensingAxisClipSigns& known, State& state) const;
  void rebuild_window(State& state) const;
  hand_held::Node first_node(const State& state) const;
  void predict(const hand_held::Node& before, const Eigen::Matrix3d& rows, Knot& knot) const;
  void predict_newest(State& state) const;
  hand_held::ReadingNoise adapted_noise(const State& state) const;
  std::size_t first_unreported_reading(const State& state) const;
  void store_oldest_rates(State& state) const;
  void prune_output_samples(State& state) const;
  void marginalise_oldest(State& state) const;
  double hand_acceleration_power_ratio(const State& state) const;
  void add_prior(const State& state, hand_held::System::StateBlock& block,
                 hand_held::System::BorderBlock& corner) const;
  bool factorise(const hand_held::Motion& motion, const hand_held::ReadingNoise& noise, State& state,
                 hand_held::System::BorderVector& step) const;
  bool step(State& state) const;
  void extend_nodes(State& state) const;
  AngularRateState compute_report(std::size_t at, bool due, bool factorised, State& state) const;
  void report_rates(std::size_t first, std::size_t last, bool factorised, State& state,
                    std::span<AngularRateState> out) const;
  void count_revolutions(std::size_t at, const AngularRateState& rate, State& state) const;
  AngularRateState rate_state_of_reading(const Reading& reading, const State& state,
                                         const Eigen::Matrix3d& covariance_rad2_s2) const;

  Params params_;
  RestDetector rest_detector_;
  hand_held::Motion motion_, inflated_motion_;
  hand_held::ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::size_t nodes_max_, readings_max_, delay_;
};

}  // namespace tumble
