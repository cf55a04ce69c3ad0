// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/rolling/rolling_model.hpp"
#include "tumble/rolling/rolling_params.hpp"

namespace tumble {

/// Pose of a rolling sphere from one IMU, through slip, slide and bumps, on a floor that is level or has slopes; live.
///
/// While the sphere grips, rolling is a velocity measurement; it calibrates tilt, biases, scale, misalignment, delay
/// and lever arm of the IMU, so that the seconds without grip can be integrated. Whether it grips is inferred: a Kalman
/// filter of the errors per hypothesis about the past modes, kept until what follows decides. The position is part of
/// each filter's state, so that the grip after an event mends the way made in it; older estimates are not revised
/// (RollingSmoother does that). While it stands still the position that is given out does too: what rest teaches of the
/// way before is taken up when the motion goes on, or at once where another hypothesis becomes the best.
///
/// Readings count by their time: those of a fast IMU are averaged to RollingExpertParams::reading_s before anything is
/// decided by them, and the estimate between two averages is the last one, carried on. Over a gap of up to gap_max_s
/// the rate is interpolated and the force unknown, which the covariance shows. A start in motion is told and believed
/// less.
///
/// While the gyro stands at its rail the attitude is unknown to that extent, and rolling says nothing: the position is
/// then bounded by the covariance alone. The state needs 430 KiB.
///
/// Not modelled: a floor that moves or gives way, wheels of the world under it. Heading drifts.
class RollingFilter {
 public:
  static constexpr int kStates = 40;
  static constexpr int kHypotheses = 32;
  using Params = RollingParams;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  /// One assumption about which modes there were, and what follows from it.
  struct Hypothesis {
    Vector x = Vector::Zero();  ///< errors: attitude (W), velocity and position of the IMU, constants
    Covariance P = Covariance::Zero();
    Eigen::Vector3d u_W_m_s = Eigen::Vector3d::Zero();  ///< contact velocity at the last node
    double log_weight = 0.0;                            ///< of its probability; the best one's is zero
    std::int64_t switched_node = 0;                     ///< since when it is in its mode
    std::int32_t parent = 0;                            ///< its place among the hypotheses of the node before
    RollingMode mode = RollingMode::grip;
    bool operator==(const Hypothesis&) const = default;
  };

  struct State {
    // The estimate at the last sample, by the best hypothesis.
    Eigen::Vector3d p_WG_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_WG_m_s = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d position_covariance_m2 = Eigen::Matrix3d::Zero();  ///< at the last node, over all hypotheses
    Eigen::Vector3d contact_velocity_m_s = Eigen::Vector3d::Zero();    ///< at the last node, W
    RollingMode mode = RollingMode::grip;
    double slip_probability = 0.0;  ///< that the contact moves, over all hypotheses, at the last node
    double bump_probability = 0.0;  ///< the part of it in which the sphere hops
    bool at_rest = false;
    bool spins_in_place =
        false;               ///< at rest but for a slow turn about the contact, which says nothing of the gyro's bias
    bool uncertain = false;  ///< in an event in which the position's sigma has grown by more than uncertain_m
    bool started_in_motion = false;
    std::int64_t gaps = 0;  ///< bridged
    double gap_longest_s = 0.0;
    // What the hypotheses have in common: they hold their errors about it.
    RollingNominal nominal;
    RollingSums sums;
    ImuAverage average;                                          ///< of the readings since the last one that was taken
    Eigen::Matrix3d pruned_spread_m2 = Eigen::Matrix3d::Zero();  ///< of hypotheses given up at the last node
    RestDetector::State rest;
    Eigen::Vector3d slow_rate_rad_s = Eigen::Vector3d::Zero();
    bool held = false;             ///< it stands still, and so does the position that is given out
    double before_event_m2 = 0.0;  ///< horizontal variance of the position at the last node without an event
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    std::array<Hypothesis, kHypotheses> hypotheses{};
    int count = 0;
    std::int64_t node = 0;
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit RollingFilter(const Params& params);

  /// Takes a sample. The first one levels the attitude (yaw 0) and puts the centre at the origin, at rest; a second of
  /// rest should follow. On trouble the state is unchanged. No allocation; about kHypotheses * kStates^2 * 40
  /// operations per node.
  Status step(const ImuSample& sample, State& state) const {
    return step(sample, state, [](const State&) {});
  }

  /// The same, and `closed(state)` after each node that it closes: several, where the sample ends a gap.
  template <typename Closed>
  Status step(const ImuSample& sample, State& state, Closed closed) const {
    return step_with(sample, state,
                     Listener{&closed, [](void* to, const State& at) { (*static_cast<Closed*>(to))(at); }});
  }

  /// What a state says at its last sample. Of the covariance the position's alone is known, the rest is zero.
  static RollingEstimate estimate(const State& state);

  /// What holds of every state that step() left, for one that comes from elsewhere; the first that does not.
  static Status check_state(const State& state);

 private:
  struct Listener {
    void* to;
    void (*call)(void*, const State&);
  };

  Status step_with(const ImuSample& sample, State& state, Listener listener) const;

  void start(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const;
  void bridge(const ImuSample& sample, double gap_s, State& state, Listener listener) const;
  void take_average(State& state, Listener listener) const;
  void close_node(const Eigen::Vector3d& next_rate_rad_s, State& state) const;
  void detect_rest(State& state) const;
  bool spins_in_place(const State& state) const;
  void correct_at_rest(State& state) const;
  void choose_modes(const Eigen::Vector3d& rate_I_rad_s, bool lost_heading, State& state) const;
  void rebase(bool lost_heading, State& state) const;
  void report(State& state) const;
  void call_uncertain(State& state) const;
  void hold(State& state) const;
  static Eigen::Matrix3d position_spread(const State& state);
  static void weigh_events(State& state);
  static void keep_first(std::size_t count, State& state);

  Params params_;
  RestDetector rests_;
};

}  // namespace tumble
