// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/errors.hpp"

#include <fmt/format.h>

#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/trajectories/reference_check.hpp"

namespace tumble::scenarios {

namespace {

std::vector<std::int64_t> own_times(const ReferenceSource& source) {
  if (!source.times.empty()) return read_stamps(source.times);
  if (source.steady_ns <= 0) {
    throw BadInput(fmt::format(
        "{}: the KITTI format has no times; give a file of time stamps (--times) or a period (--sweep-period)",
        source.file.string()));
  }
  const std::size_t poses = count_kitti_poses(source.file);
  std::vector<std::int64_t> times;
  for (std::size_t k = 0; k < poses; ++k) times.push_back(static_cast<std::int64_t>(k) * source.steady_ns);
  return times;
}

std::vector<ReferencePose> poses_of(const ReferenceSource& source, const std::vector<std::int64_t>& sweeps_ns) {
  if (source.format == "tum") return read_tum_poses(source.file, source.sorted);
  if (source.format == "kitti") return read_kitti_poses(source.file, sweeps_ns.empty() ? own_times(source) : sweeps_ns);
  if (source.format == "odometry") return read_pose_table(source.file, source.sorted);
  throw BadInput(
      fmt::format("the pose format '{}' is not supported; supported: tum, kitti and odometry", source.format));
}

void move_to(std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_AB) {
  if (T_AB.matrix().isIdentity(0.0)) return;
  const Eigen::Quaterniond q_AB(T_AB.linear());
  for (ReferencePose& pose : poses) {
    pose.p_WA_m += pose.q_WA * T_AB.translation();
    pose.q_WA = (pose.q_WA * q_AB).normalized();
  }
}

sim::Truth named(const std::string& where, const std::vector<ReferencePose>& poses, std::int64_t end_ns) {
  try {
    return reference_truth(poses, end_ns);
  } catch (const BadInput& error) {
    throw BadInput(where + ": " + error.what());
  }
}

}  // namespace

Imported import_trajectory(const ReferenceSource& source) {
  std::vector<ReferencePose> poses = poses_of(source, {});
  if (poses.empty()) throw BadInput(source.file.string() + ": contains no pose");
  Imported out;
  out.info.origin_ns = origin_of(poses.front().time_ns);
  for (ReferencePose& pose : poses) pose.time_ns -= out.info.origin_ns;
  out.reference = named(source.file.string(), poses, poses.back().time_ns);
  out.info.attribution = "imported from " + source.file.filename().string();
  return out;
}

const Eigen::Isometry3d& lidar_of_poses(const sim::Sensors& sensors, const std::string& where) {
  if (sensors.lidars.empty())
    throw BadInput(fmt::format("{}: the poses belong to a lidar, but the recording has no lidar", where));
  return sensors.lidars.front().T_BL;
}

void attach_poses(Imported& recording, std::vector<ReferencePose> poses, const Eigen::Isometry3d& T_BA,
                  const std::string& where) {
  const sim::Sensors& sensors = recording.sensors;
  for (ReferencePose& pose : poses) pose.time_ns -= recording.info.origin_ns;
  const StampSpan span = span_of(sensors);
  if (!poses.empty()) {
    const auto shift_ns =
        clock_shift_ns({poses.front().time_ns, poses.back().time_ns}, span, {0, kExportOrigin_ns, -kExportOrigin_ns});
    for (ReferencePose& pose : poses) pose.time_ns += shift_ns.value_or(0);
    if (shift_ns.value_or(0) != 0) recording.notes.push_back(clock_note("the reference", *shift_ns));
  }
  std::string remark = check_reference(poses, T_BA, sensors, where);
  move_to(poses, T_BA.inverse(Eigen::Isometry));
  sim::Truth truth = named(where, poses, span.second);
  for (const sim::ImuRecord& imu : sensors.imus) {
    sim::ImuTruth& own = truth.imus.emplace_back();
    own.name = imu.name;
    own.T_BI = imu.T_BI;
  }
  for (const sim::LidarRecord& lidar : sensors.lidars) truth.lidars.push_back({lidar.name, lidar.T_BL, {}, {}});
  for (const sim::SeriesRecord& series : sensors.series) truth.series.push_back({series.name, series.T_BX, {}});
  recording.reference = std::move(truth);
  recording.notes.push_back(std::move(remark));
}

void attach_reference(Imported& recording, const ReferenceSource& source) {
  const sim::Sensors& sensors = recording.sensors;
  if (sensors.lidars.empty() && source.format == "kitti")
    throw BadInput(
        fmt::format("{}: a KITTI file has one pose per sweep, but the recording has no lidar", source.file.string()));
  std::vector<std::int64_t> sweeps_ns;
  if (!sensors.lidars.empty()) sweeps_ns = sensors.lidars.front().sweep_start_ns;
  for (std::int64_t& time : sweeps_ns) time += recording.info.origin_ns;
  const std::string where = source.file.string();
  const Eigen::Isometry3d T_BA = source.of_body ? Eigen::Isometry3d::Identity() : lidar_of_poses(sensors, where);
  attach_poses(recording, poses_of(source, sweeps_ns), T_BA, where);
  recording.info.attribution += "; reference from " + source.file.filename().string();
}

}  // namespace tumble::scenarios
