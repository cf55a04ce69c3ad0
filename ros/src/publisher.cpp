// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/publisher.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tumble/common/types.hpp"

namespace tumble::ros {

Odometry base_odometry(const PoseState& imu, const Eigen::Matrix3d& velocity_covariance_I_m2_s2,
                       const AngularRateState& rate, const Eigen::Isometry3d& T_IB) {
  const PoseState base = imu.transformed_to(T_IB, rate.w_WI_I_rad_s);
  Odometry out;
  out.stamp_ns = base.time_ns;
  out.T_OB = Eigen::Translation3d(base.position_W_m) * base.orientation_W;
  out.pose_covariance = base.covariance;
  const Eigen::Matrix3d R_BI = T_IB.linear().transpose();
  out.twist_B.head<3>() = base.orientation_W.conjugate() * base.velocity_W_m_s;
  out.twist_B.tail<3>() = R_BI * rate.w_WI_I_rad_s;
  const Eigen::Matrix3d by_rate = R_BI * -so3::hat(T_IB.translation()), rate_covariance = rate.covariance_rad2_s2;
  out.twist_covariance.topLeftCorner<3, 3>() =
      R_BI * velocity_covariance_I_m2_s2 * R_BI.transpose() + by_rate * rate_covariance * by_rate.transpose();
  out.twist_covariance.topRightCorner<3, 3>() = by_rate * rate_covariance * R_BI.transpose();
  out.twist_covariance.bottomLeftCorner<3, 3>() = out.twist_covariance.topRightCorner<3, 3>().transpose();
  out.twist_covariance.bottomRightCorner<3, 3>() = R_BI * rate_covariance * R_BI.transpose();
  return out;
}

namespace {

/// Segment is the motion from one pose of a trajectory to the next, also extrapolated to times before the first pose.
struct Segment {
  TimeNs from_ns;
  double length_s;
  Eigen::Quaterniond q_WI;
  Eigen::Vector3d p_WI_m, turn_rad, step_m;

  Eigen::Isometry3d at(double since_s) const {
    const double share = length_s > 0.0 ? since_s / length_s : 0.0;
    return Eigen::Translation3d(p_WI_m + share * step_m) * (q_WI * so3::exp(share * turn_rad));
  }
};

std::vector<Segment> segments_of(const std::vector<PoseState>& trajectory) {
  std::vector<Segment> out;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    const PoseState &a = trajectory[i], &b = trajectory[i + 1];
    out.push_back({a.time_ns, seconds(b.time_ns - a.time_ns), a.orientation_W, a.position_W_m,
                   so3::logarithm(a.orientation_W.conjugate() * b.orientation_W), b.position_W_m - a.position_W_m});
  }
  if (out.empty()) {
    const PoseState& only = trajectory.front();
    out.push_back(
        {only.time_ns, 1.0, only.orientation_W, only.position_W_m, Eigen::Vector3d::Zero(), only.velocity_W_m_s});
  }
  return out;
}

}  // namespace

void deskew(const std::vector<PoseState>& trajectory, const Eigen::Isometry3d& T_IL, TimeNs start_ns,
            const std::vector<LidarPoint>& points, std::vector<DeskewedPoint>& deskewed) {
  deskewed.clear();
  if (trajectory.empty()) return;
  const std::vector<Segment> segments = segments_of(trajectory);
  const PoseState& end = trajectory.back();
  const Eigen::Isometry3d T_LW_end = ((Eigen::Translation3d(end.position_W_m) * end.orientation_W) * T_IL).inverse();
  std::size_t k = 0;
  deskewed.reserve(points.size());
  for (const LidarPoint& point : points) {
    const TimeNs at_ns = start_ns + point.offset_ns;
    while (k > 0 && at_ns < segments[k].from_ns) --k;
    while (k + 1 < segments.size() && at_ns >= segments[k + 1].from_ns) ++k;
    const Eigen::Isometry3d T_LL = T_LW_end * segments[k].at(seconds(at_ns - segments[k].from_ns)) * T_IL;
    deskewed.push_back({(T_LL * point.position_L_m.cast<double>()).cast<float>(), point.intensity});
  }
}

}  // namespace tumble::ros
