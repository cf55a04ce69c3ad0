// SPDX-License-Identifier: BSD-3-Clause
#include "rate_descent.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

void shift_force_by_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings, std::ptrdiff_t shift,
                          std::span<const double> accel_age_s, std::span<AngularRateObservation> observations) {
  const auto last = static_cast<std::ptrdiff_t>(samples.size()) - 1;
  for (std::ptrdiff_t k = 0; k <= last; ++k) {
    const auto from = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k + shift, 0, last));
    AngularRateObservation& o = observations[static_cast<std::size_t>(k)];
    o.sample.specific_force_m_s2 = samples[from].specific_force_m_s2;
    o.clipping.accel = clippings[from].accel;
    o.accel_age_s = accel_age_s[from];
  }
}

SensorErrorPriors data_sheet_priors(SensorErrorPriors sizes) {
  sizes.gyro_uncalibrated = sizes.accel_uncalibrated = sizes.g_sensitivity_uncalibrated_s_m =
      sizes.delay_uncalibrated_s = 0.0;
  return sizes;
}

bool plausible(const SensorErrors& found, const SensorErrors& given, const SensorErrorPriors& sizes) {
  constexpr double kDeviations = 6.0;
  const SensorErrors errors = SensorErrors::from(found.vector() - given.vector());
  const double delay_s = kDeviations * std::max(sizes.delay_s, sizes.delay_uncalibrated_s);
  const double g_sensitivity_s_m =
      kDeviations * std::max(sizes.g_sensitivity_s_m, sizes.g_sensitivity_uncalibrated_s_m);
  return errors.vector().allFinite() && std::abs(errors.accel_delay_s) <= std::min(0.1, delay_s) &&
         std::abs(errors.accel_filter_time_variance_s2) <= delay_s * delay_s &&
         errors.g_sensitivity_s_m.cwiseAbs().maxCoeff() <= g_sensitivity_s_m;
}

bool has_delay(const TriadDelay& guess) {
  return guess.sigma_s > 0.0 || guess.delay_s != 0.0;
}

bool differ_significantly(const SensorErrors& a, const SensorErrors& b) {
  constexpr double kMatrix = 1e-3, kGSensitivity_s_m = 3e-5, kDelay_s = 3e-4, kFilterTimeVariance_s2 = 3e-6;
  return (a.gyro - b.gyro).cwiseAbs().maxCoeff() > kMatrix || (a.accel - b.accel).cwiseAbs().maxCoeff() > kMatrix ||
         (a.g_sensitivity_s_m - b.g_sensitivity_s_m).cwiseAbs().maxCoeff() > kGSensitivity_s_m ||
         std::abs(a.accel_delay_s - b.accel_delay_s) > kDelay_s ||
         std::abs(a.accel_filter_time_variance_s2 - b.accel_filter_time_variance_s2) > kFilterTimeVariance_s2;
}

// limit of the Mahalanobis distance between the estimated lever arm and its prior: rate_smoother.md (R32). With a
// correct prior, the Mahalanobis distance of one device in a thousand exceeds the limit.
constexpr double kDeviceMahalanobisMax = 2.33;

// Returns parameters that fix all calibration constants at their prior, except the gyro's sensing directions.
AngularRateModelParams fixed_calibration(const AngularRateModelParams& params, const AngularRateModel& model) {
  constexpr int kFirst = BodyImuConstants::kGyroMisalignmentIndex, kCount = BodyImuConstants::kSize - kFirst;
  AngularRateModelParams out = params;
  out.calibration = BodyImuCalibration{model.prior_constants(), 1e-12 * BodyImuConstants::Matrix::Identity()};
  out.calibration->covariance.block<kCount, kCount>(kFirst, kFirst) =
      model.prior_covariance().block<kCount, kCount>(kFirst, kFirst);
  return out;
}

