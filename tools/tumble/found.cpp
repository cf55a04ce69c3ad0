// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/found.hpp"

#include <fmt/format.h>
#include <cmath>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/diagnosis/probable_devices.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/standard_gravity.hpp"

namespace tumble::tools {

namespace {

using scenarios::rounded;

constexpr const char* kLidarPose = "pose of the lidar";
constexpr const char *kStated = "stated", *kMeasured = "measured", *kAssumed = "assumed", *kByName = "by name";

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({} {} {})", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

std::string pose_text(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  return fmt::format("{} m, quaternion x y z w ({} {} {} {})", vector_text(T.translation()), rounded(q.x()),
                     rounded(q.y()), rounded(q.z()), rounded(q.w()));
}

std::string rate_text(std::int64_t period_ns) {
  return period_ns > 0 ? rounded(1e9 / static_cast<double>(period_ns)) + " Hz" : "unknown rate";
}

class Found {
 public:
  Found(const Session& session, OpenRecording& recording) : recording_(recording) {
    for (const std::string& name : scenarios::device_names(session.data()))
      sheets_.push_back(scenarios::load_data_sheet(session.data(), name));
  }

  std::vector<RecordingSetting> items() && { return std::move(items_); }

  void add_source() {
    const ImportOptions& options = recording_.options;
    add("format", recording_.format, options.format.empty() ? kMeasured : kStated, "--format");
    const auto stamps = repaired("--stamps");
    const bool bag = recording_.format == "mcap" || recording_.format.starts_with("rosbag");
    if (bag)
      add("time stamps", options.stamps == "record" ? "of the bag's records" : "of the message headers",
          stamps                   ? kMeasured
          : options.stamps.empty() ? kAssumed
                                   : kStated,
          "--stamps");
  }

  void add_imu() {
    sim::ImuRecord& imu = imus().front();
    add("IMU",
        fmt::format("'{}': {} readings at {}{}", imu.name, imu.time_ns.size(), rate_text(imu.period_ns),
                    others(imus().size())),
        source_of(imus().size(), recording_.options.imu_topics), "--imu-topic");
    add_imu_sheet(imu);
    add_units(imu);
    add_gravity(imu);
  }

  void add_lidar() {
    sim::LidarRecord& lidar = lidars().front();
    const std::set<std::uint16_t> rings(lidar.ring.begin(), lidar.ring.end());
    add("lidar",
        fmt::format("'{}': {} sweeps at {}, {} points, {} ring{}{}", lidar.name, lidar.sweep_start_ns.size(),
                    rate_text(lidar.sweep_period_ns), lidar.position_L_m.size(), rings.size(),
                    rings.size() == 1 ? "" : "s", others(lidars().size())),
        source_of(lidars().size(), recording_.options.lidar_topics), "--lidar-topic");
    add_lidar_sheet(lidar);
    add("point times", point_times(lidar), recording_.options.time_unit.empty() ? kMeasured : kStated,
        "--time-field, --time-unit, --not-skewed");
    add_clocks();
  }

  void add_mounting() {
    const ImportOptions& options = recording_.options;
    const Eigen::Vector3d arm_m = imus().front().T_BI.translation();
    const bool arm_stated = !options.lever_arm_m.empty() || !arm_m.isZero(0.0);
    add("lever arm of the IMU",
        arm_stated ? fmt::format("{} m from {}", vector_text(arm_m),
                                 options.lever_arm_m.empty()
                                     ? "the origin of the body frame, which is assumed to be the centre of mass"
                                     : "the centre of mass")
                   : "the IMU is assumed at the centre of mass (lever arm 0). A wrong lever arm can cause a tracking "
                     "failure while the gyro clips, and is harmless otherwise",
        arm_stated ? kStated : kAssumed, "--lever-arm X Y Z");
    sim::LidarRecord& lidar = lidars().front();
    const bool pose_stated =
        !options.T_body_lidar.empty() || !lidar.T_BL.isApprox(Eigen::Isometry3d::Identity(), 1e-12);
    if (pose_stated) return add(kLidarPose, pose_text(lidar.T_BL), kStated, kPoseOption);
    const std::string calibrated =
        fmt::format("mapping calibrates the pose; before the calibration, the standard deviations are {} m and {} rad",
                    kAssumedLidarSigma_m, kAssumedLidarSigma_rad);
    if (const auto& better = recording_.rotation.better_BL) {
      lidar.T_BL = *better;
      return add(kLidarPose,
                 fmt::format("{}: the lidar's attitude is estimated from the rotations of lidar and gyro, and the "
                             "lidar's position is assumed 0; {}",
                             pose_text(lidar.T_BL), calibrated),
                 kMeasured, kPoseOption);
    }
    add(kLidarPose, "the lidar frame is assumed equal to the body frame; " + calibrated, kAssumed, kPoseOption);
  }

