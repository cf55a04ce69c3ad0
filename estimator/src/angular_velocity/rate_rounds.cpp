// SPDX-License-Identifier: BSD-3-Clause
#include "rate_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "triad_delay.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

// At the ends of the recording, the last available reading repeats.
void shift_force(std::span<const ImuSample> samples, std::span<const Clipping> clippings, std::ptrdiff_t shift,
                 std::span<const double> accel_age_s, std::span<RateObservation> observations) {
  const auto last = static_cast<std::ptrdiff_t>(samples.size()) - 1;
  for (std::ptrdiff_t k = 0; k <= last; ++k) {
    const auto from = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k + shift, 0, last));
    RateObservation& o = observations[static_cast<std::size_t>(k)];
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

// The lever arm of one correct device in a thousand has a larger Mahalanobis distance from its prior.
constexpr double kDeviceMahalanobisMax = 2.33;

// All calibration constants except the gyro's sensing directions are held at their prior.
RateModelParams fixed_calibration(const RateModelParams& params, const RateModel& model) {
  constexpr int kFirst = RigConstants::kElements, kCount = RigConstants::kSize - kFirst;
  RateModelParams out = params;
  out.calibration = RigCalibration{model.prior_constants(), 1e-12 * RigConstants::Matrix::Identity()};
  out.calibration->covariance.block<kCount, kCount>(kFirst, kFirst) =
      model.prior_covariance().block<kCount, kCount>(kFirst, kFirst);
  return out;
}

// See rate_smoother.md (R32).
double mahalanobis_of(const RateModelParams& known, const RateModel& model, double period_s,
                      std::span<const RateObservation> observations, const RateSolution& solution) {
  RateIteration again(observations);
  if (!again.factorise(model, solution.estimates, solution.rig)) return model.calibration_mahalanobis(solution.rig);
  const arrow::BorderErrors moved =
      again.error_derivatives(model, solution.estimates, solution.rig).calibration_by_errors;
  RateModelParams wider = known;
  wider.calibration = RigCalibration{model.prior_constants(), model.prior_covariance()};
  wider.calibration->covariance +=
      moved * fit_sensor_errors({}, known.expert.error_priors).known.covariance * moved.transpose();
  return RateModel(wider, period_s).calibration_mahalanobis(solution.rig);
}

