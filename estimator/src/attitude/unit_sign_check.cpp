// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/unit_sign_check.hpp"

#include <Eigen/Geometry>
#include <utility>

namespace tumble {

namespace {

constexpr std::size_t kSingleSensorAlternatives = UnitSignCheck::kAlternatives / 2;

Eigen::Vector3d apply_alternative(std::size_t sense, const Eigen::Vector3d& v) {
  Eigen::Vector3d out = v;
  const auto axis = static_cast<Eigen::Index>(sense % 3);
  if (sense < 3) {
    out[axis] = -out[axis];
  } else {
    std::swap(out[axis], out[(axis + 1) % 3]);
  }
  return out;
}

Eigen::Vector3d by_rotation(const Eigen::Vector3d& w, const Eigen::Vector3d& a, const Eigen::Vector3d& d) {
  return a.cross(d) + w.cross(w.cross(d));
}

}  // namespace

/// See imu_merge.md (I9).
void UnitSignCheck::add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m,
                        const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& acceleration_rad_s2,
                        double length_s) {
  const Eigen::Vector3d read = by_rotation(rate_rad_s, acceleration_rad_s2, position_m);
  for (std::size_t k = 0; k < kSingleSensorAlternatives; ++k) {
    const Eigen::Vector3d of_gyros =
        by_rotation(apply_alternative(k, rate_rad_s), apply_alternative(k, acceleration_rad_s2), position_m);
    explained_m2_s3[k] += length_s * ((force_m_s2 - read).squaredNorm() - (force_m_s2 - of_gyros).squaredNorm());
    effect_m2_s3[k] += length_s * (of_gyros - read).squaredNorm();
    const Eigen::Vector3d force = apply_alternative(k, force_m_s2);
    explained_m2_s3[kSingleSensorAlternatives + k] +=
        length_s * ((force_m_s2 - read).squaredNorm() - (force - read).squaredNorm());
    effect_m2_s3[kSingleSensorAlternatives + k] += length_s * (apply_alternative(k, read) - read).squaredNorm();
  }
}

std::optional<UnitSignCheck::Detected> UnitSignCheck::detected() const {
  std::optional<Detected> best;
  double most = 0.0;
  for (std::size_t k = 0; k < kAlternatives; ++k) {
    if (effect_m2_s3[k] < kEffectMin_m2_s3 || explained_m2_s3[k] < kExplainedRatioMin * effect_m2_s3[k]) continue;
    if (explained_m2_s3[k] <= most) continue;
    most = explained_m2_s3[k];
    best = Detected{k, explained_m2_s3[k] / effect_m2_s3[k]};
  }
  return best;
}

}  // namespace tumble
