// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

namespace tumble {

class RateIteration {
 public:
  explicit RateIteration(std::span<const RateObservation> observations)
      : observations_(observations), blocks_(observations.size()) {}

  /// Returns false if the normal equations are not positive definite.
  bool factorise(const RateModel& model, std::span<const RateEstimate> estimates, const RigConstants& rig);
  /// Adds the last step, scaled so that no angular rate changes by more than step_max. Returns the largest change of an
  /// angular rate in the unscaled step.
  double apply(const RateModel& model, double step_max, std::span<RateEstimate> estimates, RigConstants& rig) const;

  /// Calls use(k, conditional) for each sample k from last to first, with the distribution of its rate and angular
  /// acceleration for known calibration constants.
  template <typename Use>
  void for_each_conditional(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      conditional = arrow::back_conditional(blocks_[k], k + 1 == blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  /// `evidence` is the information about the sensor errors after elimination of all other unknowns.
  struct SensorErrorDerivatives {
    std::vector<arrow::ErrorMatrix> of_sample;
    arrow::BorderErrors calibration_by_errors;
    SensorErrorEvidence evidence;
  };
  SensorErrorDerivatives error_derivatives(const RateModel& model, std::span<const RateEstimate> estimates,
                                           const RigConstants& rig) const;

  const RigConstants::Matrix& rig_covariance() const { return rig_covariance_; }
  /// Returns the squared length of the step, in standard deviations of the estimate: rate_smoother.md (R30).
  double newton_decrement() const;

 private:
  std::span<const RateObservation> observations_;
  std::vector<arrow::Block> blocks_;
  arrow::Corner corner_;
  arrow::BorderVector rig_step_;
  RigConstants::Matrix rig_covariance_;
};

struct RateSolution {
  std::vector<RateEstimate> estimates;
  RigConstants rig;
  RigConstants::Matrix rig_covariance;
  RateIteration iteration;
};

/// Returns false if the normal equations are not positive definite. If most clipped samples are classified as contact,
/// solve() repeats the optimisation with other contact thresholds, because a wrong initial lever arm may lead to a
/// local minimum.
bool solve(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
           RateSolution& solution, RateReport& health);

}  // namespace tumble
