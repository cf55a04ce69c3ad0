// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "sim/recording.hpp"
#include "tumble/common/imu.hpp"

/// The attitude that position methods of the sphere stand on when they bring none of their own.
namespace tumble::scenarios {

/// Samples of the primary IMU without the gyro's bias at rest, and the attitude at the end of each sample's window.
struct SphereAttitude {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_WI;  ///< parallel to `samples`, yaw 0 at the first
};

/// How long the rest at the start is.
struct RestParams {
  double rest_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rest_s,
          {"rest_s", "s", 0.01, 60.0, "length of the initial rest, whose means give gyro bias and tilt", Rank::first});
  }
};
const Settings<RestParams>& rest_settings();

/// Bias and tilt are means over the first `rest_s`, then the gyro is integrated. Trouble: that of the samples and of
/// the levelling. Throws BadInput, naming `method`, when the recording is not one of a sphere. O(N).
Status sphere_attitude(const char* method, const sim::Sensors& sensors, double rest_s, SphereAttitude& out);

/// The pose of the sphere's centre in body axes, from that of the IMU's axes.
PoseState centre_pose(const sim::Sensors& sensors, TimeNs time_ns, const Eigen::Quaterniond& q_WI,
                      const Eigen::Vector3d& p_WG_m, const Eigen::Vector3d& v_WG_m_s);

/// `slide` when the centre travels faster than the sphere turns, `slip` when it turns faster: the label of a contact
/// point that is known to move along the floor.
sim::ContactLabel slip_or_slide(double radius_m, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_WI_I_rad_s,
                                const Eigen::Vector3d& v_WG_m_s);

/// Throws BadInput, naming `method`, unless the sensors are those of a sphere.
void require_sphere(const char* method, const sim::Sensors& sensors);

}  // namespace tumble::scenarios
