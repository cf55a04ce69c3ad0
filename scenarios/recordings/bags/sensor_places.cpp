// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/sensor_places.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <sstream>

namespace tumble::scenarios {

namespace {

std::string pose_text(const Eigen::Isometry3d& T) {
  std::ostringstream out;
  const Eigen::Quaterniond q(T.linear());
  const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", " ");
  out << "(" << T.translation().transpose().format(row) << ") m, quaternion x y z w ("
      << q.coeffs().transpose().format(row) << ")";
  return out.str();
}

}  // namespace

std::string sensor_name(std::string topic) {
  while (topic.starts_with('/')) topic.erase(0, 1);
  if (topic.ends_with("/points")) topic.resize(topic.size() - 7);
  std::replace(topic.begin(), topic.end(), '/', '_');
  return topic;
}

void SensorMountings::place(const std::string& topic, const std::string& frame, const char* option, bool given,
                            Eigen::Isometry3d& T_BA, std::vector<std::string>& notes) {
  given = given || !T_BA.isApprox(Eigen::Isometry3d::Identity());
  const std::string body = frames_.body();
  const auto stated = body.empty() ? std::nullopt : frames_.pose(body, frame, where_);
  if (stated) {
    mounting_in_body(topic, *stated, given, T_BA, notes);
  } else if (!given) {
    if (const Placed* beside = neighbour(frame); beside != nullptr) {
      T_BA = beside->T_BA * *frames_.pose(beside->frame, frame, where_);
      notes.push_back(
          fmt::format("{}: /tf_static contains the sensor's pose relative to {}, but no frame 'body' or 'base_link'; "
                      "the pose on the body is therefore {}",
                      topic, beside->topic, pose_text(T_BA)));
    } else {
      notes.push_back(
          fmt::format("{}: neither /tf_static nor {} states the sensor's pose on the body; the import assumes that the "
                      "sensor is at the centre of mass, along the body's axes",
                      topic, option));
    }
  }
  placed_.push_back({topic, frame, T_BA});
}

void SensorMountings::mounting_in_body(const std::string& topic, const Eigen::Isometry3d& stated, bool given,
                                       Eigen::Isometry3d& T_BA, std::vector<std::string>& notes) const {
  constexpr double kSame = 1e-3;  // tolerance [m] and [rad]
  const std::string body = frames_.body();
  if (!given) {
    T_BA = stated;
    notes.push_back(
        fmt::format("{}: /tf_static contains the sensor's pose in '{}': {}", topic, body, pose_text(stated)));
  } else if (!(T_BA.matrix() - stated.matrix()).isZero(kSame)) {
    notes.push_back(
        fmt::format("{}: caution: /tf_static contains the sensor's pose in '{}' as {}, but your option states the pose "
                    "{}; the import uses your option",
                    topic, body, pose_text(stated), pose_text(T_BA)));
  }
}

const SensorMountings::Placed* SensorMountings::neighbour(const std::string& frame) const {
  for (const Placed& each : placed_) {
    // Drivers give all sensors of a device one frame, so equal frames do not determine the pose between two sensors.
    if (each.frame != frame && frames_.pose(each.frame, frame, where_)) return &each;
  }
  return nullptr;
}

std::optional<Eigen::Isometry3d> SensorMountings::of(const std::string& frame) const {
  for (const Placed& each : placed_) {
    if (each.frame == frame) return each.T_BA;
  }
  if (const std::string body = frames_.body(); !body.empty()) return frames_.pose(body, frame, where_);
  const Placed* const beside = neighbour(frame);
  if (beside == nullptr) return std::nullopt;
  return beside->T_BA * *frames_.pose(beside->frame, frame, where_);
}

}  // namespace tumble::scenarios
