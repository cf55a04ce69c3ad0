// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_messages.hpp"

namespace tumble::scenarios {

std::string without_slash(const std::string& frame);

/// The tree of sensor frames comes from /tf_static; each frame has at most one parent.
class StaticFrames {
 public:
  /// If a frame has several transforms, the last transform is used. If the parent of a frame changes, remarks()
  /// contains a note. A transform is invalid if a value is not finite, the translation is above 1 km, or the norm of
  /// the quaternion differs from 1 by more than 1 %. A transform whose parent is its own frame is also invalid. An
  /// invalid transform throws an exception only when it is used, because bags also contain frames without relation to
  /// the sensors.
  void add(const ros::TransformStamped& transform, const std::string& where);

  void require_no_cycle(const std::string& where) const;

  const std::vector<std::string>& remarks() const { return remarks_; }

  std::string body() const;
  std::string names() const;

  std::optional<Eigen::Isometry3d> pose(const std::string& frame_A, const std::string& frame_B,
                                        const std::string& where) const;

 private:
  struct FrameLink {
    std::string parent;
    Eigen::Isometry3d T_parent;
    std::string problem;  ///< empty if valid
  };
  std::vector<FrameLink> path_to_root(const std::string& frame, const std::string& where) const;
  std::map<std::string, FrameLink> frames_;
  std::vector<std::string> remarks_;
};

std::string sensor_name(std::string topic);

class SensorMountings {
 public:
  SensorMountings(StaticFrames frames, std::string where) : frames_(std::move(frames)), where_(std::move(where)) {}

  /// Sets the mounting T_BA of a sensor A from /tf_static, unless the user has set T_BA. If the user's value differs
  /// from /tf_static, the function adds a caution to `notes`. If /tf_static contains only the pose of A relative to
  /// another sensor S, T_BA follows from the mounting of S, which an earlier call must have set.
  void place(const std::string& topic, const std::string& frame, const char* option, bool given,
             Eigen::Isometry3d& T_BA, std::vector<std::string>& notes);

  std::optional<Eigen::Isometry3d> of(const std::string& frame) const;
  std::string body() const { return frames_.body(); }
  /// Returns the pose of the first placed sensor, the primary IMU, in a frame. Throws WrongOption without this pose.
  Eigen::Isometry3d primary_imu_in(const std::string& frame) const;

 private:
  struct Placed {
    std::string topic, frame;
    Eigen::Isometry3d T_BA;
  };
  void mounting_in_body(const std::string& topic, const Eigen::Isometry3d& stated, bool given, Eigen::Isometry3d& T_BA,
                        std::vector<std::string>& notes) const;
  const Placed* neighbour(const std::string& frame) const;

  StaticFrames frames_;
  std::string where_;
  std::vector<Placed> placed_;
};

}  // namespace tumble::scenarios
