// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_attitude.hpp"

#include <fmt/format.h>

#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "tumble/attitude/strapdown.hpp"

namespace tumble::scenarios {

namespace {

struct Rest {
  Eigen::Vector3d gyro_bias_rad_s;
  Eigen::Vector3d specific_force_m_s2;
};

Rest mean_over_rest(std::span<const ImuSample> samples, double rest_s) {
  Rest rest{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double count = 0.0;
  for (const ImuSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().time_ns) > rest_s) break;
    rest.gyro_bias_rad_s += sample.angular_velocity_rad_s;
    rest.specific_force_m_s2 += sample.specific_force_m_s2;
    count += 1.0;
  }
  rest.gyro_bias_rad_s /= count;
  rest.specific_force_m_s2 /= count;
  return rest;
}

}  // namespace

const Settings<RestParams>& rest_settings() {
  static const Settings<RestParams> all(RestParams{});
  return all;
}

void require_sphere(const char* method, const sim::Sensors& sensors) {
  if (!(sensors.sphere_radius_m > 0.0)) {
    throw BadInput(fmt::format(
        "the method {} needs a recording of a sphere, but this recording states sphere_radius_m = 0", method));
  }
}

Status sphere_attitude(const char* method, const sim::Sensors& sensors, double rest_s, SphereAttitude& out) {
  out = {};
  if (Status status = bridge::primary_imu_samples(sensors, out.samples); !status.ok()) return status;
  require_sphere(method, sensors);

  const Rest rest = mean_over_rest(out.samples, rest_s);
  const Strapdown strapdown{Strapdown::Params{}};
  Strapdown::State attitude;
  if (Status status = inclination_from_force(rest.specific_force_m_s2, attitude.q_WI); !status.ok()) return status;
  attitude.started = true;
  attitude.last_time_ns = out.samples.front().time_ns;
  out.q_WI.reserve(out.samples.size());
  for (ImuSample& sample : out.samples) {
    sample.angular_velocity_rad_s -= rest.gyro_bias_rad_s;
    if (!out.q_WI.empty()) {
      if (Status status = strapdown.step(sample, attitude); !status.ok()) return status;
    }
    out.q_WI.push_back(attitude.q_WI);
  }
  return {};
}

sim::ContactLabel slip_or_slide(double radius_m, const Eigen::Quaterniond& q_WI, const Eigen::Vector3d& w_WI_I_rad_s,
                                const Eigen::Vector3d& v_WG_m_s) {
  const Eigen::Vector3d rolling_m_s = radius_m * (q_WI * w_WI_I_rad_s).cross(Eigen::Vector3d::UnitZ());
  return rolling_m_s.norm() > v_WG_m_s.head<2>().norm() ? sim::ContactLabel::slip : sim::ContactLabel::slide;
}

PoseState centre_pose(const sim::Sensors& sensors, TimeNs time_ns, const Eigen::Quaterniond& q_WI,
                      const Eigen::Vector3d& p_WG_m, const Eigen::Vector3d& v_WG_m_s) {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.position_W_m = p_WG_m;
  pose.orientation_W = q_WI * Eigen::Quaterniond(sensors.imus.front().T_BI.linear().transpose());
  pose.velocity_W_m_s = v_WG_m_s;
  return pose;
}

}  // namespace tumble::scenarios
