// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Second-order Butterworth low-pass filter (bilinear transform, corner frequency sqrt(2) / (2 pi tau)). Until the time
/// tau has passed, the output is the mean of all inputs.
template <int Rows>
struct LowPass {
  using Vector = Eigen::Matrix<double, Rows, 1>;

  Vector value = Vector::Zero();
  Vector normalised_derivative = Vector::Zero();  ///< derivative divided by the angular corner frequency
  Vector input = Vector::Zero();
  double averaged_duration_s = 0.0;
  double samples = 0.0;

  /// `dt_s` is the time since the previous input, and `warp` is the result of low_pass_prewarp().
  void advance(const Vector& next, double tau_s, double dt_s, double warp) {
    if (averaged_duration_s < tau_s) {
      samples += 1.0;
      averaged_duration_s += dt_s;
      value += (next - value) / samples;
    } else {
      const double damping = std::numbers::sqrt2 * warp;
      const Vector rise =
          ((1.0 - damping - warp * warp) * normalised_derivative + warp * (input + next - 2.0 * value)) /
          (1.0 + damping + warp * warp);
      value += warp * (normalised_derivative + rise);
      normalised_derivative = rise;
    }
    input = next;
  }

  bool operator==(const LowPass&) const = default;
};

/// Returns tan(pi * corner frequency * dt), bounded for sample periods much longer than tau.
inline double low_pass_prewarp(double tau_s, double dt_s) {
  return std::tan(std::min(dt_s / (std::numbers::sqrt2 * tau_s), 1.5));
}

/// Parameters of Vqf, named as in the publication. Parameters for which the authors use one value for all IMUs are
/// constants in the source.
struct VqfParams {
  double tau_s = 3.0;  ///< time constant of the low-pass filter on the specific force
  bool rest_bias_estimation = true;
  bool motion_bias_estimation = true;  ///< if both bias estimations are off, Vqf is the authors' basic filter
  double gap_max_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.tau_s,
          {"tau_s", "s", 1e-3, 1e4, "time constant of the low-pass filter on the specific force in the inertial frame",
           ParameterAudience::common_use});
    visit(p.rest_bias_estimation, boolean_parameter("rest_bias_estimation", "1: estimate the gyro bias at rest",
                                                    ParameterAudience::common_use));
    visit(p.motion_bias_estimation,
          boolean_parameter("motion_bias_estimation", "1: also estimate the gyro bias in motion",
                            ParameterAudience::common_use));
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
  }
};

/// Estimates attitude from gyro and accelerometer with the versatile quaternion filter (VQF). Source: Laidig and Seel,
/// "VQF", Information Fusion 91, 2023.
///
/// Gyro integration gives the attitude relative to a nearly inertial frame N. The low-pass filtered specific force in
/// frame N gives the vertical. A Kalman filter estimates the gyro bias, at rest and in motion. Vqf estimates neither
/// the heading nor, in motion, the bias about the vertical.
class Vqf {
 public:
  using Params = VqfParams;
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();  ///< q_WN * q_NI
    Eigen::Quaterniond attitude_without_correction =
        Eigen::Quaterniond::Identity();  ///< attitude from the gyro only, with the bias subtracted
    Eigen::Quaterniond inclination_correction = Eigen::Quaterniond::Identity();
    Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
    Eigen::Matrix3d bias_covariance_rad2_s2 = Eigen::Matrix3d::Zero();
    LowPass<3> filtered_specific_force_m_s2;
    LowPass<9> R_WI;          ///< rotation matrix by columns, low-passed like the specific force
    LowPass<2> bias_W_rad_s;  ///< horizontal bias in world axes, low-passed like the specific force
    LowPass<3> rest_rate_rad_s;
    LowPass<3> rest_force_m_s2;
    double rest_s = 0.0;
    bool at_rest = false;
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Vqf(const Params& params);

  /// Processes one sample. The specific force of the first sample determines the initial tilt; the initial yaw is 0. If
  /// the specific force is below 1e-6 m/s^2, step() integrates the gyro without a correction. On error, the state is
  /// unchanged. Cost: O(1), no allocation.
  Status step(const ImuSample& sample, State& state) const;

 private:
  void detect_rest(const ImuSample& sample, double dt_s, State& state) const;
  Eigen::Vector3d level_inertial_frame(const Eigen::Vector3d& f_I_m_s2, double dt_s, State& state) const;
  void estimate_bias(const Eigen::Vector3d& up_W, double dt_s, State& state) const;

  Params params_;
};

}  // namespace tumble
