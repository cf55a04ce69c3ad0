// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

/// Samples of the primary IMU after subtraction of the gyro bias.
struct SphereAttitude {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;  ///< parallel to `samples`; yaw starts at 0
};

struct RestParams {
  double rest_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rest_s, {"rest_s", "s", 0.01, 60.0,
                     "duration of the initial rest; the mean readings during this rest give gyro bias and tilt",
                     ParameterRank::common_use});
  }
};
const Settings<RestParams>& rest_settings();

/// Gyro bias and tilt come from the first `rest_s` seconds at rest; later attitudes come from integrating the gyro.
Status sphere_attitude(const char* method, const sim::Sensors& sensors, double rest_s, SphereAttitude& out);

PoseState centre_pose(const sim::Sensors& sensors, TimeNs time_ns, const Eigen::Quaterniond& q_WI,
                      const Eigen::Vector3d& p_WG_m, const Eigen::Vector3d& v_WG_m_s);

/// A moving contact point is `slide` if the centre of the sphere moves faster than the sphere rolls, and `slip` if the
/// sphere rotates faster.
sim::ContactLabel slip_or_slide(double radius_m, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_WI_I_rad_s,
                                const Eigen::Vector3d& v_WG_m_s);

void require_sphere(const char* method, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
