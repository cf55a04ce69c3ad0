// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "tumble/common/parameters.hpp"

/// Groups of LidarInertialOdometry::Params::Expert: registration of a sweep to the map.
namespace tumble {

/// Matching of a sweep with the map.
struct MatchingParams {
  int neighbours = 12;              ///< k of the plane fit
  double distance_m = 1.0;          ///< farther map points are not matched
  std::size_t least = 100;          ///< minimum number of matched points; fewer reject the sweep
  std::size_t agreeing_least = 30;  ///< minimum number if the result agrees with the prior
  /// Maximum iterations of a registration. With all points there are at most eight; then it continues with a thousand
  /// points until convergence.
  int iterations_max = 30;
  double correction_max_m = 15.0;   ///< a larger correction of the prior is rejected
  double correction_max_rad = 1.1;  ///< a larger correction of the prior is rejected
  /// Growth of a point's uncertainty over the sweep, which reduces its weight (the published time weighting).
  double skew_sigma_m_s = 0.25;
  /// A sweep is `degenerate` if its surfaces alone leave a larger standard deviation in some direction. Attitude counts
  /// at the rms lever.
  double degenerate_sigma_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours, {"neighbours", "1", 3, 32, "map points per plane fit", Rank::first});
    visit(p.distance_m, {"match_distance_m", "m", 1e-3, 10.0, "farther map points are no match", Rank::first});
    visit(p.least, {"matches_min", "1", 0, 1e9, "fewer matches are too few"});
    visit(p.agreeing_least, {"matches_agreeing_min", "1", 1, 1e9, "unless so many put it where the prior expects it"});
    visit(p.iterations_max,
          {"iterations_max", "1", 1, 200, "most iterations of a registration; one with all points has at most eight"});
    visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6, "a larger correction of the prior is refused"});
    visit(p.correction_max_rad,
          {"correction_max_rad", "rad", 0.0, 3.15, "a larger correction of the prior is refused"});
    visit(p.skew_sigma_m_s, {"skew_sigma_m_s", "m/s", 0.0, 1e3,
                             "growth of a point's uncertainty over the sweep (time weighting); 0: none"});
    visit(p.degenerate_sigma_m, {"degenerate_sigma_m", "m", 1e-6, 1e3,
                                 "a sweep that its surfaces hold less surely in some direction is degenerate"});
  }
};

/// Stages of a registration: with all points and few iterations; with a subsample until convergence; coarse.
struct RegistrationStagesParams {
  int full_iterations = 8;              ///< with all points; without convergence, a subsample continues at lower cost
  std::size_t subsample_points = 1000;  ///< sufficient to decide whether a start converges
  int coarse_iterations = 15;           ///< for a start that may be far off
  std::size_t coarse_points = 300;      ///< points of a coarse start
  std::size_t coarse_matches_min = 50;  ///< minimum number of matches of a coarse start
  double coarse_kernel_min_m = 0.5;     ///< minimum width of its robust kernel
  double coarse_rematch_m = 0.2;        ///< motion of a point after which its plane is searched again
  double coarse_step_m = 5e-3;          ///< convergence bound of a step, together with coarse_step_rad
  double coarse_step_rad = 2e-3;
  double coarse_fitting_share_min = 0.2;  ///< minimum fraction of its matches within three standard deviations

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.full_iterations, {"full_iterations", "1", 1, 200, "most iterations with all points"});
    visit(p.subsample_points,
          {"subsample_points", "1", 1, 1e9, "most points of a registration that runs to its convergence"});
    visit(p.coarse_iterations, {"coarse_iterations", "1", 1, 200, "most iterations from a start that may be far off"});
    visit(p.coarse_points, {"coarse_points", "1", 1, 1e9, "most points from such a start"});
    visit(p.coarse_matches_min, {"coarse_matches_min", "1", 0, 1e9, "fewer matches reject such a start"});
    visit(p.coarse_kernel_min_m,
          {"coarse_kernel_min_m", "m", 1e-6, 1e3, "least width of the robust kernel from such a start"});
    visit(p.coarse_rematch_m, {"coarse_rematch_m", "m", 0.0, 10.0,
                               "from such a start a point's plane is searched anew once it has moved by this"});
    visit(p.coarse_step_m, {"coarse_step_m", "m", 1e-12, 1.0, "such a start has converged when a step is below this"});
    visit(p.coarse_step_rad, {"coarse_step_rad", "rad", 1e-12, 1.0, "and turns by less than this"});
    visit(p.coarse_fitting_share_min, {"coarse_fitting_share_min", "1", 0.0, 1.0,
                                       "fewer of the matches within three standard deviations reject such a start"});
  }
};

