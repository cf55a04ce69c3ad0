// SPDX-License-Identifier: BSD-3-Clause
// RateIteration is the Gauss-Newton optimisation of RateSmoother over a recording.
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble {

class RateIteration {
 public:
  explicit RateIteration(std::span<const RateObservation> observations)
      : observations_(observations), blocks_(observations.size()) {}

  /// Returns false if the normal equations are not positive definite.
  bool factorise(const RateModel& model, std::span<const RateEstimate> estimates, const RigConstants& rig);
  /// Adds the solution step, limited to step_max. Returns the largest change of a rate.
  double apply(const RateModel& model, double step_max, std::span<RateEstimate> estimates, RigConstants& rig) const;

  /// Calls use(k, conditional) for the last factorisation, from the last sample to the first sample.
  template <typename Use>
  void for_each_conditional(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      conditional = arrow::back_conditional(blocks_[k], k + 1 == blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  /// SensorErrorDerivatives contains the derivative of all unknowns by the sensor errors. SensorErrorDerivatives also
  /// contains the information of the readings about the sensor errors, after all unknowns are optimised. The
  /// derivatives refer to the last factorisation, with its `estimates` and `rig`, before apply().
  struct SensorErrorDerivatives {
    std::vector<arrow::ErrorMatrix> of_sample;
    arrow::BorderErrors calibration_by_errors;
    SensorErrorEvidence evidence;
  };
  SensorErrorDerivatives error_derivatives(const RateModel& model, std::span<const RateEstimate> estimates,
                                           const RigConstants& rig) const;

  const RigConstants::Matrix& rig_covariance() const { return rig_covariance_; }
  /// Returns twice the predicted decrease of the cost, for the last factorisation. The result is also the square of the
  /// largest change of any combination of unknowns, in standard deviations.
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

/// Runs the optimisation. If most clipped samples are classified as contact, solve() repeats the optimisation with
/// larger and smaller contact thresholds. The repetition is needed because with a wrong lever arm, the first
/// optimisation may end in a minimum without flight. Returns false if the normal equations are not positive definite.
/// The function sets iterations, restarts, convergence and Mahalanobis distance in `health`.
bool solve(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
           RateSolution& solution, RateReport& health);

}  // namespace tumble
