// SPDX-License-Identifier: BSD-3-Clause
#include "rate_rounds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "triad_delay.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"

namespace tumble {

namespace {

// The accelerometer's readings of other instants: of the sample `shift` after each, at the ends of the last there is.
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

// A sheet that is believed.
SensorErrorSizes as_stated(SensorErrorSizes sizes) {
  sizes.gyro_unknown = sizes.accel_unknown = sizes.felt_unknown_s_m = sizes.delay_unknown_s = 0.0;
  return sizes;
}

// Whether a device of which `given` is stated may have such errors: what a fit has beyond that, the model of flight has
// missed.
bool plausible(const SensorErrors& found, const SensorErrors& given, const SensorErrorSizes& sizes) {
  constexpr double kDeviations = 6.0;
  const SensorErrors errors = SensorErrors::from(found.vector() - given.vector());
  const double delay_s = kDeviations * std::max(sizes.delay_s, sizes.delay_unknown_s);
  const double felt_s_m = kDeviations * std::max(sizes.felt_s_m, sizes.felt_unknown_s_m);
  return errors.vector().allFinite() && std::abs(errors.accel_delay_s) <= std::min(0.1, delay_s) &&
         std::abs(errors.accel_blur_s2) <= delay_s * delay_s && errors.felt_s_m.cwiseAbs().maxCoeff() <= felt_s_m;
}

// A guess that tells nothing leaves what was stated.
bool tells(const TriadDelay& guess) {
  return guess.sigma_s > 0.0 || guess.delay_s != 0.0;
}

// Whether errors are so far from those that readings have been corrected for that the descent must be made again.
bool far_apart(const SensorErrors& a, const SensorErrors& b) {
  constexpr double kMatrix = 1e-3, kFelt_s_m = 3e-5, kDelay_s = 3e-4, kBlur_s2 = 3e-6;
  return (a.gyro - b.gyro).cwiseAbs().maxCoeff() > kMatrix || (a.accel - b.accel).cwiseAbs().maxCoeff() > kMatrix ||
         (a.felt_s_m - b.felt_s_m).cwiseAbs().maxCoeff() > kFelt_s_m ||
         std::abs(a.accel_delay_s - b.accel_delay_s) > kDelay_s ||
         std::abs(a.accel_blur_s2 - b.accel_blur_s2) > kBlur_s2;
}

// What one device in a thousand moves three constants by, in deviations of all that may move them.
constexpr double kSurpriseOfDevice = 2.33;

// The rig as it was known; the gyro's elements, which flight cannot be taken for, stay free.
RateModelParams held(const RateModelParams& params, const RateModel& model) {
  constexpr int kFirst = RigConstants::kElements, kCount = RigConstants::kSize - kFirst;
  RateModelParams out = params;
  out.calibration = RigCalibration{model.prior_constants(), 1e-12 * RigConstants::Matrix::Identity()};
  out.calibration->covariance.block<kCount, kCount>(kFirst, kFirst) =
      model.prior_covariance().block<kCount, kCount>(kFirst, kFirst);
  return out;
}

// How far the constants moved, rate_smoother.md (R4), where the device's errors may have moved them too.
double surprise_of(const RateModelParams& known, const RateModel& model, double period_s,
                   std::span<const RateObservation> observations, const RateSolution& solution) {
  RateIteration again(observations);
  if (!again.factorise(model, solution.estimates, solution.rig)) return model.calibration_mahalanobis(solution.rig);
  const arrow::BorderErrors moved = again.moved_by_errors(model, solution.estimates, solution.rig).of_rig;
  RateModelParams wider = known;
  wider.calibration = RigCalibration{model.prior_constants(), model.prior_covariance()};
  wider.calibration->covariance +=
      moved * fit_sensor_errors({}, known.expert.error_sizes).known.covariance * moved.transpose();
  return RateModel(wider, period_s).calibration_mahalanobis(solution.rig);
}

// The descent, with the rig held to what was known of it where it takes contact for flight of another rig.
Status descend_held(const RateSmoother::Params& params, const RateModelParams& known, double period_s,
                    std::span<const RateObservation> observations, bool struck, RateFit& fit, RateReport& health) {
  fit.model = RateModel(known, period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {Trouble::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.rig_held = health.calibration_mahalanobis > params.calibration_mahalanobis_max;
  if (health.rig_held && struck) {
    health.calibration_mahalanobis = surprise_of(known, fit.model, period_s, observations, fit.solution);
    health.rig_held = health.calibration_mahalanobis > std::max(params.calibration_mahalanobis_max, kSurpriseOfDevice);
  }
  health.calibration = {fit.solution.rig, fit.solution.rig_covariance};
  if (!health.rig_held) return {};
  const double surprise = health.calibration_mahalanobis;
  health.calibration = {fit.model.prior_constants(), fit.model.prior_covariance()};
  fit.model = RateModel(held(known, fit.model), period_s);
  if (!solve(params, fit.model, observations, fit.solution, health)) {
    return {Trouble::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration_mahalanobis = surprise;
  // held is not known: what was open of the rig stays open in the rates
  constexpr int kOpen = RigConstants::kElements;
  fit.solution.rig_covariance.topLeftCorner<kOpen, kOpen>() =
      health.calibration.covariance.topLeftCorner<kOpen, kOpen>();
  return {};
}

// A guess of the delay this many of its deviations from what is assumed is where the descent starts.
constexpr double kGuessFar = 2.0;

// What strikes the body is not seen by the model of flight: evidence of its own, added to rate_smoother.md (R37).
void add_guess(const TriadDelay& guess, SensorErrorEvidence& evidence) {
  if (!(guess.sigma_s > 0.0)) return;
  const double information = 1.0 / (guess.sigma_s * guess.sigma_s);
  evidence.information(SensorErrors::kDelay, SensorErrors::kDelay) += information;
  evidence.gradient[SensorErrors::kDelay] += information * (guess.delay_s - evidence.about.accel_delay_s);
}

// Odds of a device as its sheet says below which the readings speak plainly against it. Above, the mixture over sizes
// has its doubt in it already.
constexpr double kPlainOdds = 0.05;

// Whether a device is plainly not what its sheet says: a maker who leaves scale or sampling open leaves all open.
// Naive Bayes over the two, each against what was held of it beforehand; `own_clocks`: the sampling is known to be
// open.
bool off_sheet(const SensorErrorFit& device, const SensorErrorSizes& sizes, bool own_clocks) {
  const SensorErrorFit before = fit_sensor_errors({}, sizes);
  const auto odds = [](double p) { return std::max(p, 1e-12) / std::max(1.0 - p, 1e-12); };
  const double of_scale = odds(device.calibrated) / odds(before.calibrated);
  return own_clocks || of_scale * odds(device.together) < kPlainOdds;
}

// The sizes of a device of which nothing is stated.
SensorErrorSizes unstated(SensorErrorSizes sizes) {
  sizes.gyro = std::max(sizes.gyro, sizes.gyro_unknown);
  sizes.accel = std::max(sizes.accel, sizes.accel_unknown);
  sizes.felt_s_m = std::max(sizes.felt_s_m, sizes.felt_unknown_s_m);
  sizes.delay_s = std::max(sizes.delay_s, sizes.delay_unknown_s);
  return sizes;
}

// What an earlier run told, about what is given of the device now.
SensorErrorEvidence learnt_about(const SensorErrors& given, KnownSensorErrors learnt, const SensorErrorSizes& sizes) {
  learnt.errors = SensorErrors::from(learnt.errors.vector() - given.vector());
  return learnt_evidence(learnt, sizes);
}

// The fit where errors are assumed about those that were given, `learnt` being about them too.
SensorErrorFit fit_about(const SensorErrors& given, SensorErrorEvidence evidence, const SensorErrorSizes& sizes,
                         const SensorErrorEvidence& learnt) {
  evidence.about = SensorErrors::from(evidence.about.vector() - given.vector());
  SensorErrorFit out = fit_sensor_errors(evidence, sizes, learnt);
  out.known.errors = SensorErrors::from(out.known.errors.vector() + given.vector());
  return out;
}

}  // namespace

Status fit_rounds(const RateSmoother::Params& params, const RateModelParams& known, std::span<const ImuSample> samples,
                  std::span<const Clipping> clippings, std::span<RateObservation> observations, RateFit& fit,
                  RateReport& health) {
  const bool estimated = params.expert.error_rounds_max > 1;
  const double period_s = median_period_s(samples);
  const RigConstants rig = known.calibration ? known.calibration->constants : known.nominal;
  bool told_before = estimated && params.learnt_errors.has_value();
  SensorErrorEvidence learnt =
      told_before ? learnt_about(known.errors, *params.learnt_errors, known.expert.error_sizes) : SensorErrorEvidence{};
  // triads with clocks of their own are not sampled as alike as a sheet may have it
  const bool own_clocks = health.gyro_update_s > 0.0 || health.accel_update_s > 0.0;
  SensorErrorSizes sizes = known.expert.error_sizes;
  if (own_clocks) sizes.delay_s = std::max(sizes.delay_s, sizes.delay_unknown_s);
  TriadDelay guess;
  if (estimated && known.expert.error_sizes.delay_unknown_s > known.expert.error_sizes.delay_s)
    guess = guess_triad_delay(samples, clippings, rig.lever_arm_m);
  SensorErrors errors;
  double other_delay_s = 0.0;  // for where the descent from the first one has to hold the rig
  const auto begin_with = [&](const SensorErrors& assumed) {
    errors = assumed;
    if (tells(guess) && std::abs(guess.delay_s - errors.accel_delay_s) > kGuessFar * guess.sigma_s)
      errors.accel_delay_s = guess.delay_s;
    other_delay_s = !tells(guess)                           ? errors.accel_delay_s
                    : errors.accel_delay_s == guess.delay_s ? known.errors.accel_delay_s
                                                            : guess.delay_s;
  };
  begin_with(told_before ? params.learnt_errors->errors : known.errors);
  // a body that is struck and flies is no hand's: its rig may be moved by what the device makes of the motion
  const bool struck = guess.sigma_s > 0.0;
  std::vector<double> age_s(samples.size());
  for (std::size_t k = 0; k < age_s.size(); ++k) age_s[k] = observations[k].accel_age_s;
  SensorErrorFit found;
  bool believed = true;
  for (health.error_rounds = 1;; ++health.error_rounds) {
    const double shift = std::round(errors.accel_delay_s / period_s);
    shift_force(samples, clippings, static_cast<std::ptrdiff_t>(shift), age_s, observations);
    RateModelParams corrected = known;
    corrected.errors = errors;
    corrected.errors.accel_delay_s -= shift * period_s;
    if (Status status = descend_held(params, corrected, period_s, observations, struck, fit, health); !status.ok()) {
      return status;
    }
    if (health.rig_held && told_before) {
      // it may be another device
      told_before = false;
      learnt = {};
      begin_with(known.errors);
      health.error_rounds = 0;
      continue;
    }
    if (health.rig_held && health.error_rounds == 1 && estimated && errors.accel_delay_s != other_delay_s) {
      errors.accel_delay_s = other_delay_s;
      health.error_rounds = 0;
      continue;
    }
    const RateSolution& solution = fit.solution;
    fit.moved = solution.iteration.moved_by_errors(fit.model, solution.estimates, solution.rig);
    if (estimated) {
      // where the descent has not come to its end, what is left of the gradient must not pass for errors
      RateIteration again = solution.iteration;
      if (!again.factorise(fit.model, solution.estimates, solution.rig)) {
        return {Trouble::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
      }
      fit.moved.evidence = again.moved_by_errors(fit.model, solution.estimates, solution.rig).evidence;
    }
    fit.moved.evidence.about = errors;
    add_guess(guess, fit.moved.evidence);
    found = fit_about(known.errors, fit.moved.evidence, sizes, learnt);
    believed = plausible(found.known.errors, known.errors, known.expert.error_sizes);
    if (health.rig_held || !believed || health.error_rounds >= params.expert.error_rounds_max) break;
    if (!far_apart(found.known.errors, errors)) break;
    errors = found.known.errors;
  }
  health.calibrated = found.calibrated;
  health.together = own_clocks ? 0.0 : found.together;
  const bool open = estimated && known.expert.error_sizes.delay_unknown_s > known.expert.error_sizes.delay_s &&
                    (off_sheet(found, known.expert.error_sizes, own_clocks) ||
                     health.calibration_mahalanobis > params.calibration_mahalanobis_max);
  if (open) {
    sizes = unstated(sizes);
    health.shared_delay_sigma_s = std::sqrt(0.5) * sizes.delay_s;
    // in the covariance alone: what readings are corrected for stays what they speak for plainly
    const KnownSensorErrors unknown = fit_about(known.errors, fit.moved.evidence, sizes, learnt).known;
    const SensorErrors::Vector apart = unknown.errors.vector() - found.known.errors.vector();
    found.known.covariance = unknown.covariance + apart * apart.transpose();
  }
  if (health.rig_held || !believed || !estimated) {
    // what a run without flight tells of the device is nothing, beyond what devices have it is wrong: all is left open
    found = fit_sensor_errors({}, estimated ? sizes : as_stated(known.expert.error_sizes));
    found.known.errors = errors;
  } else {
    const SensorErrors::Vector step = found.known.errors.vector() - errors.vector();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const Eigen::Matrix<double, 6, 1> moved = fit.model.unscaled(fit.moved.of_sample[k] * step);
      fit.solution.estimates[k].knot.rate_rad_s += moved.head<3>();
      fit.solution.estimates[k].knot.acceleration_rad_s2 += moved.tail<3>();
    }
    fit.solution.rig.add(fit.moved.of_rig * step);
  }
  health.sensor_errors = found.known;
  if (health.rig_held) return {};
  health.calibration.constants = fit.solution.rig;
  // the device's errors stay with the device: the next run meets them as this one did, and counts them anew
  const SensorErrors::Matrix stated = fit_sensor_errors({}, as_stated(known.expert.error_sizes)).known.covariance;
  health.calibration.covariance += fit.moved.of_rig * stated * fit.moved.of_rig.transpose();
  return {};
}

}  // namespace tumble
