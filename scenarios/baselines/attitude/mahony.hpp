// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// Mahony estimates attitude by the explicit complementary filter on SO(3) from gyro and accelerometer (Mahony, Hamel,
/// Pflimlin, IEEE TAC 53(5), 2008, eq 32). The corrected rate is w + kp e + integral of ki e. The tilt error is e =
/// f/|f| x R^T z in sensor axes. The integral estimates the gyro bias, but also follows lasting accelerations. The
/// filter does not estimate the heading.
class Mahony {
 public:
  struct Params {
    double proportional_rad_s = 0.2;  ///< kp
    double integral_rad_s2 = 0.001;   ///< ki
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.proportional_rad_s, {"proportional_rad_s", "rad/s", 0.0, 100.0,
                                   "proportional gain kp on the tilt error (eq. 32)", FieldRank::basic});
      visit(p.integral_rad_s2, {"integral_rad_s2", "rad/s^2", 0.0, 100.0,
                                "integral gain ki, which estimates the gyro bias (eq. 32)", FieldRank::basic});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };
  struct State {
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    Eigen::Vector3d integral_rad_s = Eigen::Vector3d::Zero();  ///< integral of ki e: minus the gyro bias
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit Mahony(const Params& params);

  /// Updates attitude and gyro bias with one IMU sample. The first sample sets roll and pitch from gravity and yaw to
  /// 0; later samples integrate the gyro and correct the tilt. For a specific force below 1e-6 m/s^2, the filter only
  /// applies the gyro and the integral. On error, `state` keeps its content. The cost is O(1), without allocation.
  Status step(const ImuSample& sample, State& state) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
