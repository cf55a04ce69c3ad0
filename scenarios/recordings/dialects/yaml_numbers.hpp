// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scenarios/recordings/number_text.hpp"

/// The functions in yaml_numbers.hpp write numbers that every YAML reader accepts as doubles. All numbers have a
/// decimal point: ROS 2 requires it for a double, and YAML 1.1 requires it before an exponent.
namespace tumble::scenarios {

inline std::string decimal(double value) {
  std::string text;
  append_number(text, value == 0.0 ? 0.0 : value);  // avoids "-0"
  if (text.find('.') != std::string::npos) return text;
  const std::size_t exponent = text.find('e');
  return exponent == std::string::npos ? text + ".0" : text.insert(exponent, ".0");
}

inline std::string decimals(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + decimal(value);
  return text + "]";
}

inline std::string translation_of(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T.translation();
  return decimals({p.x(), p.y(), p.z()});
}

/// Returns the text of a rotation matrix, row by row.
inline std::string rotation_of(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  return decimals({R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)});
}

/// Returns the text of a pose as qx qy qz qw x y z.
inline std::string quaternion_first(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  const Eigen::Vector3d p = T.translation();
  return decimals({q.x(), q.y(), q.z(), q.w(), p.x(), p.y(), p.z()});
}

/// Rounds a range up to whole metres.
inline double whole_metres(double range_m) {
  return std::max(1.0, std::ceil(range_m));
}

}  // namespace tumble::scenarios
