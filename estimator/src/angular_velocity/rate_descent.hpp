// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"

namespace tumble {

class GaussNewtonRateStep {
 public:
  explicit GaussNewtonRateStep(std::span<const AngularRateObservation> observations)
      : observations_(observations), state_blocks_(observations.size()) {}

  /// Returns false if the normal equations are not positive definite.
  bool factorise(const AngularRateModel& model, std::span<const AngularRateEstimate> estimates,
                 const BodyImuConstants& rig);
  /// Adds the last Gauss-Newton step, scaled so that no angular rate changes by more than step_max. Returns the largest
  /// change of an angular rate in the step before scaling.
  double apply(const AngularRateModel& model, double step_max, std::span<AngularRateEstimate> estimates,
               BodyImuConstants& rig) const;

  /// Calls use(k, conditional) for each sample k from last to first. `conditional` is the distribution of the sample's
  /// rate and angular acceleration for known calibration constants.
  template <typename Use>
  void for_each_state_given_next(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = state_blocks_.size(); k-- > 0;) {
      conditional = arrow::System::state_given_next_state(state_blocks_[k],
                                                          k + 1 == state_blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  /// `sensor_error_evidence` is the information about the sensor errors after elimination of all other unknowns.
  struct SensorErrorDerivatives {
    std::vector<arrow::ErrorMatrix> sample_error_jacobian;
    arrow::BorderErrors calibration_error_jacobian;
    SensorErrorInformation sensor_error_evidence;
  };
  SensorErrorDerivatives error_derivatives(const AngularRateModel& model,
                                           std::span<const AngularRateEstimate> estimates,
                                           const BodyImuConstants& rig) const;

  const BodyImuConstants::Matrix& rig_covariance() const { return rig_covariance_; }
  /// Returns the squared length of the last Gauss-Newton step, in standard deviations of the estimate: rate_smoother.md
  /// (R30).
  double newton_decrement() const;

 private:
  std::span<const AngularRateObservation> observations_;
  std::vector<arrow::Block> state_blocks_;
  arrow::Corner border_block_;
  arrow::BorderVector calibration_step_;
  BodyImuConstants::Matrix rig_covariance_;
};

struct RateSolution {
  std::vector<AngularRateEstimate> estimates;
  BodyImuConstants rig;
  BodyImuConstants::Matrix rig_covariance;
  GaussNewtonRateStep iteration;
};

/// Returns false if the normal equations are not positive definite. If most clipped samples are classified as contact,
/// solve() repeats the optimisation with other residual thresholds for free flight. Other residual thresholds help if a
/// wrong initial lever arm has led to a local minimum.
bool solve(const AngularRateSmoother::Params& params, const AngularRateModel& model,
           std::span<const AngularRateObservation> observations, RateSolution& solution, AngularRateReport& health);

struct AngularRateFit {
  AngularRateFit(std::span<const AngularRateObservation> observations, const AngularRateModel& first)
      : solution{{}, {}, {}, GaussNewtonRateStep(observations)}, model(first) {}

  RateSolution solution;
  AngularRateModel model;
  GaussNewtonRateStep::SensorErrorDerivatives error_derivatives;
};

/// Optimises repeatedly, and corrects the readings each time by the last estimated sensor errors. If the estimated
/// calibration is too far from its prior, rate_smoother.md (R32), contact was probably classified as free flight, and
/// the optimisation restarts up to two times. The first restart ignores the sensor errors of an earlier run, and the
/// second restart uses another accelerometer delay. If all restarts of the optimisation fail, the calibration is held
/// at its prior.
Status fit_rounds(const AngularRateSmoother::Params& params, const AngularRateModelParams& known,
                  std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                  std::span<AngularRateObservation> observations, AngularRateFit& fit, AngularRateReport& health);

}  // namespace tumble
