// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/multi_imu_sign_check.hpp"

#include <Eigen/Geometry>
#include <utility>

namespace tumble {

namespace {

constexpr std::size_t kSingleSensorAlternatives = MultiImuSignCheck::kMirroredAlternatives / 2;

Eigen::Vector3d apply_mirroring(std::size_t sense, const Eigen::Vector3d& v) {
  Eigen::Vector3d out = v;
  const auto axis = static_cast<Eigen::Index>(sense % 3);
  if (sense < 3) {
    out[axis] = -out[axis];
  } else {
    std::swap(out[axis], out[(axis + 1) % 3]);
  }
  return out;
}

Eigen::Vector3d rotational_acceleration(const Eigen::Vector3d& w, const Eigen::Vector3d& a, const Eigen::Vector3d& d) {
  return a.cross(d) + w.cross(w.cross(d));
}

}  // namespace

/// See imu_merge.md (I9).
void MultiImuSignCheck::add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m,
                            const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& acceleration_rad_s2,
                            double length_s) {
  const Eigen::Vector3d read = rotational_acceleration(rate_rad_s, acceleration_rad_s2, position_m);
  for (std::size_t k = 0; k < kSingleSensorAlternatives; ++k) {
    const Eigen::Vector3d of_gyros =
        rotational_acceleration(apply_mirroring(k, rate_rad_s), apply_mirroring(k, acceleration_rad_s2), position_m);
    explained_effect_per_alternative[k] +=
        length_s * ((force_m_s2 - read).squaredNorm() - (force_m_s2 - of_gyros).squaredNorm());
    effect_per_alternative[k] += length_s * (of_gyros - read).squaredNorm();
    const Eigen::Vector3d force = apply_mirroring(k, force_m_s2);
    explained_effect_per_alternative[kSingleSensorAlternatives + k] +=
        length_s * ((force_m_s2 - read).squaredNorm() - (force - read).squaredNorm());
    effect_per_alternative[kSingleSensorAlternatives + k] += length_s * (apply_mirroring(k, read) - read).squaredNorm();
  }
}

std::optional<MultiImuSignCheck::DetectedMirroring> MultiImuSignCheck::detected_mirroring() const {
  std::optional<DetectedMirroring> best;
  double most = 0.0;
  for (std::size_t k = 0; k < kMirroredAlternatives; ++k) {
    if (effect_per_alternative[k] < kMinEffectOnForces ||
        explained_effect_per_alternative[k] < kMinExplainedFraction * effect_per_alternative[k])
      continue;
    if (explained_effect_per_alternative[k] <= most) continue;
    most = explained_effect_per_alternative[k];
    best = DetectedMirroring{k, explained_effect_per_alternative[k] / effect_per_alternative[k]};
  }
  return best;
}

}  // namespace tumble
