// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::scenarios {

namespace {

// the library's own defaults, so that each stands in one place
const std::array<sim::Parameter, 8>& parameters_of_the_chain() {
  static const LidarInertialOdometry::Params library;
  static const std::array<sim::Parameter, 8> parameters = {{
      {"sweep_voxel_m", library.sweep_voxel_m, 0.01, 10.0, "m", "one point per voxel of a sweep is registered"},
      {"map_voxel_m", library.map_voxel_m, 0.05, 10.0, "m", "cell of the map's hash"},
      {"map_spacing_m", library.map_spacing_m, 0.0, 1.0, "m", "edge of the cube that holds one map point"},
      {"neighbours", static_cast<double>(library.neighbours), 3.0, 32.0, "1", "map points per plane fit"},
      {"match_distance_m", library.match_distance_m, 0.01, 10.0, "m", "farther map points are no match"},
      {"prior_sigma_m", library.prior_sigma_m, 1e-4, 100.0, "m", "inertial prior over 0.1 s: position"},
      {"prior_sigma_rad", library.prior_sigma_rad, 1e-5, 10.0, "rad", "inertial prior over 0.1 s: attitude"},
      {"rest_s", library.rest_s, 0.01, 60.0, "s", "at most this much of the rest at the start levels the attitude"},
  }};
  return parameters;
}

const std::array<sim::Parameter, 2>& parameters_of_the_excess() {
  static const LidarInertialOdometry::Params library;
  static const std::array<sim::Parameter, 2> parameters = {{
      {"excess_sigma_min_rad_s", library.excess_sigma_min_rad_s, 1e-9, 100.0, "rad/s",
       "least prior of the excess rate of a clipped axis, whatever the rate method claims"},
      {"clipped_sigma_rad_s", library.clipped_sigma_rad_s, 0.0, 100.0, "rad/s",
       "assumed of a clipped axis that the rate method did not recover"},
  }};
  return parameters;
}

LidarInertialOdometry::Params odometry_params(const sim::Sensors& sensors, const sim::Values& parameters,
                                              ExcessRate excess) {
  LidarInertialOdometry::Params params;
  params.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.rest_s = parameters.at("rest_s");
  params.sweep_voxel_m = parameters.at("sweep_voxel_m");
  params.map_voxel_m = parameters.at("map_voxel_m");
  params.map_spacing_m = parameters.at("map_spacing_m");
  params.neighbours = static_cast<int>(std::lround(parameters.at("neighbours")));
  params.match_distance_m = parameters.at("match_distance_m");
  params.prior_sigma_m = parameters.at("prior_sigma_m");
  params.prior_sigma_rad = parameters.at("prior_sigma_rad");
  if (excess == ExcessRate::estimated) {
    params.estimate_excess_rate = true;
    params.excess_sigma_min_rad_s = parameters.at("excess_sigma_min_rad_s");
    params.clipped_sigma_rad_s = parameters.at("clipped_sigma_rad_s");
  }
  return params;
}

// sweeps share the IMU time at their border: the later sweep's pose of it is left out
void append_poses(const LidarInertialOdometry::SweepReport& report, std::vector<PoseState>& poses) {
  for (const PoseState& pose : report.trajectory) {
    if (poses.empty() || pose.time_ns > poses.back().time_ns) poses.push_back(pose);
  }
}

}  // namespace

std::span<const sim::Parameter> slam_parameters() {
  return parameters_of_the_chain();
}

std::span<const sim::Parameter> excess_parameters() {
  return parameters_of_the_excess();
}

void run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                    Estimate& estimate, ExcessRate excess) {
  estimate.frame = Frame::imu;
  count_sources(estimate.rates, estimate.health);
  if (sensors.lidars.empty()) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const std::size_t sweeps = bridge::sweep_count(lidar);
  if (sweeps == 0) {
    estimate.status = {Trouble::empty, "lidar.sweep_start_ns", 0.0, 1.0};
    return;
  }

  LidarInertialOdometry odometry(odometry_params(sensors, parameters, excess));
  std::size_t next = 0;
  for (std::size_t k = 0; k < sweeps; ++k) {
    const bridge::Sweep sweep = bridge::sweep(lidar, k);
    // the IMU up to the first sample at or after the sweep's end
    while (next < samples.size() && (next == 0 || samples[next - 1].time_ns < sweep.end_ns)) {
      estimate.status = odometry.add_imu(samples[next], estimate.rates[next]);
      if (!estimate.status.ok()) return;
      ++next;
    }
    if (samples.back().time_ns < sweep.end_ns) {
      estimate.health["sweeps_unfinished"] += 1.0;
      continue;
    }
    LidarInertialOdometry::SweepReport report;
    const Status status = odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, report);
    if (!status.ok() && report.trajectory.empty()) {
      // the IMU begins after the sweep: nothing to place it by
      if (status.trouble == Trouble::too_few) {
        estimate.health["sweeps_unfinished"] += 1.0;
        continue;
      }
      estimate.status = status;
      return;
    }
    // a covered lidar is a fact of life: the chain goes on by inertia
    if (!status.ok()) estimate.health[std::string("sweeps_") + to_string(status.trouble)] += 1.0;
    estimate.health[std::string("sweeps_") + to_string(report.verdict)] += 1.0;
    append_poses(report, estimate.poses);
    estimate.sweeps.push_back(std::move(report));
    estimate.sweep_end_ns.push_back(sweep.end_ns);
  }
  estimate.map = odometry.map();
  const bool any = std::any_of(estimate.sweeps.begin(), estimate.sweeps.end(),
                               [](const auto& sweep) { return sweep.verdict != SweepVerdict::rejected; });
  if (!any) {
    estimate.status = {Trouble::too_few, "lidar.sweeps_registered", 0.0, 1.0};
  }
}

}  // namespace tumble::scenarios
