// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/base_frame.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

std::vector<PoseState> written_poses(const Estimate& estimate) {
  std::vector<PoseState> poses = estimate.poses;
  if (!estimate.T_base_imu) return poses;
  if (estimate.frame != Frame::imu)
    throw BadInput(fmt::format(
        "the method estimates poses of the frame '{}'; only poses of the IMU can be converted to the base frame",
        to_string(estimate.frame)));
  const Eigen::Isometry3d T_imu_base = estimate.T_base_imu->inverse();
  for (PoseState& pose : poses) pose = pose.transformed_to(T_imu_base, Eigen::Vector3d::Zero());
  return poses;
}

std::array<double, 7> numbers_of(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

Eigen::Isometry3d pose_of(const JsonMembers& reader, const char* key) {
  const nlohmann::json& found = reader.member(key);
  const char* const wanted = "x y z and a quaternion qx qy qz qw of norm 1";
  if (!found.is_array() || found.size() != 7) reader.complain(key, wanted);
  std::array<double, 7> numbers{};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (!found[k].is_number()) reader.complain(key, wanted);
    numbers[k] = found[k].get<double>();
  }
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-2)) reader.complain(key, wanted);
  return Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) * q.normalized();
}

}  // namespace tumble::scenarios