// See rate_smoother.md (R32).
double mahalanobis_of(const SensorErrorPriors& sizes, const AngularRateModel& model,
                      std::span<const AngularRateObservation> observations, const RateSolution& solution) {
  GaussNewtonRateStep again(observations);
  if (!again.factorise(model, solution.estimates, solution.rig)) return model.calibration_mahalanobis(solution.rig);
  return model.calibration_mahalanobis(
      solution.rig, again.error_derivatives(model, solution.estimates, solution.rig).calibration_error_jacobian,
      fit_sensor_errors({}, sizes).fitted_errors.covariance);
}

Status optimise_or_fix_rig_prior(const AngularRateSmoother::Params& params, const AngularRateModelParams& known,
                                 double period_s, std::span<const AngularRateObservation> observations, bool struck,
                                 AngularRateFit& fit, AngularRateReport& health) {
  fit.model = AngularRateModel(known, period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration_at_prior = health.calibration_mahalanobis > params.calibration_mahalanobis_max;
  if (health.calibration_at_prior) {
    const double limit = params.calibration_mahalanobis_max;
    health.calibration_mahalanobis = mahalanobis_of(known.expert.error_priors, fit.model, observations, fit.solution);
    health.calibration_at_prior =
        health.calibration_mahalanobis > (struck ? std::max(limit, kDeviceMahalanobisMax) : limit);
  }
  health.calibration = {fit.solution.rig, fit.solution.rig_covariance};
  if (!health.calibration_at_prior) return {};
  const double mahalanobis = health.calibration_mahalanobis;
  health.calibration = {fit.model.prior_constants(), fit.model.prior_covariance()};
  fit.model = AngularRateModel(fixed_calibration(known, fit.model), period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration_mahalanobis = mahalanobis;
  // The calibration is uncertain even if the optimisation does not change the calibration. The covariance of the rates
  // therefore always includes the covariance of the calibration.
  constexpr int kOpen = BodyImuConstants::kGyroMisalignmentIndex;
  fit.solution.rig_covariance.topLeftCorner<kOpen, kOpen>() =
      health.calibration.covariance.topLeftCorner<kOpen, kOpen>();
  return {};
}

constexpr double kGuessSigmasMax = 2.0;

// See rate_smoother.md (R38). The accelerometer delay is estimated from impacts, which the free-flight equations do not
// use. The accelerometer delay from impacts is therefore independent of the free-flight equations.
void add_impact_delay(const TriadDelay& guess, SensorErrorInformation& evidence) {
  if (!(guess.sigma_s > 0.0)) return;
  const double information = 1.0 / (guess.sigma_s * guess.sigma_s);
  evidence.information(SensorErrors::kDelay, SensorErrors::kDelay) += information;
  evidence.gradient[SensorErrors::kDelay] += information * (guess.delay_s - evidence.linearisation_point.accel_delay_s);
}

constexpr double kContradictionOdds = 0.05;

// Multiplies the odds that the scale factors agree with the data sheet by the odds that gyro and accelerometer are
// synchronous. Scale factors or delay, or both, may contradict the data sheet, so the product of the odds is compared
// with a limit.
bool contradicts_data_sheet(const SensorErrorFit& device, const SensorErrorPriors& sizes, bool triads_asynchronous) {
  const SensorErrorFit before = fit_sensor_errors({}, sizes);
  const auto odds = [](double p) { return std::max(p, 1e-12) / std::max(1.0 - p, 1e-12); };
  const double of_scale = odds(device.data_sheet_probability) / odds(before.data_sheet_probability);
  return triads_asynchronous || of_scale * odds(device.synchronous_triads_probability) < kContradictionOdds;
}

SensorErrorPriors uncalibrated_priors(SensorErrorPriors sizes) {
  sizes.gyro = std::max(sizes.gyro, sizes.gyro_uncalibrated);
  sizes.accel = std::max(sizes.accel, sizes.accel_uncalibrated);
  sizes.g_sensitivity_s_m = std::max(sizes.g_sensitivity_s_m, sizes.g_sensitivity_uncalibrated_s_m);
  sizes.delay_s = std::max(sizes.delay_s, sizes.delay_uncalibrated_s);
  return sizes;
}

SensorErrorInformation calibration_evidence_at(const SensorErrors& given, KnownSensorErrors learnt,
                                               const SensorErrorPriors& sizes) {
  learnt.errors = SensorErrors::from(learnt.errors.vector() - given.vector());
  return evidence_from_earlier_runs(learnt, sizes);
}

// `given` contains the sensor errors that the user states. `learnt` contains the differences between the true sensor
// errors and `given`, as estimated in an earlier run, with their information.
SensorErrorFit fit_errors_at(const SensorErrors& given, SensorErrorInformation evidence, const SensorErrorPriors& sizes,
                             const SensorErrorInformation& learnt) {
  evidence.linearisation_point = SensorErrors::from(evidence.linearisation_point.vector() - given.vector());
  SensorErrorFit out = fit_sensor_errors(evidence, sizes, learnt);
  out.fitted_errors.errors = SensorErrors::from(out.fitted_errors.errors.vector() + given.vector());
  return out;
}

struct CorrectionIterations {
  const AngularRateSmoother::Params& params;
  const AngularRateModelParams& params_with_stated_errors;
  std::span<const ImuSample> samples;
  std::span<const Clipping> clipping_per_sample;
  double period_s = 0.0;
  bool estimated = false;
  bool triads_asynchronous = false;  ///< gyro or accelerometer repeats readings
  /// delay between gyro and accelerometer, estimated from impacts or free flight; empty if the data sheet states the
  /// delay
  TriadDelay impact_delay = {};
  std::vector<double> age_s = {};  ///< age of the accelerometer readings in the log
  SensorErrorPriors error_prior_sigmas =
      {};  ///< standard deviations of the data sheet, enlarged for asynchronous triads

  const SensorErrorPriors& stated_error_priors() const { return params_with_stated_errors.expert.error_priors; }
  bool is_delay_unknown() const {
    return estimated && stated_error_priors().delay_uncalibrated_s > stated_error_priors().delay_s;
  }
  /// Returns whether the delay was estimated from impacts. A body with impacts and free flight is not hand-held.
  bool has_impact_delay() const { return impact_delay.sigma_s > 0.0; }
};

CorrectionIterations make_correction_iterations(const AngularRateSmoother::Params& params,
                                                const AngularRateModelParams& known, std::span<const ImuSample> samples,
                                                std::span<const Clipping> clippings,
                                                std::span<const AngularRateObservation> observations,
                                                const AngularRateReport& health) {
  CorrectionIterations out{params, known, samples, clippings, median_period_s(samples)};
  out.estimated = params.expert.error_rounds_max > 1;
  out.triads_asynchronous = health.gyro_update_interval_s > 0.0 || health.accel_update_interval_s > 0.0;
  out.error_prior_sigmas = out.stated_error_priors();
  if (out.triads_asynchronous)
    out.error_prior_sigmas.delay_s =
        std::max(out.error_prior_sigmas.delay_s, out.error_prior_sigmas.delay_uncalibrated_s);
  const BodyImuConstants rig = known.calibration ? known.calibration->constants : known.nominal;
  if (out.is_delay_unknown()) out.impact_delay = guess_triad_delay(samples, clippings, rig.lever_arm_m);
  out.age_s.resize(samples.size());
  for (std::size_t k = 0; k < out.age_s.size(); ++k) out.age_s[k] = observations[k].accel_age_s;
  return out;
}

// If the first optimisation finds an implausible calibration, a second optimisation uses the accelerometer delay
// `alternative_delay_s`.
struct InitialErrors {
  SensorErrors errors;
  double alternative_delay_s = 0.0;
};

InitialErrors initial_calibration(const SensorErrors& assumed, const CorrectionIterations& rounds) {
  const TriadDelay& guess = rounds.impact_delay;
  InitialErrors out{assumed, assumed.accel_delay_s};
  if (!has_delay(guess)) return out;
  if (std::abs(guess.delay_s - assumed.accel_delay_s) > kGuessSigmasMax * guess.sigma_s)
    out.errors.accel_delay_s = guess.delay_s;
  out.alternative_delay_s =
      out.errors.accel_delay_s == guess.delay_s ? rounds.params_with_stated_errors.errors.accel_delay_s : guess.delay_s;
  return out;
}

Status optimise_corrected_readings(const CorrectionIterations& rounds, const SensorErrors& errors,
                                   std::span<AngularRateObservation> observations, AngularRateFit& fit,
                                   AngularRateReport& health) {
  const double shift = std::round(errors.accel_delay_s / rounds.period_s);
  shift_force_by_delay(rounds.samples, rounds.clipping_per_sample, static_cast<std::ptrdiff_t>(shift), rounds.age_s,
                       observations);
  AngularRateModelParams corrected = rounds.params_with_stated_errors;
  corrected.errors = errors;
  corrected.errors.accel_delay_s -= shift * rounds.period_s;
  return optimise_or_fix_rig_prior(rounds.params, corrected, rounds.period_s, observations, rounds.has_impact_delay(),
                                   fit, health);
}

/// Computes the normal equations again at the final estimates. The normal equations of the last Gauss-Newton step
/// belong to earlier estimates, and would be inconsistent with residuals at the final estimates.
Status collect_error_evidence(const CorrectionIterations& rounds, const SensorErrors& errors, AngularRateFit& fit,
                              const AngularRateReport& health) {
  RateSolution& solution = fit.solution;
  if (!solution.iteration.factorise(fit.model, solution.estimates, solution.rig))
    return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  fit.error_derivatives = solution.iteration.error_derivatives(fit.model, solution.estimates, solution.rig);
  fit.error_derivatives.sensor_error_evidence.linearisation_point = errors;
  add_impact_delay(rounds.impact_delay, fit.error_derivatives.sensor_error_evidence);
  return {};
}

struct CorrectionIterationState {
  SensorErrors errors;  ///< sensor errors corrected in the last optimisation
  SensorErrorInformation calibration_evidence;
  SensorErrorFit sensor_error_fit;
  bool is_plausible = true;
};

Status iterate_corrections(const CorrectionIterations& rounds, std::span<AngularRateObservation> observations,
                           AngularRateFit& fit, AngularRateReport& health, CorrectionIterationState& rounds_state) {
  const SensorErrors& given = rounds.params_with_stated_errors.errors;
  const std::optional<KnownSensorErrors>& learnt = rounds.params.calibrated_errors;
  bool has_calibration = rounds.estimated && learnt.has_value();
  if (has_calibration)
    rounds_state.calibration_evidence = calibration_evidence_at(given, *learnt, rounds.stated_error_priors());
  InitialErrors start = initial_calibration(has_calibration ? learnt->errors : given, rounds);
  rounds_state.errors = start.errors;
  health.correction_iterations = 0;
  for (int round = 1;; ++round) {  // counts iterations since the last restart; the report counts all iterations
    ++health.correction_iterations;
    if (Status status = optimise_corrected_readings(rounds, rounds_state.errors, observations, fit, health);
        !status.ok())
      return status;
    if (health.calibration_at_prior && has_calibration) {
      // The loaded calibration may belong to a different device.
      has_calibration = false;
      rounds_state.calibration_evidence = {};
      start = initial_calibration(given, rounds);
      rounds_state.errors = start.errors;
      round = 0;
      continue;
    }
    const bool first = round == 1 && rounds.estimated;
    if (health.calibration_at_prior && first && rounds_state.errors.accel_delay_s != start.alternative_delay_s) {
      rounds_state.errors.accel_delay_s = start.alternative_delay_s;
      round = 0;
      continue;
    }
    if (Status status = collect_error_evidence(rounds, rounds_state.errors, fit, health); !status.ok()) return status;
    rounds_state.sensor_error_fit = fit_errors_at(given, fit.error_derivatives.sensor_error_evidence,
                                                  rounds.error_prior_sigmas, rounds_state.calibration_evidence);
    rounds_state.is_plausible =
        plausible(rounds_state.sensor_error_fit.fitted_errors.errors, given, rounds.stated_error_priors());
    if (health.calibration_at_prior || !rounds_state.is_plausible || round >= rounds.params.expert.error_rounds_max)
      return {};
    if (!differ_significantly(rounds_state.sensor_error_fit.fitted_errors.errors, rounds_state.errors)) return {};
    rounds_state.errors = rounds_state.sensor_error_fit.fitted_errors.errors;
  }
}

// If the readings clearly contradict the data sheet, the function returns the priors of an uncalibrated device.
SensorErrorPriors widened_error_priors(const CorrectionIterations& rounds, const AngularRateFit& fit,
                                       CorrectionIterationState& rounds_state, AngularRateReport& health) {
  const bool open =
      rounds.is_delay_unknown() && (contradicts_data_sheet(rounds_state.sensor_error_fit, rounds.stated_error_priors(),
                                                           rounds.triads_asynchronous) ||
                                    health.calibration_mahalanobis > rounds.params.calibration_mahalanobis_max);
  if (!open) return rounds.error_prior_sigmas;
  const SensorErrorPriors sizes = uncalibrated_priors(rounds.error_prior_sigmas);
  health.common_delay_sigma_s = std::sqrt(0.5) * sizes.delay_s;
  KnownSensorErrors& found = rounds_state.sensor_error_fit.fitted_errors;
  const KnownSensorErrors unknown =
      fit_errors_at(rounds.params_with_stated_errors.errors, fit.error_derivatives.sensor_error_evidence, sizes,
                    rounds_state.calibration_evidence)
          .fitted_errors;
  const SensorErrors::Vector apart = unknown.errors.vector() - found.errors.vector();
  found.covariance = unknown.covariance + apart * apart.transpose();
  return sizes;
}

void apply_correction(const SensorErrors::Vector& step, AngularRateFit& fit) {
  for (std::size_t k = 0; k < fit.solution.estimates.size(); ++k) {
    const Eigen::Matrix<double, 6, 1> moved =
        fit.model.unscaled_step(fit.error_derivatives.sample_error_jacobian[k] * step);
    fit.solution.estimates[k].knot.rate_rad_s += moved.head<3>();
    fit.solution.estimates[k].knot.acceleration_rad_s2 += moved.tail<3>();
  }
  fit.solution.rig.add(fit.error_derivatives.calibration_error_jacobian * step);
}

}  // namespace

Status fit_rounds(const AngularRateSmoother::Params& params, const AngularRateModelParams& known,
                  std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                  std::span<AngularRateObservation> observations, AngularRateFit& fit, AngularRateReport& health) {
  const CorrectionIterations rounds =
      make_correction_iterations(params, known, samples, clippings, observations, health);
  CorrectionIterationState rounds_state;
  if (Status status = iterate_corrections(rounds, observations, fit, health, rounds_state); !status.ok()) return status;
  health.data_sheet_probability = rounds_state.sensor_error_fit.data_sheet_probability;
  health.synchronous_triads_probability =
      rounds.triads_asynchronous ? 0.0 : rounds_state.sensor_error_fit.synchronous_triads_probability;
  const SensorErrorPriors sizes = widened_error_priors(rounds, fit, rounds_state, health);
  const SensorErrorPriors stated = data_sheet_priors(rounds.stated_error_priors());
  if (health.calibration_at_prior || !rounds_state.is_plausible || !rounds.estimated) {
    // If calibration or sensor errors are implausible, the sensor errors keep their prior covariance.
    rounds_state.sensor_error_fit = fit_sensor_errors({}, rounds.estimated ? sizes : stated);
    rounds_state.sensor_error_fit.fitted_errors.errors = rounds_state.errors;
  } else {
    apply_correction(rounds_state.sensor_error_fit.fitted_errors.errors.vector() - rounds_state.errors.vector(), fit);
  }
  health.sensor_errors = rounds_state.sensor_error_fit.fitted_errors;
  if (health.calibration_at_prior) return {};
  health.calibration.constants = fit.solution.rig;
  // The estimated calibration depends on the sensor errors, so the covariance of the calibration includes the
  // uncertainty of the sensor errors.
  const SensorErrors::Matrix device_covariance = fit_sensor_errors({}, stated).fitted_errors.covariance;
  health.calibration.covariance += fit.error_derivatives.calibration_error_jacobian * device_covariance *
                                   fit.error_derivatives.calibration_error_jacobian.transpose();
  return {};
}

}  // namespace tumble
