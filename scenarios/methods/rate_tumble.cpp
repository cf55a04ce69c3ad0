// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_tumble.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/regime_stream.hpp"

namespace tumble::scenarios {

// A range or noise density of 0 means that the data sheet lacks the value.
AngularRateSmoother::Params stated_params(const sim::ImuRecord& record, AngularRateSmoother::Params params) {
  AngularRateModelParams& model = params.model;
  model.nominal.lever_arm_m = bridge::lever_arm_I_m(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) model.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  if (record.accel_noise_m_s2_sqrt_hz > 0.0) model.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
  params.saturation_detector = stated_rails(record);
  return params;
}

AngularRateSmoother::Params smoother_params(const sim::ImuRecord& record,
                                            const Settings<AngularRateSmoother::Params>& settings,
                                            const sim::Values& parameters) {
  AngularRateSmoother::Params params = stated_params(record, settings.defaults());
  settings.apply(parameters, params);
  return params;
}

Status auxiliary_recordings(const sim::Sensors& sensors, std::vector<AuxiliaryRecording>& out) {
  out.clear();
  const sim::ImuRecord& primary = sensors.imus.front();
  for (std::size_t i = 1; i < sensors.imus.size() && out.size() < kAuxiliaryImusMax; ++i) {
    const sim::ImuRecord& record = sensors.imus[i];
    if (record.name == "imu_reference") continue;  // only for comparisons
    AuxiliaryRecording& added = out.emplace_back();
    if (Status status = bridge::imu_samples(record, added.samples, bridge::kAnyGapS); !status.ok()) return status;
    added.imu.T_imu_device = primary.T_BI.inverse(Eigen::Isometry) * record.T_BI;
    if (record.gyro_noise_rad_s_sqrt_hz > 0.0) added.imu.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
    if (record.accel_noise_m_s2_sqrt_hz > 0.0) added.imu.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
    added.stated_saturation_limits = stated_rails(record);
  }
  return {};
}

const std::vector<std::string>& stated_densities() {
  static const std::vector<std::string> names = {"gyro_noise_density", "accel_noise_density"};
  return names;
}

const Settings<AngularRateSmoother::Params>& rate_tumble_settings() {
  static const Settings<AngularRateSmoother::Params> all(AngularRateSmoother::Params{}, {.stated = stated_densities()});
  return all;
}

MotionRegimeSmoother::Params regime_params(const sim::Sensors& sensors, const AngularRateSmoother::Params& rate) {
  MotionRegimeSmoother::Params out;
  out.rate = rate;
  out.evidence.gravity_m_s2 = out.hand_held.gravity_m_s2 = sensors.gravity_m_s2;
  return out;
}

RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReadingsToReplace replaced, Estimate& estimate) {
  const AngularRateSmoother::Params rate = stated_params(sensors.imus.front(), rate_tumble_settings().defaults());
  std::vector<AuxiliaryRecording> auxiliary_imus;
  if (!auxiliary_recordings(sensors, auxiliary_imus).ok()) auxiliary_imus.clear();
  const RecoveredRates out = recover_rates(samples, auxiliary_imus, regime_params(sensors, rate), replaced);
  report_rails(out.saturation_levels, estimate.health);
  return out;
}

