// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

// Of chi-square of the motion's nine unknowns: exceeded as rarely as five deviations of a normal one, once in 1.7
// million. Per root of nine 2.27.
constexpr double kUnknowns = 9.0, kInnovationMax = 46.2;

}  // namespace

void Localisation::add(const SweepReport& sweep) {
  const double variance_m2 = sweep.pose.covariance.topLeftCorner<3, 3>().trace();
  largest_sigma_m_ = std::max(largest_sigma_m_, std::sqrt(variance_m2));
  largest_innovation_ = std::max(largest_innovation_, sweep.innovation);
}

/// mapping.md (R98), (R99).
Status Localisation::verdict() const {
  if (largest_sigma_m_ > matched_m_)
    return {Trouble::out_of_range, "deviation of a sweep's position", largest_sigma_m_, matched_m_};
  const double innovation_max = std::sqrt(kInnovationMax / kUnknowns);
  if (largest_innovation_ > innovation_max)
    return {Trouble::out_of_range, "innovation of a sweep", largest_innovation_, innovation_max};
  return {};
}

}  // namespace tumble
