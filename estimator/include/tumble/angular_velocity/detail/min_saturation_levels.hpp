// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble {

/// Lower bounds of the gyro's saturation limits, per sensing element and sign: rails.md (R75).
class MinSaturationLevels {
 public:
  void add(const Eigen::Vector3d& rate_rad_s);
  /// Returns true if the reading of the sensing element `axis` is certainly below the saturation limit.
  bool is_below_min_saturation_level(const Eigen::Vector3d& rate_rad_s, Eigen::Index axis) const;
  bool operator==(const MinSaturationLevels&) const = default;

 private:
  std::array<Eigen::Vector3d, 2> min_levels_rad_s_{Eigen::Vector3d::Zero(),
                                                   Eigen::Vector3d::Zero()};  // negative side, positive side
};

}  // namespace tumble
