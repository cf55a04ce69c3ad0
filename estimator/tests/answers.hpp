// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/tumble.hpp"

/// answers() returns all numbers that an odometry object reports now and after finish(), for bitwise comparisons of two
/// objects. Waiting sweeps, poses and readings therefore count.
namespace tumble::test {

class Answers {
 public:
  template <class Matrix>
  void add(const Matrix& matrix) {
    for (const auto number : matrix.reshaped()) numbers.push_back(static_cast<double>(number));
  }
  void add(double number) { numbers.push_back(number); }
  void add(const PoseState& pose) {
    add(static_cast<double>(pose.time_ns));
    add(pose.position_W_m);
    add(pose.orientation_W.coeffs());
    add(pose.velocity_W_m_s);
    add(pose.covariance);
  }
  void add(const SensorHealth& health) {
    for (const HealthFinding& finding : health.findings) {
      add(static_cast<double>(finding.kind));
      add(finding.value);
    }
  }
  void add(const SaturationLevels& rails) {
    for (const SaturationLimitDetector::Channel& channel : rails.axis_limit_state.channels) add(channel.plateau_limit);
    for (const SaturationPlanes* planes : {&rails.gyro_planes, &rails.accel_saturation_planes}) {
      for (const std::optional<SaturationPlane>& plane : planes->sensing_axis)
        add(plane ? plane->saturation_limit_rad_s : 0.0);
    }
  }

  std::vector<double> numbers;
};

inline std::vector<double> answers(TumblingOdometry odometry) {
  Answers out;
  PoseState pose;
  if (odometry.newest(pose).ok()) out.add(pose);
  for (const std::optional<AngularRateState>& rate : {odometry.newest_rate(), odometry.newest_smoothed_rate()}) {
    if (!rate) continue;
    out.add(rate->w_WI_I_rad_s);
    out.add(rate->covariance_rad2_s2);
  }
  out.add(odometry.body_imu_calibration().constants.vector());
  out.add(odometry.body_imu_calibration().covariance);
  out.add(odometry.saturation_levels());
  out.add(odometry.health());
  out.add(odometry.estimated_jitter_s().value_or(0.0));
  odometry.finish();
  while (const std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) {
    out.add(sweep->result.pose);
    out.add(static_cast<double>(sweep->result.verdict));
    for (const PoseState& each : sweep->result.trajectory) out.add(each);
  }
  for (const MapPoint& point : odometry.mapper().map()) out.add(point.position_W_m);
  out.add(odometry.mapper().lidar_calibration().T_IL.matrix());
  out.add(odometry.mapper().lidar_calibration().gravity_W_m_s2);
  out.add(odometry.mapper().lidar_calibration_covariance());
  for (const std::size_t count :
       {odometry.restart_count(), odometry.rejected_readings(), odometry.samples_rejected_by_mapper(),
        odometry.dropped_untaken_sweeps(), odometry.sweeps_before_first_imu()})
    out.add(static_cast<double>(count));
  return out.numbers;
}

inline std::vector<double> answers(RollingOdometry odometry) {
  Answers out;
  const auto add = [&](const RollingOdometry::Pose& pose) {
    out.add(pose.pose);
    out.add(pose.angular_velocity_B_rad_s);
    out.add(pose.velocity_covariance_B_m2_s2);
    out.add(static_cast<double>(pose.contact_mode));
  };
  if (const std::optional<RollingOdometry::Pose> pose = odometry.newest()) add(*pose);
  out.add(odometry.sphere_calibration().sphere_centre_B_m);
  out.add(odometry.sphere_calibration().radius_m);
  out.add(odometry.health());
  for (const MergedImuState& unit : odometry.imu_merge_state().imus) out.add(unit.x);
  odometry.finish();
  while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) add(*pose);
  out.add(static_cast<double>(odometry.restart_count()));
  out.add(static_cast<double>(odometry.rejected_readings()));
  return out.numbers;
}

}  // namespace tumble::test
