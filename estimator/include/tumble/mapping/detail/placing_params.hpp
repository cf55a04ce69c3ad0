// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"

namespace tumble {

struct MatchingParams {
  int neighbours = 12;                    ///< number of nearest neighbours for a plane fit
  double distance_m = 1.0;                ///< maximum distance of matched map points
  std::size_t matches_min = 100;          ///< minimum number of matches; sweeps with fewer are rejected
  std::size_t agreeing_matches_min = 30;  ///< minimum number of matches if the result agrees with the prior
  /// see RegistrationStagesParams
  int iterations_max = 30;
  double correction_max_m = 15.0;   ///< a larger correction of the prior is rejected
  double correction_max_rad = 1.1;  ///< a larger correction of the prior is rejected
  /// growth rate of a point's standard deviation since the start of the sweep
  double skew_sigma_m_s = 0.25;
  /// standard deviation of the pose from the sweep's points alone, above which a sweep is `degenerate`
  static constexpr double kDegenerateSigma_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours,
          {"neighbours", "1", 3, 32, "number of map points used for each plane fit", ParameterRank::common_use});
    visit(p.distance_m, {"match_distance_m", "m", 1e-3, 10.0,
                         "maximum distance between a point and its matches in the map", ParameterRank::common_use});
    visit(p.matches_min, {"matches_min", "1", 0, 1e9, "minimum number of matches for an accepted sweep"});
    visit(p.agreeing_matches_min,
          {"matches_agreeing_min", "1", 1, 1e9,
           "minimum number of matches of an accepted sweep whose registration agrees with the predicted pose; applies "
           "below matches_min"});
    visit(p.iterations_max,
          {"iterations_max", "1", 1, 200,
           "maximum number of iterations of a registration; at most full_iterations of them use all points"});
    visit(p.correction_max_m,
          {"correction_max_m", "m", 0.0, 1e6,
           "maximum correction of the predicted pose; a registration with a larger correction is rejected"});
    visit(p.correction_max_rad,
          {"correction_max_rad", "rad", 0.0, 3.15,
           "maximum correction of the predicted pose; a registration with a larger correction is rejected"});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
  }
};

/// TrackingParams contains the parameters for sweeps without a registration, and for tracking failure.
struct TrackingParams {
  /// A sweep with too few matches still extends the map, as `degenerate`, up to these standard deviations of its
  /// inertial prediction. Such sweeps occur because a lidar at rest scans only rings, which give no planes until the
  /// lidar rotates. The map excludes points that are too uncertain because of their range and the
  /// uncertain attitude.
  double extend_sigma_max_m = 0.1;
  /// Maximum number of consecutive sweeps with points but without registration. After kLostSweepsMax sweeps,
  /// LidarInertialOdometry continues by inertial prediction and reports `degenerate`.
  static constexpr int kLostSweepsMax = 30;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.extend_sigma_max_m, {"extend_sigma_max_m", "m", 0.0, 1e3,
                                 "a sweep with too few matches still extends the map if the standard deviation of its "
                                 "prior position is below this value"});
  }
};

}  // namespace tumble
