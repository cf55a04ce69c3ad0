// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_model.hpp"
#include "tumble/rolling/detail/rolling_params.hpp"

namespace tumble {

/// Estimates the pose of a rolling sphere from one IMU, live, through slip, slide and bumps, on a level or sloped
/// floor.
///
/// While the sphere grips the floor, the rolling constraint measures the velocity: centre velocity = angular velocity x
/// (radius * floor normal). This measurement also determines tilt and sensor errors, so RollingFilter can integrate the
/// IMU through several seconds of slip. A separate error-state Kalman filter follows each hypothesis about the past
/// contact modes (grip, slip, bump, incline, rough floor). The equations are in docs/maths/rolling.md.
///
/// While the sphere is at rest, the reported position is constant, unless another hypothesis about the contact modes
/// becomes the most probable one. Position corrections that RollingFilter computes at rest change the reported position
/// when motion resumes.
///
/// RollingFilter bridges gaps of up to kGapMax_s between samples. In a gap, the angular velocity is interpolated, the
/// specific force is unknown, and the covariance grows. While the gyro is saturated, the rolling constraint is not
/// used, and the position covariance grows.
///
/// RollingFilter assumes a rigid, unmoving floor. The heading drifts. The state of RollingFilter needs 430 KiB of
/// memory.
class RollingFilter {
 public:
  static constexpr int kStates = 40;
  static constexpr int kHypotheses = 32;
  using Params = RollingParams;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  /// Possible sequence of contact modes, with the estimate for this sequence.
  struct Hypothesis {
    Vector x = Vector::Zero();  ///< errors of attitude (world axes), velocity and position of the IMU, and constants
    Covariance covariance = Covariance::Zero();
    Eigen::Vector3d contact_velocity_W_m_s =
        Eigen::Vector3d::Zero();          ///< velocity of the contact point at the last time step
    double log_weight = 0.0;              ///< log probability relative to the most probable hypothesis
    std::int64_t first_step_of_mode = 0;  ///< time step at which the current contact mode began
    std::int32_t parent = 0;              ///< index of the preceding hypothesis at the previous time step
    ContactMode mode = ContactMode::grip;
    bool operator==(const Hypothesis&) const = default;
  };

  struct State {
    // pose and velocity at the last sample, from the most probable hypothesis
    Eigen::Vector3d sphere_centre_W_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d sphere_velocity_W_m_s = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    /// position covariance at the last time step of 20 ms, including the differences between the hypotheses
    Eigen::Matrix3d position_covariance_m2 = Eigen::Matrix3d::Zero();
    Eigen::Vector3d contact_velocity_m_s =
        Eigen::Vector3d::Zero();  ///< velocity of the contact point at the last time step, in world axes
    ContactMode mode = ContactMode::grip;
    double slip_probability = 0.0;  ///< probability that the contact point moves, at the last time step
    double bump_probability = 0.0;  ///< part of slip_probability for modes in which the sphere hops
    bool at_rest = false;
    bool spins_in_place = false;  ///< the sphere rotates slowly about the contact point; no update of the gyro bias
    bool position_uncertain =
        false;  ///< an event increased the position's standard deviation by more than kEventSigmaGrowth_m
    bool started_in_motion = false;
    std::int64_t gaps = 0;  ///< number of bridged gaps between samples
    // The errors of all contact-mode hypotheses are linearised about the nominal trajectory and calibration.
    RollingNominalState nominal;
    RollingNodeIntegrals node_integrals;
    Eigen::Matrix3d pruned_position_covariance_m2 =
        Eigen::Matrix3d::Zero();  ///< contribution of the pruned hypotheses to the position covariance
    RestDetector::State stationary_state;
    Eigen::Vector3d low_passed_rate_rad_s = Eigen::Vector3d::Zero();
    bool reported_position_constant = false;  ///< the sphere is at rest and the reported position is constant
    double variance_before_slip_m2 = 0.0;     ///< horizontal position variance at the last time step without an event
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    std::array<Hypothesis, kHypotheses> hypotheses{};
    int hypothesis_count = 0;
    std::int64_t step_count = 0;
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit RollingFilter(const Params& params);

  /// Processes one sample. The specific force of the first sample determines the initial tilt; the initial yaw is 0.
  /// The sphere's centre starts at the origin. The initial velocity is zero, or the velocity of rolling without slip if
  /// the first angular velocity is large. The sphere should be at rest for one second after the first sample. On error,
  /// the state is unchanged. Cost: about 40 * kHypotheses * kStates^2 floating-point operations per time step of 20 ms;
  /// no memory allocation.
  Status step(const ImuSample& sample, State& state) const {
    return step(sample, state, [](const State&) {});
  }

  /// Processes one sample, and calls `closed(state)` after each completed time step of 20 ms.
  template <typename Closed>
  Status step(const ImuSample& sample, State& state, Closed closed) const {
    return step_with_listener(sample, state,
                              Listener{&closed, [](void* to, const State& at) { (*static_cast<Closed*>(to))(at); }});
  }

  /// Returns the pose at the last sample. The covariance contains only the position; all other entries are zero.
  static RollingEstimate estimate(const State& state);

  static RollingCalibration calibration(const State& state);

 private:
  struct Listener {
    void* target;
    void (*function)(void*, const State&);
  };

  Status step_with_listener(const ImuSample& sample, State& state, Listener listener) const;

  void start(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const;
  void bridge_gap(const ImuSample& sample, double gap_s, State& state, Listener listener) const;
  void process_reading(const ImuSample& sample, double dt_s, State& state, Listener listener) const;
  void complete_filter_node(const Eigen::Vector3d& next_rate_rad_s, State& state) const;
  void detect_rest(State& state) const;
  bool spins_in_place(const State& state) const;
  void correct_at_rest(State& state) const;
  void choose_modes(const Eigen::Vector3d& rate_I_rad_s, bool heading_lost, State& state) const;
  void move_linearisation_point(bool heading_lost, State& state) const;
  void update_reported_pose(State& state) const;
  void flag_uncertain_position(State& state) const;
  void keep_position_at_rest(State& state) const;
  static ContactMode most_probable_mode(const State& state);
  static Eigen::Matrix3d hypothesis_position_covariance(const State& state, int first);
  static void weigh_modes(State& state);
  static void keep_most_probable_hypotheses(std::size_t count, State& state);

  Params params_;
  RestDetector rest_detector_;
};

}  // namespace tumble