// If the estimated calibration is implausible, a second optimisation holds the calibration at its prior.
Status optimise_or_fix_prior(const RateSmoother::Params& params, const RateModelParams& known, double period_s,
                             std::span<const RateObservation> observations, bool struck, RateFit& fit,
                             RateReport& health) {
  fit.model = RateModel(known, period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration_at_prior = health.calibration_mahalanobis > params.calibration_mahalanobis_max;
  if (health.calibration_at_prior && struck) {
    health.calibration_mahalanobis = mahalanobis_of(known, fit.model, period_s, observations, fit.solution);
    health.calibration_at_prior =
        health.calibration_mahalanobis > std::max(params.calibration_mahalanobis_max, kDeviceMahalanobisMax);
  }
  health.calibration = {fit.solution.rig, fit.solution.rig_covariance};
  if (!health.calibration_at_prior) return {};
  const double mahalanobis = health.calibration_mahalanobis;
  health.calibration = {fit.model.prior_constants(), fit.model.prior_covariance()};
  fit.model = RateModel(fixed_calibration(known, fit.model), period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration_mahalanobis = mahalanobis;
  // A fixed calibration is still uncertain, so the covariance of the rates includes the covariance of the calibration.
  constexpr int kOpen = RigConstants::kElements;
  fit.solution.rig_covariance.topLeftCorner<kOpen, kOpen>() =
      health.calibration.covariance.topLeftCorner<kOpen, kOpen>();
  return {};
}

constexpr double kGuessSigmasMax = 2.0;

// See rate_smoother.md (R38). The delay from impacts is independent of the free-flight equations, which use no impacts.
void add_guess(const TriadDelay& guess, SensorErrorEvidence& evidence) {
  if (!(guess.sigma_s > 0.0)) return;
  const double information = 1.0 / (guess.sigma_s * guess.sigma_s);
  evidence.information(SensorErrors::kDelay, SensorErrors::kDelay) += information;
  evidence.gradient[SensorErrors::kDelay] += information * (guess.delay_s - evidence.linearisation_point.accel_delay_s);
}

constexpr double kContradictionOdds = 0.05;

// A device with a wrong scale may also have an unstated accelerometer delay, and vice versa.
bool contradicts_data_sheet(const SensorErrorFit& device, const SensorErrorPriors& sizes, bool triads_asynchronous) {
  const SensorErrorFit before = fit_sensor_errors({}, sizes);
  const auto odds = [](double p) { return std::max(p, 1e-12) / std::max(1.0 - p, 1e-12); };
  const double of_scale = odds(device.data_sheet_probability) / odds(before.data_sheet_probability);
  return triads_asynchronous || of_scale * odds(device.synchronous_probability) < kContradictionOdds;
}

SensorErrorPriors uncalibrated_priors(SensorErrorPriors sizes) {
  sizes.gyro = std::max(sizes.gyro, sizes.gyro_uncalibrated);
  sizes.accel = std::max(sizes.accel, sizes.accel_uncalibrated);
  sizes.g_sensitivity_s_m = std::max(sizes.g_sensitivity_s_m, sizes.g_sensitivity_uncalibrated_s_m);
  sizes.delay_s = std::max(sizes.delay_s, sizes.delay_uncalibrated_s);
  return sizes;
}

SensorErrorEvidence calibration_evidence_about(const SensorErrors& given, KnownSensorErrors learnt,
                                               const SensorErrorPriors& sizes) {
  learnt.errors = SensorErrors::from(learnt.errors.vector() - given.vector());
  return calibration_evidence(learnt, sizes);
}

// `learnt` is the estimate of an earlier run, relative to the sensor errors `given` by the user.
SensorErrorFit fit_about(const SensorErrors& given, SensorErrorEvidence evidence, const SensorErrorPriors& sizes,
                         const SensorErrorEvidence& learnt) {
  evidence.linearisation_point = SensorErrors::from(evidence.linearisation_point.vector() - given.vector());
  SensorErrorFit out = fit_sensor_errors(evidence, sizes, learnt);
  out.known.errors = SensorErrors::from(out.known.errors.vector() + given.vector());
  return out;
}

struct Rounds {
  const RateSmoother::Params& params;
  const RateModelParams& known;  ///< parameters with the sensor errors that the user states
  std::span<const ImuSample> samples;
  std::span<const Clipping> clippings;
  double period_s = 0.0;
  bool estimated = false;
  bool triads_asynchronous = false;  ///< gyro or accelerometer repeats readings
  TriadDelay guess = {};             ///< delay from impacts; empty if the data sheet states the delay
  std::vector<double> age_s = {};    ///< age of the accelerometer's readings in the log
  SensorErrorPriors sizes = {};      ///< standard deviations of the data sheet, enlarged for asynchronous triads

  const SensorErrorPriors& stated() const { return known.expert.error_priors; }
  bool is_delay_unknown() const { return estimated && stated().delay_uncalibrated_s > stated().delay_s; }
  /// Returns whether the body has impacts and flight, and is therefore not hand-held.
  bool struck() const { return guess.sigma_s > 0.0; }
};

Rounds make_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                   std::span<const Clipping> clippings, std::span<const RateObservation> observations,
                   const RateReport& health) {
  Rounds out{params, known, samples, clippings, median_period_s(samples)};
  out.estimated = params.expert.error_rounds_max > 1;
  out.triads_asynchronous = health.gyro_update_s > 0.0 || health.accel_update_s > 0.0;
  out.sizes = out.stated();
  if (out.triads_asynchronous) out.sizes.delay_s = std::max(out.sizes.delay_s, out.sizes.delay_uncalibrated_s);
  const RigConstants rig = known.calibration ? known.calibration->constants : known.nominal;
  if (out.is_delay_unknown()) out.guess = guess_triad_delay(samples, clippings, rig.lever_arm_m);
  out.age_s.resize(samples.size());
  for (std::size_t k = 0; k < out.age_s.size(); ++k) out.age_s[k] = observations[k].accel_age_s;
  return out;
}

// If the first optimisation finds an implausible calibration, a second optimisation uses the accelerometer delay
// `other_delay_s`.
struct Start {
  SensorErrors errors;
  double other_delay_s = 0.0;
};

Start start_from(const SensorErrors& assumed, const Rounds& rounds) {
  const TriadDelay& guess = rounds.guess;
  Start out{assumed, assumed.accel_delay_s};
  if (!has_delay(guess)) return out;
  if (std::abs(guess.delay_s - assumed.accel_delay_s) > kGuessSigmasMax * guess.sigma_s)
    out.errors.accel_delay_s = guess.delay_s;
  out.other_delay_s = out.errors.accel_delay_s == guess.delay_s ? rounds.known.errors.accel_delay_s : guess.delay_s;
  return out;
}

Status optimise_corrected(const Rounds& rounds, const SensorErrors& errors, std::span<RateObservation> observations,
                          RateFit& fit, RateReport& health) {
  const double shift = std::round(errors.accel_delay_s / rounds.period_s);
  shift_force(rounds.samples, rounds.clippings, static_cast<std::ptrdiff_t>(shift), rounds.age_s, observations);
  RateModelParams corrected = rounds.known;
  corrected.errors = errors;
  corrected.errors.accel_delay_s -= shift * rounds.period_s;
  return optimise_or_fix_prior(rounds.params, corrected, rounds.period_s, observations, rounds.struck(), fit, health);
}

Status collect_evidence(const Rounds& rounds, const SensorErrors& errors, RateFit& fit, const RateReport& health) {
  const RateSolution& solution = fit.solution;
  fit.moved = solution.iteration.error_derivatives(fit.model, solution.estimates, solution.rig);
  if (rounds.estimated) {
    // Before convergence, the gradient is not evidence of sensor errors.
    RateIteration again = solution.iteration;
    if (!again.factorise(fit.model, solution.estimates, solution.rig)) {
      return {ErrorCode::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
    }
    fit.moved.evidence = again.error_derivatives(fit.model, solution.estimates, solution.rig).evidence;
  }
  fit.moved.evidence.linearisation_point = errors;
  add_guess(rounds.guess, fit.moved.evidence);
  return {};
}

struct RoundsState {
  SensorErrors errors;  ///< errors corrected in the last optimisation
  SensorErrorEvidence learnt;
  SensorErrorFit found;
  bool is_plausible = true;  ///< the errors are plausible for a device
};

Status optimise_rounds(const Rounds& rounds, std::span<RateObservation> observations, RateFit& fit, RateReport& health,
                       RoundsState& rounds_state) {
  const SensorErrors& given = rounds.known.errors;
  const std::optional<KnownSensorErrors>& learnt = rounds.params.calibrated_errors;
  bool has_calibration = rounds.estimated && learnt.has_value();
  if (has_calibration) rounds_state.learnt = calibration_evidence_about(given, *learnt, rounds.stated());
  Start start = start_from(has_calibration ? learnt->errors : given, rounds);
  rounds_state.errors = start.errors;
  health.error_rounds = 0;
  for (int round = 1;; ++round) {  // counts from the last restart; the report counts all rounds
    ++health.error_rounds;
    if (Status status = optimise_corrected(rounds, rounds_state.errors, observations, fit, health); !status.ok())
      return status;
    if (health.calibration_at_prior && has_calibration) {
      // The loaded calibration may belong to a different device.
      has_calibration = false;
      rounds_state.learnt = {};
      start = start_from(given, rounds);
      rounds_state.errors = start.errors;
      round = 0;
      continue;
    }
    const bool first = round == 1 && rounds.estimated;
    if (health.calibration_at_prior && first && rounds_state.errors.accel_delay_s != start.other_delay_s) {
      rounds_state.errors.accel_delay_s = start.other_delay_s;
      round = 0;
      continue;
    }
    if (Status status = collect_evidence(rounds, rounds_state.errors, fit, health); !status.ok()) return status;
    rounds_state.found = fit_about(given, fit.moved.evidence, rounds.sizes, rounds_state.learnt);
    rounds_state.is_plausible = plausible(rounds_state.found.known.errors, given, rounds.stated());
    if (health.calibration_at_prior || !rounds_state.is_plausible || round >= rounds.params.expert.error_rounds_max)
      return {};
    if (!differ_significantly(rounds_state.found.known.errors, rounds_state.errors)) return {};
    rounds_state.errors = rounds_state.found.known.errors;
  }
}

// If the readings clearly contradict the data sheet, the function returns the priors of an uncalibrated device.
SensorErrorPriors open_priors(const Rounds& rounds, const RateFit& fit, RoundsState& rounds_state, RateReport& health) {
  const bool open = rounds.is_delay_unknown() &&
                    (contradicts_data_sheet(rounds_state.found, rounds.stated(), rounds.triads_asynchronous) ||
                     health.calibration_mahalanobis > rounds.params.calibration_mahalanobis_max);
  if (!open) return rounds.sizes;
  const SensorErrorPriors sizes = uncalibrated_priors(rounds.sizes);
  health.common_delay_sigma_s = std::sqrt(0.5) * sizes.delay_s;
  KnownSensorErrors& found = rounds_state.found.known;
  const KnownSensorErrors unknown =
      fit_about(rounds.known.errors, fit.moved.evidence, sizes, rounds_state.learnt).known;
  const SensorErrors::Vector apart = unknown.errors.vector() - found.errors.vector();
  found.covariance = unknown.covariance + apart * apart.transpose();
  return sizes;
}

void apply_correction(const SensorErrors::Vector& step, RateFit& fit) {
  for (std::size_t k = 0; k < fit.solution.estimates.size(); ++k) {
    const Eigen::Matrix<double, 6, 1> moved = fit.model.unscaled(fit.moved.of_sample[k] * step);
    fit.solution.estimates[k].knot.rate_rad_s += moved.head<3>();
    fit.solution.estimates[k].knot.acceleration_rad_s2 += moved.tail<3>();
  }
  fit.solution.rig.add(fit.moved.calibration_by_errors * step);
}

}  // namespace

Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health) {
  const Rounds rounds = make_rounds(params, known, samples, clippings, observations, health);
  RoundsState rounds_state;
  if (Status status = optimise_rounds(rounds, observations, fit, health, rounds_state); !status.ok()) return status;
  health.data_sheet_probability = rounds_state.found.data_sheet_probability;
  health.synchronous_probability = rounds.triads_asynchronous ? 0.0 : rounds_state.found.synchronous_probability;
  const SensorErrorPriors sizes = open_priors(rounds, fit, rounds_state, health);
  const SensorErrorPriors stated = data_sheet_priors(rounds.stated());
  if (health.calibration_at_prior || !rounds_state.is_plausible || !rounds.estimated) {
    // If calibration or sensor errors are implausible, the sensor errors keep their prior covariance.
    rounds_state.found = fit_sensor_errors({}, rounds.estimated ? sizes : stated);
    rounds_state.found.known.errors = rounds_state.errors;
  } else {
    apply_correction(rounds_state.found.known.errors.vector() - rounds_state.errors.vector(), fit);
  }
  health.sensor_errors = rounds_state.found.known;
  if (health.calibration_at_prior) return {};
  health.calibration.constants = fit.solution.rig;
  // The estimated calibration depends on the uncertain sensor errors, so its covariance includes their uncertainty.
  const SensorErrors::Matrix device_covariance = fit_sensor_errors({}, stated).known.covariance;
  health.calibration.covariance +=
      fit.moved.calibration_by_errors * device_covariance * fit.moved.calibration_by_errors.transpose();
  return {};
}

}  // namespace tumble
