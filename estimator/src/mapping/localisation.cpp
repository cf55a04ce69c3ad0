// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/sweep_unknowns.hpp"

namespace tumble {

namespace {

// If the covariances are correct, the chi-square value of the innovation (9 degrees of freedom) exceeds 32.9 at least
// twice in 1000 sweeps with a probability of 1 %.
constexpr double kContradictionChi2Min = 32.9;

// Wrong point times or a wrong lidar mounting distort sweeps. Few points of a distorted sweep fit the map, and the
// registered poses are noisy. If point times and mounting are correct, the mean inlier ratio of the simulated runs is
// at least 0.37.
constexpr double kInlierRatioMin = 0.2, kMeanInnovationMax = 0.2;
constexpr std::size_t kMeanSweepsMin = 20, kMeanSweepsMax = 50;

double innovation_max() {
  return std::sqrt(kContradictionChi2Min / RegistrationUnknowns::kMotionSize);
}

Status misfit(double inlier_ratio) {
  return {ErrorCode::out_of_range, "mean fraction of points on the map, in sweeps with a large innovation",
          inlier_ratio, kInlierRatioMin};
}

}  // namespace

void Localisation::add(const SweepResult& sweep) {
  map_started_ = map_started_ || sweep.verdict != SweepVerdict::rejected;
  if (!map_started_) return;
  const double variance_m2 = sweep.pose.covariance.topLeftCorner<3, 3>().trace();
  largest_sigma_m_ = std::max(largest_sigma_m_, std::sqrt(variance_m2));
  second_largest_innovation_ =
      std::max(second_largest_innovation_, std::min(largest_innovation_, sweep.normalised_innovation));
  largest_innovation_ = std::max(largest_innovation_, sweep.normalised_innovation);
  observe_fit(sweep);
  sigma_m_ = sweep.position_in_map_sigma_m;
  newest_ns_ = sweep.pose.time_ns;
  if (!(sigma_m_ > distance_when_localised_m_))
    lost_since_ns_.reset();
  else if (!lost_since_ns_)
    lost_since_ns_ = newest_ns_;
  if (!(sweep.normalised_innovation > innovation_max())) return;
  previous_contradicted_sweep_ns_ = last_contradicted_sweep_ns_;
  last_contradicted_sweep_ns_ = newest_ns_;
}

void Localisation::observe_fit(const SweepResult& sweep) {
  if (!(sweep.normalised_innovation > 0.0)) return;
  aligned_sweeps_ = std::min(aligned_sweeps_ + 1, kMeanSweepsMax);
  const double share = 1.0 / static_cast<double>(aligned_sweeps_);
  mean_inlier_ratio_ += share * (sweep.inlier_ratio - mean_inlier_ratio_);
  mean_innovation_ += share * (std::min(1.0, sweep.normalised_innovation) - mean_innovation_);
  if (!fit_verdict().ok()) smallest_inlier_ratio_ = std::min(smallest_inlier_ratio_, mean_inlier_ratio_);
}

Status Localisation::fit_verdict() const {
  const bool fits = mean_inlier_ratio_ >= kInlierRatioMin || mean_innovation_ <= kMeanInnovationMax;
  return aligned_sweeps_ < kMeanSweepsMin || fits ? Status{} : misfit(mean_inlier_ratio_);
}

Status Localisation::current_verdict() const {
  if (sigma_m_ > distance_when_localised_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of the position in the map", sigma_m_,
            distance_when_localised_m_};
  if (!previous_contradicted_sweep_ns_ ||
      check_stamp_order(newest_ns_, *previous_contradicted_sweep_ns_, kForgettingTime_s).error_code == ErrorCode::gap)
    return fit_verdict();
  return {ErrorCode::out_of_range,
          "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
          second_largest_innovation_, innovation_max()};
}

/// See mapping.md (R70), (R71).
Status Localisation::verdict() const {
  if (largest_sigma_m_ > distance_when_localised_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of a sweep's position", largest_sigma_m_,
            distance_when_localised_m_};
  if (second_largest_innovation_ > innovation_max())
    return {ErrorCode::out_of_range,
            "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
            second_largest_innovation_, innovation_max()};
  return smallest_inlier_ratio_ < kInlierRatioMin ? misfit(smallest_inlier_ratio_) : Status{};
}

}  // namespace tumble
