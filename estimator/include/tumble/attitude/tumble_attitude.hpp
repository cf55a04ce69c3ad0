// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/attitude/low_pass.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/imu_average.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Attitude from gyro and accelerometer by what a body cannot do: its velocity is bounded, and at rest it is zero.
///
/// The gyro is integrated exactly and the force turned into W is integrated to a horizontal velocity and displacement
/// (leaky). A tilt error would make these grow without end, so "velocity about zero, displacement about zero", believed
/// weakly, tells tilt and gyro bias apart from every acceleration that is made good again. A Kalman filter of nine
/// states (tilt, bias, velocity, displacement) does this every `node_s`: the low-pass in an inertial frame of VQF, but
/// with the corner that the sensor's errors ask for at each time. At rest the velocity and the rate are zero to within
/// noise: the bias is measured and the attitude held, so that noise moves neither tilt nor heading.
///
/// A rolling sphere (radius_m > 0) tells more: its velocity is r w x n, and that of the IMU w x (R rho) more, so the
/// specific force is explained by rolling but for tilt and bias, without a derivative of the rate. A velocity that
/// does not fit opens a slip: corrections are frozen until it fits again, for slip_timeout_s at the most.
///
/// Readings count by their time: those of a fast IMU are averaged to reading_s before anything is decided by them, and
/// the attitude between two averages is the last one, turned on.
///
/// Not modelled: accelerometer bias and scale (they are the tilt error that is left at rest), heading reference.
class TumbleAttitude {
 public:
  static constexpr int kStates = 9;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct Params {
    double gravity_m_s2 = 9.80665;       ///< bound (0, 100]
    double gyro_noise_rad_sqrts = 1e-3;  ///< angle random walk per sqrt(s), unmodelled errors included; (0, 1]
    double rate_error_sqrts = 4e-3;      ///< angle random walk per sqrt(s) and rad/s turned: scale, timing; [0, 1]
    double bias_sigma_start_rad_s = 8.7266e-3;   ///< 0.5 deg/s; bound [0, 1]
    double bias_walk_rad_s_sqrts = 2e-6;         ///< per sqrt(s); bound [0, 1]
    double acceleration_noise_m_s_sqrts = 0.01;  ///< velocity random walk; bound (0, 100]
    double velocity_m_sqrts = 1.0;               ///< sigma of the mean velocity over 1 s of motion; bound (0, 1e3]
    double displacement_m_sqrts = 0.3;           ///< sigma of the mean displacement over 1 s; bound (0, 1e3]
    double displacement_tau_s = 10.0;            ///< in which a displacement is forgotten; bound [0.1, 1e4]
    double node_s = 0.04;                        ///< time between two corrections; bound [1e-4, 1]
    /// Readings are averaged to this length, at which all thresholds here are meant; zero: taken as they come; [0,
    /// 0.1].
    double reading_s = 4e-3;
    double rest_tau_s = 0.5;             ///< of the low-passes that detect rest; bound [1e-3, 1e4]
    double rest_time_s = 1.0;            ///< quiet for so long is rest; bound [0, 1e4]
    double rest_rate_rad_s = 3.4907e-2;  ///< 2 deg/s: quiet about the low-passed rate, and it about the bias; (0, 1]
    double rest_force_m_s2 = 0.5;        ///< quiet about the low-passed force; bound (0, 100]
    double rest_velocity_sigma_m_s = 0.005;   ///< per node at rest; bound (0, 10]
    double rest_rate_sigma_rad_sqrts = 2e-3;  ///< of the rate measured at rest, mean over 1 s; bound (0, 1]
    double radius_m = 0.0;                    ///< of a rolling sphere on a level floor; 0: no such thing; bound [0, 10]
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< centre to IMU, sensor axes; length up to 10
    double rolling_velocity_sigma_m_s = 0.03;               ///< per node while it grips; bound (0, 10]
    double slip_velocity_m_s = 0.12;  ///< misfit that opens a slip, half of it closes it; bound (0, 10]
    double slip_quiet_s = 0.2;        ///< and for so long; bound [0, 10]
    double slip_timeout_s = 3.0;      ///< then rolling is believed again; bound (0, 1e3]
    double gap_max_s = 1.0;           ///< bound (0, 1e4]
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector2d v_W_m_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d d_W_m = Eigen::Vector2d::Zero();
    /// Of (tilt error phi_x, phi_y in W with q_true = Exp(phi) q_WI; bias in I; velocity; displacement).
    Covariance covariance = Covariance::Zero();
    ImuAverage average;  ///< of the readings since the last one that was taken
    Eigen::Quaterniond q_taken_WI = Eigen::Quaterniond::Identity();  ///< and the attitude there
    // integrals since the last node
    Eigen::Matrix3d R_WI_s = Eigen::Matrix3d::Zero();
    Eigen::Vector3d f_W_m_s = Eigen::Vector3d::Zero();
    double turned_rad2_s = 0.0;
    double node_s = 0.0;
    // rest
    LowPass<3> rest_rate_rad_s;
    LowPass<3> rest_force_m_s2;
    double rest_s = 0.0;
    bool at_rest = false;
    // rolling
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< of the last sample, without bias
    double slip_s = 0.0, fits_s = 0.0;
    bool slipping = false;
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit TumbleAttitude(const Params& params);

  /// The first sample levels the attitude (yaw 0); each later one integrates, and one per `node_s` corrects.
  /// On trouble the state is unchanged. O(1), no allocation.
  Status step(const ImuSample& sample, State& state) const;

 private:
  void start(State& state) const;
  void take_average(State& state) const;
  void detect_rest(const ImuSample& sample, double dt_s, State& state) const;
  void integrate(const ImuSample& sample, double dt_s, State& state) const;
  void predict_node(State& state) const;
  void correct_node(State& state) const;
  bool watch_slip(const Eigen::Vector2d& misfit_m_s, State& state) const;

  Params params_;
};

}  // namespace tumble