namespace {

Estimate rates_of_batch(const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples, bridge::kAnyGapS);
  if (estimate.status.ok()) {
    const AngularRateSmoother::Params params =
        smoother_params(sensors.imus.front(), rate_tumble_settings(), parameters);
    std::vector<AuxiliaryRecording> auxiliary_imus;
    estimate.status = auxiliary_recordings(sensors, auxiliary_imus);
    MotionRegimeSmoother::Report report;
    if (estimate.status.ok())
      estimate.status = estimate_rates(samples, auxiliary_imus, regime_params(sensors, params), estimate.rates, report);
    estimate.health["imus"] = 1.0 + static_cast<double>(auxiliary_imus.size());
    if (estimate.status.ok()) {
      report_rates(report, estimate);
      report_gaps(samples, estimate);
      inflate_rates(check_imu(sensors, samples, estimate.rates, carried_share(report), estimate), samples, estimate);
    }
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_tumble() {
  return make_method(
      {.name = "tumble",
       .kind = Kind::rate,
       .doc = "Smooths the rates of the whole recording. A clipped reading is a lower bound of the rate's magnitude. "
              "Euler's equation, and the specific force at the lever arm in free flight, also constrain the rate. The "
              "method calibrates lever arm, biases, inertia ratios and gyro axis directions. The method uses all IMUs "
              "on the body except 'imu_reference', which serves only for comparison. During hand-held motion, the "
              "method runs the hand-held smoother.",
       .ours = true,
       .source = "ours: extends Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024",
       .settings = {&rate_tumble_settings()},
       .robots = {"rig", "pendulum", "sphere"}},
      [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
        return without_outliers(sensors, [&](const sim::Sensors& kept) {
          return with_sample_times(kept, [&](const sim::Sensors& timed) { return rates_of_batch(timed, parameters); });
        });
      });
}

namespace {

const Settings<MotionRegimeStream::Params>& rate_tumble_lag_settings() {
  static const Settings<MotionRegimeStream::Params> all = [] {
    std::vector<std::string> stated = stated_densities();
    stated.insert(stated.end(),
                  {"period_s", "evidence_gravity_m_s2", "carried_gravity_m_s2", "hand_held_probability_min"});
    const std::vector<std::string> fixed = {"carried_period_s", "carried_lag_s", "carried_gap_max_s",
                                            "carried_iterations_max"};
    return Settings<MotionRegimeStream::Params>(MotionRegimeStream::Params{}, {.stated = stated, .fixed = fixed});
  }();
  return all;
}

MotionRegimeStream::Params stream_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  const sim::ImuRecord& record = sensors.imus.front();
  MotionRegimeStream::Params params = rate_tumble_lag_settings().defaults();
  AngularRateStream::Params& rate = params.rate;
  AngularRateSmoother::Params batch;
  batch.model = rate.model;
  batch = stated_params(record, std::move(batch));
  rate.model = batch.model;
  rate.saturation_detector = batch.saturation_detector;
  if (record.period_ns > 0) rate.period_s = seconds(record.period_ns);
  params.evidence.gravity_m_s2 = params.hand_held.body.gravity_m_s2 = sensors.gravity_m_s2;
  rate_tumble_lag_settings().apply(parameters, params);
  rate.lag_s = std::max(rate.lag_s, 2.0 * rate.period_s);
  params.hand_held.body.expert.gap_max_s = rate.kGapMax_s;
  return params;
}

void restart_after_gap(MotionRegimeStream::Params& params, MotionRegimeStream& joined, MotionRegimeStream::State& all) {
  const BodyImuCalibration calibration = joined.rate().body_imu_calibration(all.rate);
  if (check_body_imu_calibration(calibration).ok()) params.rate.model.calibration = calibration;
  joined = MotionRegimeStream(params);
  const FrozenAxes::State frozen = all.rate.frozen_axes;
  const FlightSignCheck::State sense = all.rate.flight_sign_check;
  all = joined.start();
  all.rate.frozen_axes = frozen;
  all.rate.flight_sign_check = sense;
}

Estimate rates_of_stream(const sim::Sensors& sensors, const sim::Values& parameters) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples, bridge::kAnyGapS);
  if (!estimate.status.ok()) return estimate;
  MotionRegimeStream::Params params = stream_params(sensors, parameters);
  std::vector<AuxiliaryRecording> recordings;
  estimate.status = auxiliary_recordings(sensors, recordings);
  if (!estimate.status.ok()) return estimate;
  std::vector<std::vector<AuxiliaryReading>> auxiliary_imus;
  estimate.status = align(recordings, samples, bridge::kGapMaxS, params.rate.model, auxiliary_imus);
  if (!estimate.status.ok()) return estimate;
  // If auxiliary IMUs exist, the hand-held smoother is switched off, because the smoother cannot use auxiliary IMUs.
  if (!auxiliary_imus.empty() && !parameters.has("hand_held_probability_min")) params.hand_held_probability_min = 1.0;
  MotionRegimeStream joined(params);
  const AngularRateStream& stream = joined.rate();
  MotionRegimeStream::State all = joined.start();
  estimate.rates.reserve(samples.size());
  std::optional<AngularRateState> out;
  std::vector<AuxiliaryReading> beside(auxiliary_imus.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (std::size_t i = 0; i < beside.size(); ++i) beside[i] = auxiliary_imus[i][k];
    if (k > 0 && seconds(samples[k].time_ns - samples[k - 1].time_ns) > params.rate.kGapMax_s) {
      joined.flush(all, estimate.rates);
      restart_after_gap(params, joined, all);
    }
    estimate.status = joined.push(samples[k], beside, all, out);
    if (!estimate.status.ok()) break;
    if (out) estimate.rates.push_back(*out);
  }
  joined.flush(all, estimate.rates);
  report_gaps(samples, estimate);
  const AngularRateStream::State& state = all.rate;
  estimate.health["calibration_at_prior"] = stream.lever_arm_is_prior(state) ? 1.0 : 0.0;
  estimate.health["accel_delay_s"] = stream.sensor_errors_except_biases(state).errors.accel_delay_s;
  report_rails(state.clipping_state.known_limits, estimate.health);
  const std::optional<double> carried_share =
      all.reported_sample_count > 0
          ? std::optional(all.regime_probability_sum.hand_held / static_cast<double>(all.reported_sample_count))
          : std::nullopt;
  if (estimate.status.ok()) {
    (void)check_imu(sensors, samples, estimate.rates, carried_share, estimate);
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_tumble_lag() {
  return make_method(
      {.name = "tumble_lag",
       .kind = Kind::rate,
       .doc = "Runs the smoother of rate/tumble with a fixed lag, on a sliding window of recent readings.",
       .ours = true,
       .settings = {&rate_tumble_lag_settings()},
       .robots = {"rig", "pendulum", "sphere"}},
      [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
        return without_outliers(sensors, [&](const sim::Sensors& kept) {
          return with_sample_times(kept, [&](const sim::Sensors& timed) { return rates_of_stream(timed, parameters); });
        });
      });
}

}  // namespace tumble::scenarios
