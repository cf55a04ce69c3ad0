// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// Eskf estimates attitude by an error-state Kalman filter with six states: attitude error (world axes) and gyro bias.
/// The specific force measures the vertical. The filter follows Sola (arXiv 1711.02508, sections 5-7), but expresses
/// the attitude error in world axes.
///
/// The filter models body acceleration as zero-mean white noise of the specific force. The filter neither normalises
/// the specific force nor weights it by its norm, because both would bias the mean. Normalising increased the attitude
/// error during fast translations from 0.8 deg to 12 deg. Real accelerations are not white, and the estimated bias of
/// the vertical gyro axis drifts at rest.
class Eskf {
 public:
  using Covariance = Eigen::Matrix<double, 6, 6>;

  struct Params {
    double gravity_m_s2 = 9.80665;
    double gyro_noise_rad_sqrts = 1e-3;         ///< angle random walk per sqrt(s)
    double bias_walk_rad_s_sqrts = 3e-5;        ///< random walk of the gyro bias per sqrt(s)
    double bias_sigma_start_rad_s = 8.7266e-3;  ///< 0.5 deg/s
    double tilt_sigma_start_rad = 0.02;
    double acceleration_noise_m_s2_sqrts = 0.5;  ///< noise density: standard deviation of the mean over 1 s
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
      visit(p.gyro_noise_rad_sqrts,
            {"gyro_noise_rad_sqrts", "rad/sqrt(s)", 1e-12, 1.0, "angle random walk", FieldRank::basic});
      visit(p.bias_walk_rad_s_sqrts,
            {"bias_walk_rad_s_sqrts", "rad/s/sqrt(s)", 0.0, 1.0, "random walk of the gyro bias", FieldRank::basic});
      visit(p.bias_sigma_start_rad_s, {"bias_sigma_start_rad_s", "rad/s", 0.0, 1.0,
                                       "prior standard deviation of the gyro bias", FieldRank::basic});
      visit(p.tilt_sigma_start_rad, {"tilt_sigma_start_rad", "rad", 1e-12, 3.141592653589793,
                                     "standard deviation of the tilt from the first sample", FieldRank::basic});
      visit(p.acceleration_noise_m_s2_sqrts,
            {"acceleration_noise_m_s2_sqrts", "m/s^2 sqrt(s)", 1e-12, 100.0,
             "standard deviation of the mean acceleration of the body over 1 s (white noise)", FieldRank::basic});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
    Covariance covariance = Covariance::Zero();  ///< of (phi, bias) with q_true = Exp(phi) q_WI; rad, rad/s
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Eskf(const Params& params);

  /// Updates attitude and gyro bias with one IMU sample. The first sample sets roll and pitch from gravity and yaw to
  /// 0; later samples predict and correct. For a specific force below 1e-6 m/s^2, the filter only predicts. On error,
  /// `state` keeps its content. The cost is O(1), without allocation.
  Status step(const ImuSample& sample, State& state) const;

 private:
  void start(State& state) const;
  void predict(const Eigen::Vector3d& rate_rad_s, double dt_s, State& state) const;
  void correct(const Eigen::Vector3d& f_I_m_s2, double dt_s, State& state) const;

  Params params_;
};

}  // namespace tumble::baselines
