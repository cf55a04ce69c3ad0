// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/executor.hpp"
#include "tumble/mapping/plane_fit.hpp"

namespace tumble {

/// Parameters of RegistrationParams that few users change. Field names equal those in tables and on command lines.
struct RegistrationExpertParams {
  double step_m = 5e-4;  ///< the iteration has converged if a step is below this and below step_rad
  double step_rad = 1e-4;
  double step_s = 1e-5;       ///< same for the time offset
  double rematch_m = 0.05;    ///< motion of a point after which its plane is searched again
  double kernel_min_m = 0.1;  ///< minimum width of the robust kernel (Geman-McClure)
  /// Weight of each point's information. Neighbouring returns share the map's errors and are therefore correlated.
  double correlation_discount = 0.1;
  double cluster_m = 1.0;          ///< points within one cube of this edge are correlated
  double matched_share_min = 0.1;  ///< fraction of the points
  /// A registration with fewer matches than matches_min and matched_share_min is accepted if it has this many matches
  /// and agrees with the prior. The default disables this rule.
  std::size_t agreeing_min = 1'000'000'000;
  /// Minimum fraction of matches within three standard deviations; below it the result is rejected.
  double fitting_share_min = 0.6;
  PlaneBounds plane;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.step_m, {"step_m", "m", 1e-12, 1.0, "converged when a step is below this and its turn below step_rad"});
    visit(p.step_rad, {"step_rad", "rad", 1e-12, 1.0, "converged when a step turns by less"});
    visit(p.step_s, {"step_s", "s", 1e-12, 1.0, "and moves the time offset by less"});
    visit(p.rematch_m,
          {"rematch_m", "m", 0.0, 10.0, "a point's plane is searched anew once the point has moved by this"});
    visit(p.kernel_min_m, {"kernel_min_m", "m", 1e-6, 1e3, "least width of the robust kernel (Geman-McClure)"});
    visit(p.correlation_discount, {"correlation_discount", "1", 1e-6, 1.0,
                                   "weight of a point's information: neighbouring returns are not independent"});
    visit(p.cluster_m, {"cluster_m", "m", 0.01, 100.0, "points of one cube of this edge are not independent"});
    visit(p.matched_share_min, {"matched_share_min", "1", 0.0, 1.0, "fewer of the points matched refuse the result"});
    visit(p.agreeing_min,
          {"agreeing_min", "1", 1, 1e9, "so many matches are enough for a result where the prior expects it"});
    visit(p.fitting_share_min, {"fitting_share_min", "1", 0.0, 1.0,
                                "fewer of the matches within three standard deviations refuse the result"});
    visit.group("plane_", p.plane);
  }
};

/// Parameters of Registration.
struct RegistrationParams {
  static constexpr double kMatchDistanceMax_m = 10.0;
  int neighbours = 8;             ///< k of the plane fit
  double match_distance_m = 1.0;  ///< farther map points are not matched
  int iterations_max = 30;
  double range_sigma_m = 0.02;  ///< minimum range noise; the noise grows with range by range_sigma_share
  double range_sigma_share = 0.0015;
  double skew_sigma_m_s = 0.25;   ///< growth of a point's uncertainty over the sweep (time weighting); 0: none
  std::size_t matches_min = 100;  ///< minimum number of matches
  double correction_max_m = 15.0;
  double correction_max_rad = 1.1;
  ParallelFor parallel_for;  ///< threads for neighbour search and sums; empty: the calling thread

  using Expert = RegistrationExpertParams;
  Expert expert = {};  ///< parameters that few users change

  /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours, {"neighbours", "1", 3, 32, "map points per plane fit", Rank::first});
    visit(p.match_distance_m,
          {"match_distance_m", "m", 1e-3, kMatchDistanceMax_m, "farther map points are no match", Rank::first});
    visit(p.iterations_max, {"iterations_max", "1", 1, 200, "most iterations"});
    visit(p.range_sigma_m, {"range_sigma_m", "m", 1e-6, 10.0, "of a return, at least"});
    visit(p.range_sigma_share, {"range_sigma_share", "1", 0.0, 1.0, "of a return, as a share of its range"});
    visit(p.skew_sigma_m_s, {"skew_sigma_m_s", "m/s", 0.0, 1e3,
                             "growth of a point's uncertainty over the sweep (time weighting); 0: none"});
    visit(p.matches_min, {"matches_min", "1", 0, 1e9, "fewer matches are too few"});
    visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6, "a larger correction of the prior is refused"});
    visit(p.correction_max_rad,
          {"correction_max_rad", "rad", 0.0, 3.15, "a larger correction of the prior is refused"});
    visit.group("", p.expert);
  }
};

}  // namespace tumble
