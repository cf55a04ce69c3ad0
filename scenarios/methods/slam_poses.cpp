// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"

/// The methods in slam_poses.cpp build maps of a rolling sphere from the poses of a position method, without
/// registration.
namespace tumble::scenarios {

namespace {

struct MapParams {
  VoxelMap::Params map;
  double nearest_m = 0.3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("map_", p.map);
    visit(p.nearest_m, {"nearest_m", "m", 0.0, 100.0,
                        "lidar returns nearer than this range belong to the sphere itself and are dropped"});
  }
};

const Settings<MapParams>& map_settings() {
  static const Settings<MapParams> all(MapParams{}, {.first = {"map_voxel_m", "map_spacing_m"}});
  return all;
}

template <Method (*kPosition)()>
const Method& position_method() {
  static const Method method = kPosition();
  return method;
}

class Track {
 public:
  Track(const std::vector<PoseState>& poses, const Eigen::Vector3d& centre_B_m)
      : poses_(poses), centre_B_m_(centre_B_m) {}
  bool covers(std::int64_t time_ns) const {
    return !poses_.empty() && time_ns >= poses_.front().time_ns && time_ns <= poses_.back().time_ns;
  }
  Eigen::Isometry3d at(std::int64_t time_ns) {
    while (next_ > 1 && poses_[next_ - 1].time_ns > time_ns) --next_;
    while (next_ + 1 < poses_.size() && poses_[next_].time_ns < time_ns) ++next_;
    const PoseState &a = poses_[next_ - 1], &b = poses_[next_];
    const double share = seconds(time_ns - a.time_ns) / std::max(seconds(b.time_ns - a.time_ns), 1e-9);
    const Eigen::Vector3d p = a.position_W_m + share * (b.position_W_m - a.position_W_m);
    return Eigen::Translation3d(p) * a.orientation_W.slerp(share, b.orientation_W) * Eigen::Translation3d(-centre_B_m_);
  }

 private:
  const std::vector<PoseState>& poses_;
  Eigen::Vector3d centre_B_m_;
  std::size_t next_ = 1;
};

// The lidar mounting refers to the centre of mass, whereas the estimated poses refer to the centre of the sphere, a few
// millimetres away.
Estimate map_from_poses(const Method& position, const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate = position.run(sensors, values_of(position, parameters), {});
  estimate.contacts.clear();
  estimate.uncertain.clear();
  if (!estimate.status.ok()) return estimate;
  if (sensors.lidars.empty() || estimate.poses.size() < 2) {
    estimate.status = {ErrorCode::empty, "lidars", 0.0, 1.0};
    return estimate;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const MapParams params = map_settings().read(parameters);
  VoxelMap map(params.map);
  Track track(estimate.poses, estimate.centre_B_m);
  std::size_t first_pose = 0;
  for (std::size_t k = 0; k < bridge::sweep_count(lidar); ++k) {
    const bridge::Sweep sweep = bridge::sweep(lidar, k);
    if (!track.covers(sweep.start_ns) || !track.covers(sweep.end_ns)) {
      leave_out_unfinished(estimate);
      continue;
    }
    LidarInertialOdometry::SweepResult report;
    report.verdict = estimate.sweeps.empty() ? SweepVerdict::first : SweepVerdict::registered;
    for (const LidarPoint& point : sweep.points) {
      if (!point.position_L_m.allFinite() || point.position_L_m.norm() < params.nearest_m) continue;
      const Eigen::Isometry3d T_WL = track.at(sweep.start_ns + point.offset_ns) * lidar.T_BL;
      report.map_points_added +=
          map.insert((T_WL * point.position_L_m.cast<double>()).cast<float>(), 0.0f, static_cast<std::uint32_t>(k));
      ++report.usable_points;
    }
    while (first_pose < estimate.poses.size() && estimate.poses[first_pose].time_ns < sweep.start_ns) ++first_pose;
    for (std::size_t j = first_pose; j < estimate.poses.size() && estimate.poses[j].time_ns <= sweep.end_ns; ++j) {
      report.trajectory.push_back(estimate.poses[j]);
    }
    report.pose = report.trajectory.empty() ? estimate.poses[first_pose] : report.trajectory.back();
    estimate.sweeps.push_back(std::move(report));
    estimate.sweep_end_ns.push_back(sweep.end_ns);
  }
  for (std::uint32_t index = 0; index < map.index_end(); ++index) {
    if (map.exists(index))
      estimate.map.push_back({map.position_W_m(index), Eigen::Vector3f::Zero(), map.sigma_m(index)});
  }
  return estimate;
}

template <Method (*kPosition)()>
Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return map_from_poses(position_method<kPosition>(), sensors, parameters);
}

template <Method (*kPosition)()>
Method posed(MethodInfo info) {
  info.kind = Kind::slam;
  info.settings = stages_after({&map_settings()}, position_method<kPosition>());
  info.robots = {"sphere"};
  return make_method(std::move(info), run<kPosition>);
}

}  // namespace

Method slam_poses_rolling() {
  return posed<position_rolling>({.name = "poses_rolling",
                                  .doc = "Builds the map with the poses of position/rolling, without registration.",
                                  .source = "textbook rolling constraint"});
}

Method slam_poses_autogain_fusion() {
  return posed<position_autogain_fusion>(
      {.name = "poses_autogain_fusion",
       .doc = "Builds the map with the poses of position/autogain_fusion (MFI 2021 paper), without registration.",
       .source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021"});
}

Method slam_poses_tumble() {
  return posed<position_tumble>(
      {.name = "poses_tumble",
       .doc = "Builds the map with the poses of position/tumble (our method), without registration.",
       .ours = true});
}

}  // namespace tumble::scenarios
