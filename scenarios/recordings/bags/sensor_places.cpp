// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/sensor_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scenarios/errors.hpp"

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
                      "sensor is at the centre of mass and has the body's axes",
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
        fmt::format("{}: /tf_static states the sensor's pose in '{}' as {}, but your option states {}. The "
                    "import uses your option",
                    topic, body, pose_text(stated), pose_text(T_BA)));
  }
}

const SensorMountings::Placed* SensorMountings::neighbour(const std::string& frame) const {
  for (const Placed& each : placed_) {
    // Two sensors with equal frame names may have different poses, because drivers often give all sensors of a device
    // one frame name.
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

Eigen::Isometry3d SensorMountings::primary_imu_in(const std::string& frame) const {
  const std::string imu = placed_.empty() ? "" : placed_.front().frame;
  if (const auto T = frames_.pose(frame, imu, where_)) return *T;
  throw WrongOption(
      fmt::format("--base-frame {}: {} does not contain the pose of the IMU's frame '{}' in this frame (frames with a "
                  "pose: {}); name another frame, or state the pose with --T-base-imu",
                  frame, where_, imu, frames_.names()));
}

namespace {

constexpr double kFrameFar_m = 1000.0, kFrameNormTolerance = 0.01;

}  // namespace

std::string without_slash(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

void StaticFrames::add(const ros::TransformStamped& transform, const std::string& where) {
  const std::string parent = without_slash(transform.header.frame_id), child = without_slash(transform.child_frame_id);
  const std::string what = fmt::format("{}: the transform of frame '{}' relative to frame '{}'", where, child, parent);
  const auto p = Eigen::Vector3d::Map(transform.translation.data());
  Eigen::Quaterniond q;
  q.coeffs() = Eigen::Vector4d::Map(transform.rotation_xyzw.data());
  FrameLink hung{parent, Eigen::Isometry3d::Identity(), ""};
  if (!(p.cwiseAbs().maxCoeff() <= kFrameFar_m) || !p.allFinite()) {
    hung.problem = fmt::format("{}: the translation must be finite and at most 1 km", what);
  } else if (!(std::abs(q.norm() - 1.0) <= kFrameNormTolerance)) {
    hung.problem =
        fmt::format("{}: the rotation quaternion has norm {}; its norm must be 1", what, std::to_string(q.norm()));
  } else if (parent == child) {
    hung.problem = fmt::format("{}: the frame is its own parent, but must have another parent", what);
  } else {
    hung.T_parent.linear() = q.normalized().toRotationMatrix();
    hung.T_parent.translation() = p;
  }
  if (!hung.problem.empty())
    remarks_.push_back(fmt::format("caution: the import ignores an invalid transform: {}", hung.problem));
  if (const auto before = frames_.find(child); before != frames_.end() && before->second.parent != parent) {
    remarks_.push_back(
        fmt::format("caution: frame '{}' has two parents, '{}' and later '{}'; the import uses the later parent ({})",
                    child, before->second.parent, parent, where));
  }
  frames_.insert_or_assign(child, std::move(hung));
}

void StaticFrames::require_no_cycle(const std::string& where) const {
  for (const auto& [frame, on] : frames_) path_to_root(frame, where);
}

std::string StaticFrames::body() const {
  for (const char* name : {"body", "base_link"}) {
    const auto on_it = [&](const auto& each) { return each.second.parent == name; };
    if (frames_.contains(name) || std::any_of(frames_.begin(), frames_.end(), on_it)) return name;
  }
  return "";
}

std::string StaticFrames::names() const {
  std::string out;
  for (const auto& [frame, on] : frames_) out += fmt::format("{}{} in {}", out.empty() ? "" : ", ", frame, on.parent);
  return out.empty() ? "none" : out;
}

std::vector<StaticFrames::FrameLink> StaticFrames::path_to_root(const std::string& frame,
                                                                const std::string& where) const {
  std::vector<FrameLink> out = {{frame, Eigen::Isometry3d::Identity(), ""}};
  for (std::size_t steps = 0; steps <= frames_.size(); ++steps) {
    const auto found = frames_.find(out.back().parent);
    if (found == frames_.end() || found->second.parent == found->first) return out;
    const auto& [parent, T_parent, problem] = found->second;
    const FrameLink& below = out.back();
    out.push_back({parent, T_parent * below.T_parent, below.problem.empty() ? problem : below.problem});
  }
  throw BadInput(fmt::format("{}: the frame '{}' and its parent frames form a loop; a tree of frames must have no loop",
                             where, frame));
}

std::optional<Eigen::Isometry3d> StaticFrames::pose(const std::string& frame_A, const std::string& frame_B,
                                                    const std::string& where) const {
  const std::vector<FrameLink> A = path_to_root(without_slash(frame_A), where),
                               B = path_to_root(without_slash(frame_B), where);
  for (const FrameLink& a : A) {
    const auto b = std::find_if(B.begin(), B.end(), [&](const FrameLink& each) { return each.parent == a.parent; });
    if (b == B.end()) continue;
    for (const std::string& problem : {a.problem, b->problem}) {
      if (!problem.empty()) throw BadInput(problem);
    }
    return a.T_parent.inverse() * b->T_parent;
  }
  return std::nullopt;
}

}  // namespace tumble::scenarios