/// Handling of sweeps without a registration and of tracking failure.
struct TrackingParams {
  /// A sweep with too few matches still extends the map, as `degenerate`, while the inertial prior has smaller standard
  /// deviations than these. Reason: a lidar at rest scans only rings, which give no planes until it rotates.
  /// LocalMapParams::sigma_max_m excludes points that are too uncertain at their range due to the attitude.
  double trusted_m = 0.1;
  double trusted_rad = 0.1;
  /// Maximum number of consecutive sweeps with points but without registration. Then the mapper continues `degenerate`
  /// by inertial prediction.
  int lost_sweeps_max = 30;
  /// Minimum fraction of a sweep's matches within three standard deviations (0.997 for normal errors) that confirms a
  /// relocalisation. A smaller fraction contradicts it.
  double borne_out_share = 0.9;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.trusted_m, {"trusted_prior_m", "m", 0.0, 1e3,
                        "a sweep with too few matches extends the map while the prior is this certain"});
    visit(p.trusted_rad, {"trusted_prior_rad", "rad", 0.0, 1e3, "and this certain of the attitude"});
    visit(p.lost_sweeps_max, {"lost_sweeps_max", "1", 1, 1e6,
                              "sweeps in a row without a place in the map, after which it goes on by inertia"});
    visit(p.borne_out_share, {"borne_out_share", "1", 0.0, 1.0,
                              "of a sweep's matches within three deviations, that bear out a place found again"});
  }
};

/// Starting poses for a sweep that was not registered from its prior: docs/maths/mapping.md, sections 5 and 10.
struct RelocalizationParams {
  static constexpr double kLeastShift_m = 0.3, kLeastRotation_rad = 0.1;  ///< closer starts converge to the same pose
  int deficit_tries_max = 5;       ///< number of larger saturation deficits tried per sweep, on all axes together
  double deficit_try_rad_s = 3.0;  ///< the first of them; two, three and five times this value follow
  int starts_per_sweep = 3;        ///< starts after tracking failure, including the prior
  double shift_m = 1.0;            ///< initial distance of these starts from the prior
  double rotation_rad = 0.3;       ///< initial rotation of these starts from the prior
  int rounds = 3;                  ///< number of rounds; each extends the distances by the initial value

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.deficit_tries_max, {"deficit_tries_max", "1", 0, 12, "larger saturation deficits tried for one sweep"});
    visit(p.deficit_try_rad_s, {"deficit_try_rad_s", "rad/s", 1e-3, 1e3,
                                "by how much the first of them is larger; two, three and five times it follow"});
    visit(p.starts_per_sweep, {"starts_per_sweep", "1", 1, 100, "starts of a lost sensor, the prior among them"});
    visit(p.shift_m, {"shift_m", "m", kLeastShift_m, 100.0, "reach of such starts, first round"});
    visit(p.rotation_rad,
          {"rotation_rad", "rad", kLeastRotation_rad, 3.15, "reach of such starts in attitude, first round"});
    visit(p.rounds, {"rounds", "1", 1, 100, "of starts, each of which reaches that much further than the last"});
  }
};

}  // namespace tumble
