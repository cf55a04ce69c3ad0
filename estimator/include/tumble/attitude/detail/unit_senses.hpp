// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace tumble {

/// Whether the differences of the forces of units at several places of one rigid body speak for axes other than those
/// read, of all units alike: an axis of the gyros or of the accelerometers flipped, or two of them swapped. Sums, from
/// start to end. imu_merge.md (I7a).
struct UnitSenses {
  static constexpr std::size_t kSenses = 12;  ///< x, y, z flipped; x y, y z, z x swapped; of gyros, then accelerometers
  static constexpr double kSizeMin_m2_s3 = 0.3;  ///< of what a sense changes, to be told: less is within biases
  static constexpr double kShareMin = 0.5;       ///< 1: the sense explains all; -1: as it was read does

  std::array<double, kSenses> gain_m2_s3{}, size_m2_s3{};

  /// One unit over `length_s`: its force less the mean of all, its place from theirs, rate and angular acceleration;
  /// common axes. O(1), no allocation.
  void add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m, const Eigen::Vector3d& rate_rad_s,
           const Eigen::Vector3d& acceleration_rad_s2, double length_s);

  struct Told {
    std::size_t sense = 0;
    double share = 0.0;
  };
  /// The one that explains most, where it explains more than kShareMin.
  std::optional<Told> told() const;

  bool operator==(const UnitSenses&) const = default;
};

}  // namespace tumble
