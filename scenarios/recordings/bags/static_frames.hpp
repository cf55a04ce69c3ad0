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
  /// The last transform of a repeated frame is used; a changed parent gives a note. A transform is invalid if it has
  /// non-finite values, a translation above 1 km, its own frame as parent, or a quaternion whose norm differs from 1 by
  /// more than 1 %. An invalid transform causes an exception only when it is used, because bags contain frames
  /// unrelated to the sensors.
  void add(const ros::TransformStamped& transform, const std::string& where);

  void require_no_cycle(const std::string& where) const;

  const std::vector<std::string>& remarks() const { return remarks_; }

  std::string body() const;

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

}  // namespace tumble::scenarios
