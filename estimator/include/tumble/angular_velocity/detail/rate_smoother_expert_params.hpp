// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct RateOptimisationParams {
  int iterations_max = 25;
  double tolerance_rad_s = 2e-3;
  static constexpr double kStepMax_rad_s = 10.0;
  static constexpr double kInitialThresholdFactor =
      8.0;  ///< factor on FlightRateParams::kThreshold in the first iteration; halved in each iteration
  /// number of additional iterations that approximate lower bounds by truncated normal distributions, for correct
  /// covariances in contact
  int bound_iterations = 3;
  static constexpr double kBoundDamping = 0.5;  ///< weight of the new lower bound in each additional iteration

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.iterations_max, {"iterations_max", "1", 1, 1000, "maximum number of iterations of one optimisation"});
    visit(p.tolerance_rad_s, {"tolerance_rad_s", "rad/s", 1e-12, 1.0,
                              "largest change of a rate in one iteration, below which the optimisation stops"});
    visit(p.bound_iterations, {"bound_iterations", "1", 0, 1000,
                               "number of iterations after convergence in which clipped rates in contact have "
                               "truncated normal distributions"});
  }
};

struct AngularRateSmootherExpertParams {
  SaturationPlaneFinder::Params gyro_planes = {};  ///< a missing range is taken from AngularRateSmootherParams
  SaturationPlaneFinder::Params accel_saturation_planes = SaturationPlaneFinder::Params::defaults_for_accelerometer();
  RestDetector::Params rest_detector = {};
  RateOptimisationParams optimisation = {};
  /// maximum number of optimisations with readings corrected for sensor errors; 1: no correction
  int error_rounds_max = 3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("planes_", p.gyro_planes);
    visit.group("accel_planes_", p.accel_saturation_planes);
    visit.group("rests_", p.rest_detector);
    visit.group("", p.optimisation);
    visit(p.error_rounds_max, {"error_rounds_max", "1", 1, 10,
                               "maximum number of optimisations, each with the sensor errors estimated by the previous "
                               "one; 1: no correction of sensor errors"});
  }
};

}  // namespace tumble
