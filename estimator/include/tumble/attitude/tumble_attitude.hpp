// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/attitude/detail/tumble_attitude_expert_params.hpp"
#include "tumble/attitude/detail/tumble_attitude_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Of TumbleAttitude: the gyro, and how far the body moves.
struct TumbleAttitudeParams {
  double gravity_m_s2 = 9.80665;
  double gyro_noise_rad_sqrts = 1e-3;         ///< angle random walk per sqrt(s), unmodelled errors included
  double rate_error_sqrts = 4e-3;             ///< angle random walk per sqrt(s) and rad/s turned: scale, timing
  double bias_sigma_start_rad_s = 8.7266e-3;  ///< 0.5 deg/s
  double velocity_m_sqrts = 1.0;              ///< sigma of the mean velocity over 1 s of motion
  double displacement_m_sqrts = 0.3;          ///< sigma of the mean displacement over 1 s
  double displacement_tau_s = 10.0;           ///< in which a displacement is forgotten
  double motion_tau_s = 3.0;                  ///< memory of a body's own velocity and displacement, and of their size
  double radius_m = 0.0;                      ///< of a rolling sphere on a level floor; 0: no such thing
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< centre to IMU, sensor axes; length up to 10

  using Expert = TumbleAttitudeExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.gyro_noise_rad_sqrts, {"gyro_noise_rad_sqrts", "rad/sqrt(s)", 1e-12, 1.0,
                                   "angle random walk, including unmodelled errors", Rank::first});
    visit(p.rate_error_sqrts, {"rate_error_sqrts", "sqrt(s)", 0.0, 1.0,
                               "angle random walk per rad/s of rate, from scale and timing errors", Rank::first});
    visit(p.bias_sigma_start_rad_s,
          {"bias_sigma_start_rad_s", "rad/s", 0.0, 1.0, "prior standard deviation of the gyro bias", Rank::first});
    visit(p.velocity_m_sqrts, {"velocity_m_sqrts", "m/sqrt(s)", 1e-12, 1e3,
                               "standard deviation of the mean velocity over 1 s of motion", Rank::first});
    visit(p.displacement_m_sqrts, {"displacement_m_sqrts", "m sqrt(s)", 1e-12, 1e3,
                                   "standard deviation of the mean displacement over 1 s", Rank::first});
    visit(p.displacement_tau_s, {"displacement_tau_s", "s", 0.1, 1e4,
                                 "time constant with which the displacement decays to zero", Rank::first});
    visit(p.motion_tau_s,
          {"motion_tau_s", "s", 1e-3, 1e4,
           "correlation time of the body's velocity and displacement, and averaging time of their magnitude",
           Rank::first});
    visit(p.radius_m, {"radius_m", "m", 0.0, 10.0, "radius of the sphere"});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
    visit.group("", p.expert);
  }
};

/// Attitude from gyro and accelerometer by what a body cannot do: its velocity is bounded, and at rest it is zero.
///
/// The gyro is integrated exactly and the force turned into W is integrated to a horizontal velocity and displacement
/// (leaky). A tilt error would make these grow without end, so "velocity about zero, displacement about zero", believed
/// weakly, tells tilt and gyro bias apart from every acceleration that is made good again. A Kalman filter of nine
/// states (tilt, bias, velocity, displacement) does this every `node_s`: the low-pass in an inertial frame of VQF, but
/// with the corner that the sensor's errors ask for at each time. At rest the velocity and the rate are zero to within
/// noise: the bias is measured and the attitude held, so that noise moves neither tilt nor heading.
///
/// How far a body moves is not known beforehand: a hand's breadth, or down a hill. A velocity or displacement that is
/// larger than was believed and that the present tilt's variance does not explain is the body's own, and widens the
/// belief for `motion_tau_s`.
///
/// A rolling sphere (radius_m > 0) tells more: its velocity is r w x n, and that of the IMU w x (R rho) more, so the
/// specific force is explained by rolling but for tilt and bias, without a derivative of the rate. A velocity that
/// does not fit opens a slip: corrections are frozen until it fits again, for slip_timeout_s at the most.
///
/// Readings count by their time: those of a fast IMU are averaged to reading_s before anything is decided by them, and
/// the attitude between two averages is the last one, turned on. Over a gap (a time longer than `gap_least_s`) the rate
/// goes from the last reading to the next in a straight line and the velocity goes on, with variances that say how
/// little that is; a body that rests before and after rested meanwhile. Where that leaves the tilt unknown to
/// gap_lost_tilt_rad, a coarse alignment looks for up beside the filter, which is not linear there, and until it has
/// found it the covariance is that of the gap; where the two disagree, the filter begins again from the alignment.
///
/// Not modelled: accelerometer bias and scale (they are the tilt error that is left at rest), heading reference.
class TumbleAttitude {
 public:
  using Params = TumbleAttitudeParams;
  using State = TumbleAttitudeState;

  explicit TumbleAttitude(const Params& params);

  /// The first sample levels the attitude (yaw 0); each later one integrates, and one per `node_s` corrects.
  /// On trouble the state is unchanged. O(1), no allocation.
  Status step(const ImuSample& sample, State& state) const { return step(sample, Eigen::Matrix3d::Zero(), state); }
  /// The same of a sample whose rate no gyro read (its rail hid it) but somebody recovered, with the covariance of its
  /// error, sensor axes; zero: read. The error has the memory `recovered_tau_s`. `out_of_range` for a
  /// covariance that is not finite or has a variance below zero.
  Status step(const ImuSample& sample, const Eigen::Matrix3d& rate_covariance_rad2_s2, State& state) const;

  /// Covariance of the attitude's error as AttitudeState has it, at the last node.
  static Eigen::Matrix3d attitude_covariance_rad2(const State& state);

 private:
  void start(State& state) const;
  void take_average(State& state) const;
  bool rotates_by_bias_alone(const State& state) const;
  void integrate(const ImuSample& sample, double dt_s, State& state) const;
  void bridge_gap(const ImuSample& after, const Eigen::Matrix3d& rate_covariance_rad2_s2, double gap_s,
                  State& state) const;
  void add_recovered(double dt_s, State& state) const;
  void end_node(State& state) const;
  void predict_node(State& state) const;
  void correct_node(State& state) const;
  void align(const Eigen::Quaterniond& corrected, State& state) const;
  void restart(const Eigen::Quaterniond& levelling, double tilt_rad2, double velocity_m2_s2, State& state) const;
  double own_velocity_m2_s2(double power_m2_s2, const State& state) const;
  Eigen::Vector2d velocity_of_rotation(const State& state) const;
  void correct_body(const Eigen::Vector2d& turned_m_s, State& state) const;
  double own_motion(const Eigen::Vector2d& misfit, int index, double sigma_sqrts, double power,
                    const State& state) const;
  bool watch_slip(const Eigen::Vector2d& misfit_m_s, State& state) const;

  Params params_;
  RestDetector rests_;
};

}  // namespace tumble
