// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/ros_messages.hpp"

namespace tumble::scenarios {

/// ROS 1 wrote "/imu" for what is called "imu" now.
std::string without_slash(const std::string& frame);

/// Where frames stand to each other, as messages on /tf_static say: each hangs on one parent. Private to
/// scenarios/recordings/bags.
class StaticFrames {
 public:
  /// Takes a transform; of a frame that is stated again the last one holds, and where it hung on another before, that
  /// is told (`remarks`). One that makes no sense (not finite, beyond 1 km, a quaternion whose norm is not 1 within a
  /// percent, a frame that hangs on itself) is told with `where`, and refused when something asks for it: bags hold
  /// frames of the Earth, and of what has nothing to do with the sensors.
  void add(const ros::TransformStamped& transform, const std::string& where);

  /// Throws BadInput beginning with `where` when frames hang on each other in a ring.
  void require_no_ring(const std::string& where) const;

  const std::vector<std::string>& remarks() const { return remarks_; }

  /// The frame that is taken for the body's: "body", else "base_link", else none.
  std::string body() const;

  /// T_AB of two frames that hang on the same one, or one on the other; nothing where they do not. Throws BadInput when
  /// a transform between them makes no sense, and beginning with `where` when frames hang on each other in a ring.
  std::optional<Eigen::Isometry3d> pose(const std::string& frame_A, const std::string& frame_B,
                                        const std::string& where) const;

 private:
  struct Hung {
    std::string parent;
    Eigen::Isometry3d T_parent;  ///< takes coordinates of the frame to its parent's
    std::string problem;         ///< why it makes no sense, "" where it does
  };
  /// The frame and all that it hangs on, upwards, each with the frame's pose there.
  std::vector<Hung> way_up(const std::string& frame, const std::string& where) const;
  std::map<std::string, Hung> frames_;
  std::vector<std::string> remarks_;
};

}  // namespace tumble::scenarios
