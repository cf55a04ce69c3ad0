// SPDX-License-Identifier: BSD-3-Clause
#include "rate_descent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// kRestartThresholds contains factors on the residual threshold between free flight and contact. If few clipped samples
// are classified as free flight, the optimisation restarts with each factor of kRestartThresholds.
constexpr double kRestartThresholds[] = {16.0, 0.25};
constexpr double kFlightShareExpected = 0.5;

// The iteration has converged if each linear combination of unknowns changes by at most kStepDeviations times its
// standard deviation: rate_smoother.md (R30).
constexpr double kStepDeviations = 0.1;

constexpr double kVarianceUnknown = 100.0;  // variance of a clipped axis at the start, (rad/s)^2

// Computes initial rates with a smoother and the published rate recovery (SaturationAwareRateEstimator).
std::vector<AngularRateEstimate> first_guess(std::span<const AngularRateObservation> observations,
                                             const AngularRateModelParams& model, const AngularRateModel& derived) {
  double smallest = model.kRateMax_rad_s;
  for (const AngularRateObservation& o : observations) {
    for (int j = 0; j < 3; ++j) {
      const double reading = std::abs(o.sample.angular_velocity_rad_s[j]);
      if ((o.clipping.gyro >> j & 1u) != 0) smallest = std::min(smallest, std::max(reading, 0.01));
    }
  }
  const SaturationAwareRateEstimator saave({.lever_arm_m = derived.prior_constants().lever_arm_m,
                                            .saturation_point_rad_s = std::max(0.01, 0.9999 * smallest)});
  SaturationAwareRateEstimator::State state;
  SaturationAwareRateEstimator::RecoveredRate recovered;
  const double measured = derived.gyro_sigma_rad_s() * derived.gyro_sigma_rad_s();
  std::vector<WnojSmoother::Measurement> readings(observations.size());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const AngularRateObservation& o = observations[k];
    if (!saave.step(o.sample, state, recovered).ok()) {
      state = {};
      (void)saave.step(o.sample, state, recovered);
    }
    readings[k] = {o.sample.time_ns, o.sample.angular_velocity_rad_s, Vector3d::Constant(measured)};
    for (int j = 0; j < 3; ++j) {
      if ((o.clipping.unusable_gyro >> j & 1u) != 0) readings[k].variance_rad2_s2[j] = kVarianceUnknown;
      if ((o.unmeasured_axes() & o.clipping.gyro & 1u << j) == 0) continue;
      const double limit = model.kRateMax_rad_s;
      readings[k].rate_rad_s[j] = std::clamp(recovered.rate_rad_s[j], -limit, limit);
      readings[k].variance_rad2_s2[j] = std::clamp(recovered.variance_rad2_s2[j], 0.25, kVarianceUnknown);
    }
  }
  std::vector<WnojSmoother::Smoothed> smoothed;
  (void)WnojSmoother({}).smooth(readings, smoothed);
  std::vector<AngularRateEstimate> out(observations.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].knot = {smoothed[k].rate_rad_s, smoothed[k].acceleration_rad_s2};
  }
  return out;
}

// See rate_smoother.md (R16) to (R19).
void compute_flight_weights(const AngularRateModel& model, std::span<const AngularRateObservation> observations,
                            const BodyImuConstants& rig, const BodyImuConstants::Matrix& rig_covariance,
                            double threshold_factor, std::span<AngularRateEstimate> estimates) {
  double before = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    double after = std::numeric_limits<double>::max();
    if (k + 1 < estimates.size()) {
      const double dt_s = seconds(observations[k + 1].sample.time_ns - observations[k].sample.time_ns);
      after = model.jump(estimates[k].knot, estimates[k + 1].knot, dt_s);
    }
    // If no gyro axis is clipped, the rate is accurate, so the residual threshold for free flight is not multiplied by
    // threshold_factor.
    const int clipped = observations[k].unmeasured_axes();
    model.compute_flight_weight(observations[k], rig, rig_covariance, clipped != 0 ? threshold_factor : 1.0,
                                std::min(before, after), estimates[k]);
    before = after;
  }
}

