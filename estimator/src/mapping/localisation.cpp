// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <algorithm>
#include <cmath>

#include "unknowns.hpp"

namespace tumble {

void Localisation::add(const SweepReport& sweep) {
  mapped_ = mapped_ || sweep.verdict != SweepVerdict::rejected;
  if (!mapped_) return;
  const double variance_m2 = sweep.pose.covariance.topLeftCorner<3, 3>().trace();
  largest_sigma_m_ = std::max(largest_sigma_m_, std::sqrt(variance_m2));
  second_innovation_ = std::max(second_innovation_, std::min(largest_innovation_, sweep.innovation));
  largest_innovation_ = std::max(largest_innovation_, sweep.innovation);
}

/// Returns an error if tracking failed (R70), or if sweeps contradict their predicted poses (R71): mapping.md.
Status Localisation::verdict() const {
  if (largest_sigma_m_ > matched_m_)
    return {Trouble::out_of_range, "deviation of a sweep's position", largest_sigma_m_, matched_m_};
  const double innovation_max = std::sqrt(mapping::unknowns::kAgrees / SweepUnknowns::kMotion);
  if (second_innovation_ > innovation_max)
    return {Trouble::out_of_range, "innovation of two sweeps", second_innovation_, innovation_max};
  return {};
}

}  // namespace tumble
