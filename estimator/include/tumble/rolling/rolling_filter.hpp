// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// How the sphere meets the floor.
enum class RollingMode : std::uint8_t {
  grip,  ///< the contact point stands still
  slip,  ///< it moves along the floor: spinning too fast or sliding
  bump,  ///< it also rises or falls: an obstacle, or the air
};

/// Pose of a rolling sphere from one IMU, through slip, slide and bumps, on a level floor.
///
/// While the sphere grips, rolling is a velocity measurement; it calibrates tilt, biases, scale, misalignment, delay
/// and lever arm of the IMU, so that the seconds without grip can be integrated. Whether it grips is inferred: a Kalman
/// filter of the errors per hypothesis about the past modes, kept until what follows decides. The position is part of
/// each filter's state, so that the grip after an event mends the way made in it; the newest estimate is as good as a
/// smoother of the whole run would make it, the older ones are not revised.
///
/// Events of up to a second are resolved; one of two seconds in which the contact velocity seems to pass zero may be
/// taken for grip in its middle, and the covariance does not always show it. State and stack need 360 KiB each.
///
/// Not modelled: slopes (a tilted floor reads as a contact velocity), a wrong radius, a clipped gyro. Heading drifts.
class RollingFilter {
 public:
  static constexpr int kStates = 37;
  static constexpr int kHypotheses = 32;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;
  using Rows39 = Eigen::Matrix<double, 3, 9>;

  struct Params {
    double radius_m = 0.145;                                ///< bound (0, 10]
    double gravity_m_s2 = 9.80665;                          ///< bound (0, 100]
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from centre to IMU, sensor axes; length up to 10
    double node_s = 0.02;                                   ///< time between two measurements; bound [1e-3, 0.1]
    // Prior sigmas; bounds [0, 1e3].
    double tilt_sigma_rad = 6e-3;
    double velocity_sigma_m_s = 2e-3;
    double gyro_bias_sigma_rad_s = 8.7e-4;  ///< 0.05 deg/s
    double accel_bias_sigma_m_s2 = 0.04;
    double accel_scale_sigma = 3.5e-3;  ///< each entry of scale and misalignment
    double gyro_scale_sigma = 2.5e-3;
    double accel_delay_sigma_s = 3e-3;  ///< accelerometer later than gyro
    double lever_arm_sigma_m = 2e-3;
    // Noise; bounds (0, 1e3].
    double attitude_walk_rad_sqrts = 1e-4;  ///< 0.006 deg/sqrt(s)
    double rate_error_sqrts = 6e-4;         ///< per rad/s turned
    double velocity_walk_m_s_sqrts = 6e-3;
    double gyro_bias_walk_rad_s_sqrts = 1.7e-5;
    double accel_bias_walk_m_s2_sqrts = 2e-3;
    double grip_sigma_m_s = 3e-3;      ///< of the contact velocity while gripping
    double grip_sigma_share = 1.5e-3;  ///< more, as a share of the rolling speed
    double vertical_sigma_m_s = 8e-3;
    double rest_velocity_sigma_m_s = 2e-3;
    double rest_rate_sigma_rad_s = 3e-3;  ///< of a node's mean rate at rest
    // Change of mode, per second; bounds (0, 1e3].
    double slip_begins_per_s = 0.5, slip_ends_per_s = 2.0;
    double bump_begins_per_s = 0.3, bump_ends_per_s = 5.0;
    double slip_bump_per_s = 0.2;    ///< slip to bump and back
    double event_shortest_s = 0.06;  ///< least stay in slip or bump; bound [0, 10]
    // Rest.
    double rest_rate_rad_s = 0.02;  ///< bound (0, 10]
    double rest_force_m_s2 = 0.15;  ///< of a node's mean about its slow mean; bound (0, 100]
    double rest_time_s = 0.4;       ///< quiet for so long; bound [0, 100]
    double gap_max_s = 0.1;         ///< bound (0, 1]
  };

  /// One assumption about which modes there were, and what follows from it.
  struct Hypothesis {
    Vector x = Vector::Zero();  ///< errors: attitude (W), velocity and position of the IMU, constants
    Covariance P = Covariance::Zero();
    Eigen::Vector3d u_W_m_s = Eigen::Vector3d::Zero();  ///< contact velocity at the last node
    double log_weight = 0.0;                            ///< of its probability; the best one's is zero
    std::int64_t switched_node = 0;                     ///< since when it is in its mode
    RollingMode mode = RollingMode::grip;
    bool operator==(const Hypothesis&) const = default;
  };

  struct State {
    // The estimate at the last sample, by the best hypothesis.
    Eigen::Vector3d p_WG_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_WG_m_s = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    Eigen::Matrix3d position_covariance_m2 = Eigen::Matrix3d::Zero();  ///< at the last node, over all hypotheses
    RollingMode mode = RollingMode::grip;
    bool at_rest = false;
    // The common nominal trajectory and constants, about which the hypotheses hold their errors.
    Eigen::Quaterniond q_nominal = Eigen::Quaterniond::Identity();
    Eigen::Vector3d v_WI_m_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d p_WI_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
    Eigen::Matrix3d accel_scale = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d gyro_scale = Eigen::Matrix3d::Zero();
    double accel_delay_s = 0.0;
    Eigen::Vector3d lever_arm_error_m = Eigen::Vector3d::Zero();
    // Integrals since the last node: of R, R f, R (x) f^T, R (x) w^T, R (w x f), w, f, |w|^2.
    Eigen::Matrix3d R_s = Eigen::Matrix3d::Zero();
    Eigen::Vector3d f_W_m_s = Eigen::Vector3d::Zero();
    Rows39 R_f = Rows39::Zero(), R_w = Rows39::Zero();
    Eigen::Vector3d R_wxf = Eigen::Vector3d::Zero();
    Eigen::Vector3d w_I_rad = Eigen::Vector3d::Zero(), f_I_m_s = Eigen::Vector3d::Zero();
    double turned_rad2_s = 0.0;
    double node_s = 0.0;
    // Rest.
    Eigen::Vector3d slow_force_m_s2 = Eigen::Vector3d::Zero();
    double rest_s = 0.0;
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
  Status step(const ImuSample& sample, State& state) const;

 private:
  struct Contact;
  struct Candidate;

  void start(State& state) const;
  void integrate(const ImuSample& sample, double dt_s, State& state) const;
  void close_node(const Eigen::Vector3d& next_rate_rad_s, State& state) const;
  void predict(State& state) const;
  void detect_rest(State& state) const;
  void correct_at_rest(State& state) const;
  void choose_modes(const Eigen::Vector3d& rate_I_rad_s, State& state) const;
  Contact contact(const Eigen::Vector3d& rate_I_rad_s, const State& state) const;
  Candidate judge(int parent, RollingMode mode, const Contact& contact, const State& state) const;
  double log_transition(RollingMode from, RollingMode to, double h_s) const;
  void rebase(State& state) const;
  void report(State& state) const;

  Params params_;
};

}  // namespace tumble