bool run_gauss_newton(const AngularRateSmoother::Params& params, const AngularRateModel& model,
                      std::span<const AngularRateObservation> observations, double threshold_factor,
                      RateSolution& solution, AngularRateReport& health) {
  solution.estimates = first_guess(observations, params.model, model);
  solution.rig = model.prior_constants();
  solution.rig_covariance = model.prior_covariance();
  std::vector<AngularRateEstimate>& estimates = solution.estimates;
  int soft = 0;
  health.iterations = 0;
  health.converged = false;
  while (health.iterations < params.expert.optimisation.iterations_max) {
    compute_flight_weights(model, observations, solution.rig, solution.rig_covariance, threshold_factor, estimates);
    if (!solution.iteration.factorise(model, estimates, solution.rig)) return false;
    solution.rig_covariance = solution.iteration.rig_covariance();
    health.last_step_rad_s =
        solution.iteration.apply(model, params.expert.optimisation.kStepMax_rad_s, estimates, solution.rig);
    ++health.iterations;

    const bool converged =
        threshold_factor == 1.0 && (health.last_step_rad_s < params.expert.optimisation.tolerance_rad_s ||
                                    solution.iteration.newton_decrement() < kStepDeviations * kStepDeviations);
    if (soft > 0) {
      solution.iteration.for_each_state_given_next([&](std::size_t k, const arrow::Conditional& conditional) {
        model.update_bounds(observations[k], solution.rig, conditional, solution.rig_covariance,
                            params.expert.optimisation.kBoundDamping, estimates[k]);
      });
    }
    if (soft > 0 || converged ||
        health.iterations + params.expert.optimisation.bound_iterations >= params.expert.optimisation.iterations_max) {
      for (std::size_t k = 0; k < estimates.size() && soft == 0; ++k) {
        if (estimates[k].flight_weight >= 0.5) continue;
        model.search_flight_solutions(observations[k], solution.rig, estimates[k]);
        model.initialise_rate_bounds(observations[k], solution.rig, estimates[k]);
      }
      health.converged = converged || health.converged;
      if (soft++ == params.expert.optimisation.bound_iterations) break;
    }
    threshold_factor = std::max(1.0, 0.5 * threshold_factor);
  }
  health.calibration_mahalanobis = model.calibration_mahalanobis(solution.rig);
  return true;
}

// Returns the sum of the square roots of all free-flight weights (1: free flight, 0: contact), which measures the
// agreement of the motion with free flight: rate_smoother.md (R31).
double explained_force_fraction(std::span<const AngularRateObservation> observations,
                                std::span<const AngularRateEstimate> estimates, double& share) {
  double sum = 0.0, unmeasured_axes = 0.0, flight = 0.0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    sum += std::sqrt(estimates[k].flight_weight);
    if (observations[k].unmeasured_axes() == 0) continue;
    unmeasured_axes += 1.0;
    flight += estimates[k].flight_weight >= 0.5 ? 1.0 : 0.0;
  }
  share = unmeasured_axes > 0.0 ? flight / unmeasured_axes : 1.0;
  return sum;
}

}  // namespace

// See rate_smoother.md (R27), (R28), (R29), (R33), (R34).
template struct BlockArrowSystem<arrow::kBlockSize, arrow::kBorderSize>;

namespace arrow {

// See rate_smoother.md (R27).
void eliminate_sensor_errors(const Block& block, ErrorMatrix& errors, ErrorMatrix* next, BorderErrors& border) {
  errors = (block.diagonal.lazyProduct(errors)).eval();
  border.noalias() -= block.border_coupling.transpose().lazyProduct(errors);
  if (next != nullptr) next->noalias() -= block.coupling_to_next_state.transpose().lazyProduct(errors);
}

// See rate_smoother.md (R37).
ErrorMatrix back_substitute_errors(const Block& block, const ErrorMatrix& errors, const ErrorMatrix* next_moved,
                                   const BorderErrors& border_moved) {
  ErrorMatrix right = errors - block.border_coupling.lazyProduct(border_moved);
  if (next_moved != nullptr) right.noalias() -= block.coupling_to_next_state.lazyProduct(*next_moved);
  return block.diagonal.transpose().lazyProduct(right);
}

// See rate_smoother.md (R35).
Eigen::Matrix3d rate_covariance(const Conditional& conditional, const BorderMatrix& border_covariance) {
  const Eigen::Matrix<double, 3, kBorderSize> rows = conditional.border_jacobian.topRows<3>();
  const Eigen::Matrix<double, 3, kBorderSize> cross = rows.lazyProduct(border_covariance);
  Eigen::Matrix3d out = conditional.state.topLeftCorner<3, 3>();
  out.noalias() += cross.lazyProduct(rows.transpose());
  return out;
}

}  // namespace arrow

// See rate_smoother.md (R26).
bool GaussNewtonRateStep::factorise(const AngularRateModel& model, std::span<const AngularRateEstimate> estimates,
                                    const BodyImuConstants& rig) {
  border_block_ = {};
  model.add_rig_prior(rig, border_block_);
  state_blocks_[0] = {};
  for (std::size_t k = 0; k < state_blocks_.size(); ++k) {
    model.add_sample(observations_[k], estimates[k], rig, state_blocks_[k], border_block_);
    const bool last = k + 1 == state_blocks_.size();
    if (!last) {
      state_blocks_[k + 1] = {};
      const double dt_s = seconds(observations_[k + 1].sample.time_ns - observations_[k].sample.time_ns);
      model.add_motion_model(estimates[k], estimates[k + 1], dt_s, state_blocks_[k], state_blocks_[k + 1]);
    }
    if (!arrow::System::eliminate(state_blocks_[k], last ? nullptr : &state_blocks_[k + 1], border_block_))
      return false;
  }
  return arrow::System::solve_border_block(border_block_, calibration_step_, rig_covariance_);
}

