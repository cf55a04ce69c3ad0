// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/static_frames.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kFrameFar_m = 1000.0, kFrameNormTolerance = 0.01;

/// ROS 1 wrote "/imu" for what is called "imu" now.
std::string without_slash(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

void StaticFrames::add(const ros::TransformStamped& transform, const std::string& where) {
  const std::string parent = without_slash(transform.header.frame_id), child = without_slash(transform.child_frame_id);
  const std::string what = where + ": the transform of '" + child + "' in '" + parent + "'";
  const auto p = Eigen::Vector3d::Map(transform.translation.data());
  Eigen::Quaterniond q;
  q.coeffs() = Eigen::Vector4d::Map(transform.rotation_xyzw.data());
  if (!(p.cwiseAbs().maxCoeff() <= kFrameFar_m) || !p.allFinite())
    throw BadInput(what + ": its place must be within 1 km");
  if (!(std::abs(q.norm() - 1.0) <= kFrameNormTolerance))
    throw BadInput(what + ": its quaternion has norm " + std::to_string(q.norm()) + ", must be 1");
  if (parent == child) throw BadInput(what + ": the frame hangs on itself");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = q.normalized().toRotationMatrix();
  T.translation() = p;
  if (const auto before = frames_.find(child); before != frames_.end() && before->second.parent != parent) {
    remarks_.push_back("caution: '" + child + "' hangs on '" + before->second.parent + "' and, later, on '" + parent +
                       "', must hang on one: the later holds (" + where + ")");
  }
  frames_.insert_or_assign(child, Hung{parent, T});
}

void StaticFrames::require_no_ring(const std::string& where) const {
  for (const auto& [frame, on] : frames_) root_of(frame, where);
}

std::string StaticFrames::body() const {
  for (const char* name : {"body", "base_link"}) {
    const auto on_it = [&](const auto& each) { return each.second.parent == name; };
    if (frames_.contains(name) || std::any_of(frames_.begin(), frames_.end(), on_it)) return name;
  }
  return "";
}

StaticFrames::Hung StaticFrames::root_of(const std::string& frame, const std::string& where) const {
  Hung out{frame, Eigen::Isometry3d::Identity()};
  for (std::size_t steps = 0; steps <= frames_.size(); ++steps) {
    const auto found = frames_.find(out.parent);
    if (found == frames_.end()) return out;
    out = {found->second.parent, found->second.T_parent * out.T_parent};
  }
  throw BadInput(where + ": '" + frame + "' and the frames that it hangs on hang on each other in a ring");
}

std::optional<Eigen::Isometry3d> StaticFrames::pose(const std::string& frame_A, const std::string& frame_B,
                                                    const std::string& where) const {
  const Hung A = root_of(without_slash(frame_A), where), B = root_of(without_slash(frame_B), where);
  if (A.parent != B.parent) return std::nullopt;
  return A.T_parent.inverse() * B.T_parent;
}

}  // namespace tumble::scenarios
