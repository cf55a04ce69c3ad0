// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/executor.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"

namespace tumble {

/// Values that the calling estimator sets; they are not parameters for users.
struct RegistrationExpertParams {
  int iterations_max = 30;
  std::size_t matches_min = 100;
  double correction_max_m = 15.0;  ///< a larger correction of the predicted pose is rejected
  double correction_max_rad = 1.1;
  double step_m = 5e-4;  ///< converged if a step is below `step_m` and `step_rad`
  double step_rad = 1e-4;
  double step_s = 1e-5;
  double rematch_m = 0.05;    ///< the plane of a point is searched again after a motion of the point by this distance
  double kernel_min_m = 0.1;  ///< minimum width of the robust kernel (Geman-McClure)
  /// weight of the information of one point; below 1, because errors of neighbouring returns are correlated
  double correlation_discount = 0.1;
  /// Minimum number of matches for a registration that agrees with the prior. Other registrations need `matches_min`
  /// matches, and matches for a tenth of the points. The large default disables this exception.
  std::size_t agreeing_matches_needed = 1'000'000'000;
  /// minimum fraction of matched points within three standard deviations of their plane
  double inlier_ratio_min = 0.6;
  PlaneFitBounds plane;
};

struct RegistrationParams {
  static constexpr double kMatchDistanceMax_m = 10.0;
  int neighbours = 8;
  double match_distance_m = 1.0;
  static constexpr double kRangeSigma_m =
      0.02;  ///< the standard deviation of a range is max(kRangeSigma_m, kRangeSigmaRatio * range)
  static constexpr double kRangeSigmaRatio = 0.0015;
  double skew_sigma_m_s =
      0.25;  ///< growth rate of a point's standard deviation during the sweep, for errors of the deskewing
  ParallelFor parallel_for;  ///< runs neighbour search and sums on threads of the caller; empty: on the calling thread

  using Expert = RegistrationExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours,
          {"neighbours", "1", 3, 32, "number of map points used for each plane fit", ParameterAudience::common_use});
    visit(p.match_distance_m,
          {"match_distance_m", "m", 1e-3, kMatchDistanceMax_m,
           "maximum distance between a point and its matches in the map", ParameterAudience::common_use});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
  }
};

}  // namespace tumble
