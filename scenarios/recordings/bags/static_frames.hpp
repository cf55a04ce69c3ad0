// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_messages.hpp"

namespace tumble::scenarios {

/// Removes the leading slash of a ROS 1 frame name.
std::string without_slash(const std::string& frame);

/// StaticFrames is the tree of sensor frames from the topic /tf_static. Each frame has at most one parent.
class StaticFrames {
 public:
  /// Adds a transform to the tree. If a frame is repeated, the last transform is used, and a changed parent gives a
  /// note (`remarks`). A transform is invalid if it has non-finite values, a translation above 1 km, or a frame as its
  /// own parent. A transform is also invalid if the norm of its quaternion differs from 1 by more than 1 %. An invalid
  /// transform gives a note with `where`, and an exception only when it is used, because bags contain frames unrelated
  /// to the sensors.
  void add(const ros::TransformStamped& transform, const std::string& where);

  /// Throws BadInput, with a message that starts with `where`, if the frames form a cycle.
  void require_no_cycle(const std::string& where) const;

  const std::vector<std::string>& remarks() const { return remarks_; }

  /// Returns the name of the body's frame: "body" if it exists, or else "base_link", or else an empty text.
  std::string body() const;

  /// Returns the pose T_AB of frame B in frame A; empty if the tree does not connect the frames. Throws BadInput, with
  /// a message that starts with `where`, if a transform between the frames is invalid or the frames form a cycle.
  std::optional<Eigen::Isometry3d> pose(const std::string& frame_A, const std::string& frame_B,
                                        const std::string& where) const;

 private:
  struct FrameLink {
    std::string parent;
    Eigen::Isometry3d T_parent;  ///< pose of the frame in its parent
    std::string problem;         ///< why the transform is invalid; empty if valid
  };
  /// Returns the path from the frame to the root of the tree. Each entry contains the pose of `frame` in one ancestor.
  std::vector<FrameLink> path_to_root(const std::string& frame, const std::string& where) const;
  std::map<std::string, FrameLink> frames_;
  std::vector<std::string> remarks_;
};

}  // namespace tumble::scenarios