  void add_base() {
    const auto& T_base_imu = recording_.content.T_base_imu;
    add("frame of the written poses",
        T_base_imu ? "base frame, in which the pose of the IMU is " + pose_text(*T_base_imu) : "IMU",
        T_base_imu ? kStated : kAssumed, "--T-base-imu X Y Z QX QY QZ QW, or --base-frame NAME");
  }

  void add_own_body(const Eigen::AlignedBox3d& box, bool stated) {
    add("robot's own returns",
        box.sizes().isZero(0.0)
            ? fmt::format(
                  "only lidar returns nearer than {} m are removed. Set a box if the lidar measures parts of the robot",
                  rounded(LidarInertialOdometry::Params{}.range_min_m))
            : fmt::format("lidar returns inside a box around the robot are removed: from {} to {} m in lidar axes",
                          vector_text(box.min()), vector_text(box.max())),
        stated ? kStated : kAssumed, "--own-body X Y Z X Y Z (two opposite corners)");
  }

 private:
  static constexpr const char* kPoseOption = "--T-body-lidar X Y Z QX QY QZ QW";

  std::vector<sim::ImuRecord>& imus() { return recording_.content.sensors.imus; }
  std::vector<sim::LidarRecord>& lidars() { return recording_.content.sensors.lidars; }

  void add(std::string item, std::string found, std::string source, std::string option) {
    items_.push_back({std::move(item), std::move(found), std::move(source), std::move(option)});
  }

  static const char* source_of(std::size_t count, const std::vector<std::string>& topics) {
    return !topics.empty() ? kStated : count > 1 ? kAssumed : kMeasured;
  }

  static std::string others(std::size_t count) { return count > 1 ? fmt::format(", first of {}", count) : ""; }

  bool repaired(const std::string& option) const {
    return std::ranges::any_of(recording_.repairs, [&](const Repair& each) { return each.option.name == option; });
  }

  void add_imu_sheet(sim::ImuRecord& imu) {
    const std::string option = "--device NAME";
    if (!imu.device.empty()) return add("data sheet of the IMU", imu.device, kStated, option);
    const auto device = scenarios::probable_imu(imu, sheets_);
    if (!device)
      return add(
          "data sheet of the IMU",
          "no data sheet: the noise is assumed typical, and the saturation limits are detected from the readings",
          kAssumed, option);
    scenarios::apply_sheet(*std::ranges::find(sheets_, device->device, &scenarios::DataSheet::device), imu);
    add("data sheet of the IMU", device->device + ": " + device->evidence, kByName, option);
  }

  void add_lidar_sheet(sim::LidarRecord& lidar) {
    const std::string option = "--lidar NAME";
    if (!lidar.device.empty()) return add("data sheet of the lidar", lidar.device, kStated, option);
    const auto device = scenarios::probable_lidar(lidar, sheets_);
    if (!device)
      return add("data sheet of the lidar", "no known lidar matches; odometry works without a data sheet", kAssumed,
                 option);
    lidar.device = device->device;
    add("data sheet of the lidar", device->device + ": " + device->evidence,
        device->evidence.starts_with("name") ? kByName : kMeasured, option);
  }

  void add_units(const sim::ImuRecord& imu) {
    const ImportOptions& options = recording_.options;
    const auto& agreement = recording_.rotation.primary;
    const std::string evidence =
        !agreement ? "the rotations of gyro and lidar cannot be compared in this recording"
        : agreement->unit == 1.0
            ? fmt::format("the rotations between sweeps that gyro and lidar measure agree within {} %",
                          rounded(100.0 * agreement->unit_error))
            : "probably wrong: the ratio of lidar rotation to gyro rotation is " + rounded(agreement->unit);
    add("unit of the gyro", fmt::format("{}: {}", options.gyro_unit.empty() ? "rad/s" : options.gyro_unit, evidence),
        agreement                                              ? kMeasured
        : options.gyro_unit.empty() || repaired("--gyro-unit") ? kAssumed
                                                               : kStated,
        "--gyro-unit");
    std::vector<double> norms;
    for (const Eigen::Vector3d& force : imu.accel_m_s2) norms.push_back(force.norm());
    const double middle = scenarios::upper_median(std::move(norms));
    add("unit of the accelerometer",
        fmt::format("{}: the median specific force is {} m/s^2",
                    options.accel_unit.empty() ? "m/s^2" : options.accel_unit, rounded(middle)),
        kMeasured, "--accel-unit");
  }

