// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/common/imu.hpp"

/// sphere_attitude.hpp computes the attitude for position methods of the sphere that do not estimate it.
namespace tumble::scenarios {

/// SphereAttitude contains the samples of the primary IMU without gyro bias, and the attitude at the end of each
/// averaging window.
struct SphereAttitude {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;  ///< parallel to `samples`; yaw starts at 0
};

/// RestParams contains the time for which a method assumes that the sphere is stationary at the start.
struct RestParams {
  double rest_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rest_s, {"rest_s", "s", 0.01, 60.0,
                     "duration of the initial rest; the mean readings during this rest give gyro bias and tilt",
                     FieldRank::basic});
  }
};
const Settings<RestParams>& rest_settings();

/// Estimates gyro bias and tilt from the first `rest_s` seconds, then integrates the gyro to one attitude per sample.
/// Returns an error of the samples or of the initial attitude. Throws BadInput, with the name `method`, if the
/// recording is not from a sphere. The cost is O(N).
Status sphere_attitude(const char* method, const sim::Sensors& sensors, double rest_s, SphereAttitude& out);

/// Returns the pose of the body axes at the sphere's centre, from the attitude of the IMU.
PoseState centre_pose(const sim::Sensors& sensors, TimeNs time_ns, const Eigen::Quaterniond& q_WI,
                      const Eigen::Vector3d& p_WG_m, const Eigen::Vector3d& v_WG_m_s);

/// Classifies a moving contact point: `slide` if the centre moves faster than the sphere rolls, `slip` if the sphere
/// rotates faster.
sim::ContactLabel slip_or_slide(double radius_m, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_WI_I_rad_s,
                                const Eigen::Vector3d& v_WG_m_s);

/// Throws BadInput, with the name `method`, if the sensors do not belong to a sphere.
void require_sphere(const char* method, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
