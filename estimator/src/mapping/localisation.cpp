// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/imu.hpp"
#include "tumble/mapping/detail/sweep_unknowns.hpp"

namespace tumble {

namespace {

// A chi-square value (nine degrees of freedom) exceeds 32.9 with a probability of 1.4e-4. In 1000 sweeps with correct
// covariances, two or more values exceed 32.9 with a probability of 1 %.
constexpr double kContradictionChi2Min = 32.9;

double innovation_max() {
  return std::sqrt(kContradictionChi2Min / SweepUnknowns::kMotionSize);
}

}  // namespace

void Localisation::add(const SweepReport& sweep) {
  map_started_ = map_started_ || sweep.verdict != SweepVerdict::rejected;
  if (!map_started_) return;
  const double variance_m2 = sweep.pose.covariance.topLeftCorner<3, 3>().trace();
  largest_sigma_m_ = std::max(largest_sigma_m_, std::sqrt(variance_m2));
  second_largest_innovation_ = std::max(second_largest_innovation_, std::min(largest_innovation_, sweep.innovation));
  largest_innovation_ = std::max(largest_innovation_, sweep.innovation);
  sigma_m_ = sweep.map_sigma_m;
  newest_ns_ = sweep.pose.time_ns;
  if (!(sigma_m_ > matched_m_))
    lost_since_ns_.reset();
  else if (!lost_since_ns_)
    lost_since_ns_ = newest_ns_;
  if (!(sweep.innovation > innovation_max())) return;
  previous_contradicted_ns_ = last_contradicted_ns_;
  last_contradicted_ns_ = newest_ns_;
}

Status Localisation::current_verdict() const {
  if (sigma_m_ > matched_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of the position in the map", sigma_m_, matched_m_};
  if (!previous_contradicted_ns_ ||
      check_stamp_order(newest_ns_, *previous_contradicted_ns_, kMemory_s).error_code == ErrorCode::gap)
    return {};
  return {ErrorCode::out_of_range,
          "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
          second_largest_innovation_, innovation_max()};
}

/// See mapping.md (R70), (R71).
Status Localisation::verdict() const {
  if (largest_sigma_m_ > matched_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of a sweep's position", largest_sigma_m_, matched_m_};
  if (second_largest_innovation_ > innovation_max())
    return {ErrorCode::out_of_range,
            "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
            second_largest_innovation_, innovation_max()};
  return {};
}

}  // namespace tumble