  void add_gravity(const sim::ImuRecord& imu) {
    const Eigen::Vector3d force = imu.accel_m_s2.empty() ? Eigen::Vector3d::Zero() : imu.accel_m_s2.front();
    add("gravity",
        fmt::format("{} m/s^2; the first accelerometer reading is {} m/s^2 along {}",
                    rounded(recording_.content.sensors.gravity_m_s2), rounded(force.norm()),
                    vector_text(force.normalized())),
        kMeasured, "no option is needed, because the IMU may have any orientation");
  }

  static std::string point_times(const sim::LidarRecord& lidar) {
    if (lidar.point_times == sim::PointTimes::unknown) return "the points have no times, so sweeps are not deskewed";
    if (lidar.point_times == sim::PointTimes::not_skewed) return "one instant per sweep";
    const auto last = lidar.offset_ns.empty() ? lidar.offset_ns.end() : std::ranges::max_element(lidar.offset_ns);
    const double longest_s = last == lidar.offset_ns.end() ? 0.0 : 1e-9 * static_cast<double>(*last);
    return fmt::format("each point has a time, up to {} s after the start of its sweep", rounded(longest_s));
  }

  void add_clocks() {
    const auto& agreement = recording_.rotation.primary;
    if (!agreement)
      return add("clock of the lidar",
                 "the lidar's time stamps are unchanged; mapping calibrates the offset of the lidar's clock to the "
                 "IMU's clock",
                 kAssumed, "--imu-minus-lidar-clock");
    add("clock of the lidar",
        agreement->delay_s == 0.0
            ? std::string(
                  "the lidar's clock agrees with the IMU's clock within about 10 ms; mapping calibrates the offset")
            : fmt::format("the lidar measures the same rotation {} s {} than the gyro",
                          rounded(std::abs(agreement->delay_s)), agreement->delay_s > 0.0 ? "later" : "earlier"),
        kMeasured, "--imu-minus-lidar-clock");
  }

  OpenRecording& recording_;
  std::vector<scenarios::DataSheet> sheets_;
  std::vector<RecordingSetting> items_;
};

}  // namespace

std::vector<RecordingSetting> complete_recording(const Session& session, OpenRecording& recording,
                                                 const Eigen::AlignedBox3d& own_body_L, bool own_body_stated) {
  Found found(session, recording);
  found.add_source();
  found.add_imu();
  found.add_lidar();
  found.add_mounting();
  found.add_own_body(own_body_L, own_body_stated);
  found.add_base();
  return std::move(found).items();
}

void set_replaced_pose(const Eigen::Isometry3d& T_BL, std::vector<RecordingSetting>& items) {
  const auto pose = std::ranges::find(items, kLidarPose, &RecordingSetting::name);
  if (pose == items.end()) return;
  pose->value =
      fmt::format("{}: estimated from the recording. The pose before the run was {}", pose_text(T_BL), pose->value);
  pose->source = kMeasured;
}

bool states_lidar_pose(const std::vector<RecordingSetting>& items) {
  return std::ranges::any_of(
      items, [](const RecordingSetting& each) { return each.name == kLidarPose && each.source == kStated; });
}

Table found_table(const std::vector<RecordingSetting>& items) {
  Table table("", {"item", "source", "change with", "found"});
  table.wrap_last();
  for (const RecordingSetting& each : items) table.add_row({each.name, each.source, each.option, each.value});
  return table;
}

nlohmann::json found_document(const std::vector<RecordingSetting>& items) {
  nlohmann::json out = nlohmann::json::array();
  for (const RecordingSetting& each : items)
    out.push_back({{"item", each.name}, {"found", each.value}, {"source", each.source}, {"option", each.option}});
  return out;
}

}  // namespace tumble::tools
