// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// RollingOdometry computes the position of a rolling sphere's centre from the angular velocity, by the trapezoid rule.
/// On a plane with unit normal n, the centre of a sphere with radius r and angular velocity w has the velocity r w x n
/// (docs/maths/rolling.md, equation (R15)). The computed position is wrong during slip, sliding and changes of the
/// floor height.
class RollingOdometry {
 public:
  struct Params {
    double radius_m = 0.145;
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, from the contact to the centre
    double gap_max_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.radius_m, {"radius_m", "m", 1e-9, 10.0, "radius of the sphere"});
      visit(p.normal_W, {"normal_W", "1", -1.0, 1.0, "unit normal of the floor, from contact point to centre"});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    }
  };
  struct State {
    Eigen::Vector3d p_WG_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d v_WG_m_s = Eigen::Vector3d::Zero();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit RollingOdometry(const Params& params);

  /// `w_I_rad_s` is the mean angular rate over the IMU sample's averaging window, and `q_WI` is the attitude at the end
  /// of the window.
  Status step(TimeNs time_ns, const Eigen::Vector3d& w_I_rad_s, const Eigen::Quaterniond& q_WI, State& state) const;

 private:
  Params params_;
};

}  // namespace tumble::baselines
