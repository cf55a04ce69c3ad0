// SPDX-License-Identifier: BSD-3-Clause
// The descent of RateSmoother: Gauss-Newton over a recording whose readings are given.
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"

namespace tumble {

/// The linear system of one iteration and its solution.
class RateIteration {
 public:
  explicit RateIteration(std::span<const RateObservation> observations)
      : observations_(observations), blocks_(observations.size()) {}

  /// False when it is not positive definite.
  bool factorise(const RateModel& model, std::span<const RateEstimate> estimates, const RigConstants& rig);
  /// Adds the step, cut to step_max; returns the largest change of a rate.
  double apply(const RateModel& model, double step_max, std::span<RateEstimate> estimates, RigConstants& rig) const;

  /// Of the last factorisation, from the last sample to the first: use(k, conditional).
  template <typename Use>
  void for_each_conditional(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      conditional = arrow::back_conditional(blocks_[k], k + 1 == blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  /// Of the last factorisation, how far all unknowns move with each of the device's errors, and what the readings say
  /// of those once all else follows them. `estimates` and `rig`: those of the factorisation, before apply().
  struct Moved {
    std::vector<arrow::ErrorMatrix> of_sample;
    arrow::BorderErrors of_rig;
    SensorErrorEvidence evidence;
  };
  Moved moved_by_errors(const RateModel& model, std::span<const RateEstimate> estimates, const RigConstants& rig) const;

  const RigConstants::Matrix& rig_covariance() const { return rig_covariance_; }
  /// Of the last factorisation: twice the decrease of the cost that the step promises, and the square of the most
  /// deviations by which it moves any combination of the unknowns.
  double decrement() const;

 private:
  std::span<const RateObservation> observations_;
  std::vector<arrow::Block> blocks_;
  arrow::Corner corner_;
  arrow::BorderVector rig_step_;
  RigConstants::Matrix rig_covariance_;
};

/// Where a descent ends.
struct RateSolution {
  std::vector<RateEstimate> estimates;
  RigConstants rig;
  RigConstants::Matrix rig_covariance;
  RateIteration iteration;
};

/// The descent, again from wider and narrower thresholds of contact where most clipped samples pass for contact: with
/// a lever arm that is far off the first may end in a minimum in which nothing is flight. False when a system is not
/// positive definite. Fills what `health` says of iterations, restarts, convergence and the Mahalanobis distance.
bool solve(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
           RateSolution& solution, RateReport& health);

}  // namespace tumble