// See rate_smoother.md (R30).
double GaussNewtonRateStep::newton_decrement() const {
  double sum = calibration_step_.dot(border_block_.gradient);
  for (const arrow::Block& block : state_blocks_) sum += block.gradient.squaredNorm();
  return sum;
}

double GaussNewtonRateStep::apply(const AngularRateModel& model, double step_max,
                                  std::span<AngularRateEstimate> estimates, BodyImuConstants& rig) const {
  double largest = 0.0;
  arrow::StateVector step;
  for (std::size_t k = state_blocks_.size(); k-- > 0;) {
    const bool last = k + 1 == state_blocks_.size();
    step = arrow::System::back_substitute(state_blocks_[k], last ? nullptr : &step, calibration_step_);
    const Eigen::Matrix<double, 6, 1> physical = model.unscaled_step(step);
    const double length = physical.head<3>().norm();
    const double share = length > step_max ? step_max / length : 1.0;
    estimates[k].knot.rate_rad_s += share * physical.head<3>();
    estimates[k].knot.acceleration_rad_s2 += share * physical.tail<3>();
    largest = std::max(largest, length);
  }
  rig.add(calibration_step_);
  return largest;
}

// See rate_smoother.md (R37), (R38), (R39).
GaussNewtonRateStep::SensorErrorDerivatives GaussNewtonRateStep::error_derivatives(
    const AngularRateModel& model, std::span<const AngularRateEstimate> estimates, const BodyImuConstants& rig) const {
  SensorErrorDerivatives out;
  out.sample_error_jacobian.assign(state_blocks_.size(), arrow::ErrorMatrix::Zero());
  arrow::BorderErrors border = arrow::BorderErrors::Zero();
  for (std::size_t k = 0; k < state_blocks_.size(); ++k) {
    arrow::ErrorMatrix& errors = out.sample_error_jacobian[k];
    model.add_sensor_errors(observations_[k], estimates[k], rig, errors, border, out.sensor_error_evidence);
    const bool last = k + 1 == state_blocks_.size();
    arrow::eliminate_sensor_errors(state_blocks_[k], errors, last ? nullptr : &out.sample_error_jacobian[k + 1],
                                   border);
    out.sensor_error_evidence.information.noalias() -= errors.transpose() * errors;
    out.sensor_error_evidence.gradient.noalias() += errors.transpose() * state_blocks_[k].gradient;
  }
  out.calibration_error_jacobian.noalias() = rig_covariance_ * border;
  out.sensor_error_evidence.information.noalias() -= border.transpose() * out.calibration_error_jacobian;
  out.sensor_error_evidence.gradient.noalias() += border.transpose() * calibration_step_;
  for (std::size_t k = state_blocks_.size(); k-- > 0;) {
    const arrow::ErrorMatrix* const next = k + 1 == state_blocks_.size() ? nullptr : &out.sample_error_jacobian[k + 1];
    out.sample_error_jacobian[k] = arrow::back_substitute_errors(state_blocks_[k], out.sample_error_jacobian[k], next,
                                                                 out.calibration_error_jacobian);
  }
  discount_unobservable(model.independent_sample_fraction(), out.sensor_error_evidence);
  return out;
}

bool solve(const AngularRateSmoother::Params& params, const AngularRateModel& model,
           std::span<const AngularRateObservation> observations, RateSolution& solution, AngularRateReport& health) {
  if (!run_gauss_newton(params, model, observations, params.expert.optimisation.kInitialThresholdFactor, solution,
                        health))
    return false;
  double share = 1.0;
  double best = explained_force_fraction(observations, solution.estimates, share);
  for (const double factor : kRestartThresholds) {
    if (share >= kFlightShareExpected) break;
    RateSolution other{{}, {}, {}, GaussNewtonRateStep(observations)};
    AngularRateReport other_health = health;
    const double threshold_factor = std::max(1.0, factor * params.expert.optimisation.kInitialThresholdFactor);
    if (!run_gauss_newton(params, model, observations, threshold_factor, other, other_health)) continue;
    double other_share = 0.0;
    const double found = explained_force_fraction(observations, other.estimates, other_share);
    ++health.restarts;
    if (!(found > best)) continue;
    best = found;
    share = other_share;
    other_health.restarts = health.restarts;
    health = other_health;
    solution = std::move(other);
  }
  return true;
}

}  // namespace tumble
