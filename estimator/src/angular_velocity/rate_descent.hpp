// SPDX-License-Identifier: BSD-3-Clause
// RateIteration is the Gauss-Newton optimisation of RateSmoother over a recording.
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
  /// Adds the step of the last factorisation to the estimates. No angular rate changes by more than step_max. Returns
  /// the largest change of an angular rate before the limitation to step_max.
  double apply(const RateModel& model, double step_max, std::span<RateEstimate> estimates, RigConstants& rig) const;

  /// Calls use(k, conditional) for each sample k, from the last to the first. `conditional` is the conditional
  /// distribution of the unknowns of sample k.
  template <typename Use>
  void for_each_conditional(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      conditional = arrow::back_conditional(blocks_[k], k + 1 == blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  /// SensorErrorDerivatives contains the derivatives of all unknowns with respect to the sensor errors. `evidence` is
  /// the information about the sensor errors after elimination of all other unknowns. Derivatives and evidence belong
  /// to the last factorisation, with its `estimates` and `rig`, before apply().
  struct SensorErrorDerivatives {
    std::vector<arrow::ErrorMatrix> of_sample;
    arrow::BorderErrors calibration_by_errors;
    SensorErrorEvidence evidence;
  };
  SensorErrorDerivatives error_derivatives(const RateModel& model, std::span<const RateEstimate> estimates,
                                           const RigConstants& rig) const;

  const RigConstants::Matrix& rig_covariance() const { return rig_covariance_; }
  /// Returns twice the decrease of the cost that the last factorisation predicts. The Newton decrement is also the
  /// largest squared change of a linear combination of unknowns, divided by the variance of the combination.
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

/// Optimises all rates and the calibration. A wrong initial lever arm may lead to a local minimum in which no sample is
/// in flight. If most clipped samples are classified as contact, solve() therefore repeats the optimisation with other
/// contact thresholds. Returns false if the normal equations are not positive definite. `health` receives iterations,
/// restarts, convergence and the Mahalanobis distance of the calibration.
bool solve(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
           RateSolution& solution, RateReport& health);

}  // namespace tumble
