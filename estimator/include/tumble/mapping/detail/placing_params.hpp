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
  double degenerate_sigma_m = 0.15;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours, {"neighbours", "1", 3, 32, "number of map points used for each plane fit", FieldRank::basic});
    visit(p.distance_m, {"match_distance_m", "m", 1e-3, 10.0,
                         "maximum distance between a point and its matches in the map", FieldRank::basic});
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
    visit(p.degenerate_sigma_m,
          {"degenerate_sigma_m", "m", 1e-6, 1e3,
           "standard deviation of the pose from the sweep's points alone, above which the sweep counts as degenerate"});
  }
};

/// Numbers of iterations with all points, with a subsample, and from starting poses far from the prior (coarse stage).
struct RegistrationStagesParams {
  int full_iterations = 8;  ///< number of iterations with all points, before iterations with a subsample
  std::size_t subsample_points = 1000;
  int coarse_iterations = 15;           ///< number of iterations for a starting pose far from the prior
  std::size_t coarse_points = 300;      ///< number of points in the coarse stage
  std::size_t coarse_matches_min = 50;  ///< minimum number of matches in the coarse stage
  double coarse_kernel_min_m = 0.5;     ///< minimum width of the robust kernel in the coarse stage
  double coarse_rematch_m = 0.2;        ///< motion of a point after which its plane is searched again
  double coarse_step_m = 5e-3;          ///< converged if a step is below coarse_step_m and coarse_step_rad
  double coarse_step_rad = 2e-3;
  double coarse_inlier_ratio_min = 0.2;  ///< minimum fraction of coarse matches within three standard deviations

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.full_iterations, {"full_iterations", "1", 1, 200, "maximum number of iterations with all points"});
    visit(p.subsample_points,
          {"subsample_points", "1", 1, 1e9, "maximum number of points in the iterations after full_iterations"});
    visit(p.coarse_iterations, {"coarse_iterations", "1", 1, 200,
                                "coarse registration from a distant starting pose: maximum number of iterations"});
    visit(p.coarse_points,
          {"coarse_points", "1", 1, 1e9, "coarse registration from a distant starting pose: maximum number of points"});
    visit(p.coarse_matches_min, {"coarse_matches_min", "1", 0, 1e9,
                                 "coarse registration from a distant starting pose: minimum number of matches"});
    visit(p.coarse_kernel_min_m,
          {"coarse_kernel_min_m", "m", 1e-6, 1e3,
           "coarse registration from a distant starting pose: minimum width of the robust kernel"});
    visit(p.coarse_rematch_m, {"coarse_rematch_m", "m", 0.0, 10.0,
                               "coarse registration from a distant starting pose: distance that a point moves before "
                               "its plane is searched again"});
    visit(
        p.coarse_step_m,
        {"coarse_step_m", "m", 1e-12, 1.0,
         "coarse registration from a distant starting pose: position step below which the registration has converged"});
    visit(
        p.coarse_step_rad,
        {"coarse_step_rad", "rad", 1e-12, 1.0,
         "coarse registration from a distant starting pose: rotation step below which the registration has converged"});
    visit(p.coarse_inlier_ratio_min, {"coarse_inlier_ratio_min", "1", 0.0, 1.0,
                                      "coarse registration from a distant starting pose: minimum share of matches "
                                      "within three standard deviations"});
  }
};

struct TrackingParams {
  /// A sweep with too few matches still extends the map, as `degenerate`, up to these standard deviations of its
  /// inertial prediction.
  double extend_sigma_max_m = 0.1;
  double extend_sigma_max_rad = 0.1;
  /// maximum number of consecutive unregistered sweeps; further sweeps are `degenerate`
  int lost_sweeps_max = 30;
  /// Minimum fraction of a sweep's matches within three standard deviations that confirms a relocalisation. The
  /// expected fraction for normal errors is 0.997.
  double confirm_inlier_ratio = 0.9;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.extend_sigma_max_m, {"extend_sigma_max_m", "m", 0.0, 1e3,
                                 "maximum standard deviation of the predicted position with which a sweep with too few "
                                 "matches still extends the map"});
    visit(p.extend_sigma_max_rad, {"extend_sigma_max_rad", "rad", 0.0, 1e3,
                                   "maximum standard deviation of the predicted attitude with which a sweep with too "
                                   "few matches still extends the map"});
    visit(p.lost_sweeps_max,
          {"lost_sweeps_max", "1", 1, 1e6,
           "number of consecutive unregistered sweeps after which mapping continues with inertial prediction"});
    visit(p.confirm_inlier_ratio,
          {"confirm_inlier_ratio", "1", 0.0, 1.0,
           "minimum share of matches within three standard deviations that confirms a relocalisation"});
  }
};

/// Starting poses for a sweep that was not registered from its prior, see docs/maths/mapping.md, heading "Verdicts and
/// relocalisation".
struct RelocalisationParams {
  static constexpr double kShiftMin_m = 0.3, kRotationMin_rad = 0.1;  ///< closer starting poses converge to one pose
  int deficit_tries_max = 5;       ///< number of larger saturation deficits tried per sweep, on all axes together
  double deficit_try_rad_s = 3.0;  ///< smallest tried saturation deficit; two, three and five times this value follow
  int starts_per_sweep = 3;        ///< number of starting poses after tracking failure, including the prior
  double shift_m = 1.0;            ///< distance of the other starting poses from the prior, first round
  double rotation_rad = 0.3;       ///< rotation of the other starting poses from the prior, first round
  int rounds = 3;                  ///< number of rounds; each round adds shift_m and rotation_rad

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.deficit_tries_max,
          {"deficit_tries_max", "1", 0, 12,
           "number of larger initial saturation deficits with which one sweep is registered again"});
    visit(p.deficit_try_rad_s, {"deficit_try_rad_s", "rad/s", 1e-3, 1e3,
                                "smallest increase of the initial saturation deficit; later attempts use two, three "
                                "and five times this value"});
    visit(p.starts_per_sweep,
          {"starts_per_sweep", "1", 1, 100,
           "number of starting poses per sweep after a tracking failure, including the predicted pose"});
    visit(p.shift_m, {"shift_m", "m", kShiftMin_m, 100.0,
                      "maximum distance of a starting pose from the predicted pose in the first round"});
    visit(p.rotation_rad, {"rotation_rad", "rad", kRotationMin_rad, 3.15,
                           "maximum rotation of a starting pose from the predicted pose in the first round"});
    visit(p.rounds, {"rounds", "1", 1, 100,
                     "number of rounds of starting poses; each round adds shift_m and rotation_rad to the offsets"});
  }
};

}  // namespace tumble
