// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"

/// The structs in placing_params.hpp are parts of OdometryParams::Expert and describe the registration of a sweep to
/// the map.
namespace tumble {

/// MatchingParams contains the parameters for matching a sweep with the map.
struct MatchingParams {
  int neighbours = 12;                    ///< number of nearest neighbours for a plane fit
  double distance_m = 1.0;                ///< maximum distance of matched map points
  std::size_t matches_min = 100;          ///< minimum number of matches; sweeps with fewer are rejected
  std::size_t agreeing_matches_min = 30;  ///< minimum number of matches if the result agrees with the prior
  /// Maximum number of iterations of a registration. The first eight iterations use all points, and further iterations
  /// use a thousand points.
  int iterations_max = 30;
  double correction_max_m = 15.0;   ///< a larger correction of the prior is rejected
  double correction_max_rad = 1.1;  ///< a larger correction of the prior is rejected
  /// Growth rate of a point's standard deviation since the start of the sweep. Late points therefore have less weight.
  double skew_sigma_m_s = 0.25;
  /// A sweep is `degenerate` if the standard deviation of the pose from its surfaces alone exceeds this value in some
  /// direction. Attitude is converted to displacement by the root-mean-square lever arm.
  double degenerate_sigma_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours, {"neighbours", "1", 3, 32, "number of map points used for each plane fit", FieldRank::basic});
    visit(p.distance_m, {"match_distance_m", "m", 1e-3, 10.0,
                         "maximum distance between a point and its matches in the map", FieldRank::basic});
    visit(p.matches_min, {"matches_min", "1", 0, 1e9, "minimum number of matches for an accepted sweep"});
    visit(p.agreeing_matches_min,
          {"matches_agreeing_min", "1", 1, 1e9,
           "if a sweep has fewer matches: minimum number of matches with which a sweep that agrees with the prior is "
           "accepted"});
    visit(p.iterations_max,
          {"iterations_max", "1", 1, 200,
           "maximum number of iterations of a registration; at most eight iterations use all points"});
    visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6,
                               "maximum accepted correction of the prior pose; a larger correction is rejected"});
    visit(p.correction_max_rad, {"correction_max_rad", "rad", 0.0, 3.15,
                                 "maximum accepted correction of the prior pose; a larger correction is rejected"});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
    visit(p.degenerate_sigma_m,
          {"degenerate_sigma_m", "m", 1e-6, 1e3,
           "a sweep counts as degenerate if the surfaces alone determine its pose with a standard deviation above this "
           "value"});
  }
};

/// TrackingParams contains the parameters for sweeps without a registration, and for tracking failure.
struct TrackingParams {
  /// A sweep with too few matches still extends the map, as `degenerate`, up to these standard deviations of its
  /// inertial prediction. Such sweeps occur because a lidar at rest scans only rings, which give no planes until the
  /// lidar rotates. The map excludes points that are too uncertain because of their range and the
  /// uncertain attitude.
  double extend_sigma_max_m = 0.1;
  /// Maximum number of consecutive sweeps with points but without registration. After lost_sweeps_max sweeps,
  /// LidarInertialOdometry continues by inertial prediction and reports `degenerate`.
  int lost_sweeps_max = 30;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.extend_sigma_max_m, {"extend_sigma_max_m", "m", 0.0, 1e3,
                                 "a sweep with too few matches still extends the map if the standard deviation of its "
                                 "prior position is below this value"});
    visit(p.lost_sweeps_max,
          {"lost_sweeps_max", "1", 1, 1e6,
           "number of consecutive unregistered sweeps after which mapping continues with inertial prediction"});
  }
};

/// RelocalisationParams defines the starting poses for a sweep that was not registered from its prior, see
/// docs/maths/mapping.md, sections 5 and 10.
struct RelocalisationParams {
  static constexpr double kShiftMin_m = 0.3, kRotationMin_rad = 0.1;  ///< closer starting poses converge to one pose
  double shift_m = 1.0;       ///< distance of the other starting poses from the prior, first round
  double rotation_rad = 0.3;  ///< rotation of the other starting poses from the prior, first round
  int rounds = 3;             ///< number of rounds; each round adds shift_m and rotation_rad

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.shift_m, {"shift_m", "m", kShiftMin_m, 100.0,
                      "maximum position offset of the initial poses from the prior pose in the first round"});
    visit(p.rotation_rad, {"rotation_rad", "rad", kRotationMin_rad, 3.15,
                           "maximum rotation offset of the initial poses from the prior pose in the first round"});
    visit(p.rounds, {"rounds", "1", 1, 100,
                     "number of rounds of initial poses; each round increases the maximum offsets by the same amount"});
  }
};

}  // namespace tumble
