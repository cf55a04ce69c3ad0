// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace tumble {

/// Detects axes that are flipped or swapped in all gyros, or in all accelerometers, of several IMUs on one rigid body.
/// MultiImuSignCheck compares the specific forces at different positions with the measured rotation: imu_merge.md (I9).
struct MultiImuSignCheck {
  static constexpr std::size_t kMirroredAlternatives =
      12;  ///< gyros, then accelerometers: x, y or z flipped; xy, yz or zx swapped
  static constexpr double kMinEffectOnForces =
      0.3;  ///< minimum effect of an alternative on the force differences; the effect of biases is smaller
  static constexpr double kMinExplainedFraction =
      0.5;  ///< minimum (explained difference / effect): 1 for a correct alternative, -1 for a wrong one

  std::array<double, kMirroredAlternatives> explained_effect_per_alternative{}, effect_per_alternative{};

  /// Adds the mean readings of one IMU over `length_s`, in common axes. `force_m_s2` and `position_m` are relative to
  /// the mean of all IMUs. Cost: O(1), no allocation.
  void add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m, const Eigen::Vector3d& rate_rad_s,
           const Eigen::Vector3d& acceleration_rad_s2, double length_s);

  struct DetectedMirroring {
    std::size_t mirroring = 0;
    double explained_fraction = 0.0;
  };
  /// Returns the flip or swap of axes that best explains the differences between specific forces, or no value if none
  /// reaches kMinExplainedFraction.
  std::optional<DetectedMirroring> detected_mirroring() const;

  bool operator==(const MultiImuSignCheck&) const = default;
};

}  // namespace tumble
