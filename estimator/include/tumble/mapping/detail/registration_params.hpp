// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/executor.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"

namespace tumble {

/// Parameters that the callers of Registration set, but not the users of a method.
struct RegistrationExpertParams {
  int iterations_max = 30;
  std::size_t matches_min = 100;   ///< minimum number of matches
  double correction_max_m = 15.0;  ///< a registration with a larger correction of the prior is rejected
  double correction_max_rad = 1.1;
  double step_m = 5e-4;  ///< converged if a step is below `step_m` and `step_rad`
  double step_rad = 1e-4;
  double step_s = 1e-5;       ///< convergence limit for a step of the time offset
  double rematch_m = 0.05;    ///< motion of a point after which its plane is searched again
  double kernel_min_m = 0.1;  ///< minimum width of the robust kernel (Geman-McClure)
  /// weight of the information of one point; below 1 because neighbouring returns are correlated
  double correlation_discount = 0.1;
  /// Minimum number of matches for accepting a registration that agrees with the prior but has fewer than
  /// `matches_min` matches or matches for less than a tenth of its points. The large default of agreeing_matches_needed
  /// disables the exception for agreeing registrations.
  std::size_t agreeing_matches_needed = 1'000'000'000;
  /// minimum fraction of matches within three standard deviations
  double inlier_ratio_min = 0.6;
  PlaneFitBounds plane;
};

struct RegistrationParams {
  static constexpr double kMatchDistanceMax_m = 10.0;
  int neighbours = 8;             ///< number of nearest neighbours for a plane fit
  double match_distance_m = 1.0;  ///< maximum distance of matched map points
  static constexpr double kRangeSigma_m =
      0.02;  ///< standard deviation of the range: max(kRangeSigma_m, kRangeSigmaRatio * range)
  static constexpr double kRangeSigmaRatio = 0.0015;
  double skew_sigma_m_s = 0.25;  ///< growth rate of a point's standard deviation during the sweep; 0: none
  ParallelFor parallel_for;      ///< threads for neighbour search and sums; empty: the calling thread

  using Expert = RegistrationExpertParams;
  Expert expert = {};  ///< rarely changed parameters

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours,
          {"neighbours", "1", 3, 32, "number of map points used for each plane fit", ParameterRank::common_use});
    visit(p.match_distance_m,
          {"match_distance_m", "m", 1e-3, kMatchDistanceMax_m,
           "maximum distance between a point and its matches in the map", ParameterRank::common_use});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
  }
};

}  // namespace tumble
