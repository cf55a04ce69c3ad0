// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

namespace tumble {

/// Detects wrong axes that all IMUs share: a flipped axis of the gyros or of the accelerometers, or two swapped axes.
/// MultiImuSignCheck compares force differences between IMUs at different positions of one rigid body: imu_merge.md
/// (I9).
struct MultiImuSignCheck {
  static constexpr std::size_t kMirroredAlternatives =
      12;  ///< gyros, then accelerometers: x, y or z flipped; xy, yz or zx swapped
  static constexpr double kMinEffectOnForces = 0.3;  ///< minimum effect on the forces; the effect of biases is smaller
  static constexpr double kMinExplainedFraction =
      0.5;  ///< minimum ratio explained / effect; the ratio is 1 if the alternative is correct, and -1 if not

  std::array<double, kMirroredAlternatives> explained_effect_per_alternative{}, effect_per_alternative{};

  /// All inputs are in common axes and cover the time `length_s`. `force_m_s2` and `position_m` are relative to the
  /// mean of all IMUs. Cost: O(1), no allocation.
  void add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m, const Eigen::Vector3d& rate_rad_s,
           const Eigen::Vector3d& acceleration_rad_s2, double length_s);

  struct DetectedMirroring {
    std::size_t mirroring = 0;
    double explained_fraction = 0.0;
  };
  /// Returns the flip or swap of axes that best explains the force differences, or no value if none reaches
  /// kMinExplainedFraction.
  std::optional<DetectedMirroring> detected_mirroring() const;

  bool operator==(const MultiImuSignCheck&) const = default;
};

}  // namespace tumble
