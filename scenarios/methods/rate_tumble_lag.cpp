// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/report_rates.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/regime_stream.hpp"

namespace tumble::scenarios {

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

MotionRegimeStream::Params stream_params(const sim::Sensors& sensors, const sim::Values& parameters,
                                         const CalibratedRig* given) {
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
  params.hand_held.body.expert.gap_max_s = rate.gap_max_s;
  if (given == nullptr) return params;

  apply_saved_calibration(*given, rate);
  return params;
}

void restart_after_gap(MotionRegimeStream::Params& params, MotionRegimeStream& joined, MotionRegimeStream::State& all) {
  const RigCalibration calibration = joined.rate().calibration(all.rate);
  if (check_calibration(calibration).ok()) params.rate.model.calibration = calibration;
  joined = MotionRegimeStream(params);
  const FrozenAxes::State frozen = all.rate.frozen_axes;
  const FlightSignCheck::State sense = all.rate.flight_sign_check;
  all = joined.start();
  all.rate.frozen_axes = frozen;
  all.rate.flight_sign_check = sense;
}

Estimate rates_of_stream(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples, bridge::kAnyGapS);
  if (!estimate.status.ok()) return estimate;
  MotionRegimeStream::Params params = stream_params(sensors, parameters, given);
  std::vector<AuxiliaryRecording> recordings;
  estimate.status = auxiliary_recordings(sensors, recordings);
  if (!estimate.status.ok()) return estimate;
  std::vector<std::vector<AuxiliaryReading>> auxiliary_imus;
  estimate.status = align(recordings, samples, bridge::kGapMaxS, params.rate.model, auxiliary_imus);
  if (!estimate.status.ok()) return estimate;
  // If auxiliary IMUs exist, the hand-held smoother is switched off, because it cannot use auxiliary IMUs.
  if (!auxiliary_imus.empty() && !parameters.has("hand_held_probability_min")) params.hand_held_probability_min = 1.0;
  MotionRegimeStream joined(params);
  const AngularRateStream& stream = joined.rate();
  MotionRegimeStream::State all = joined.start();
  estimate.rates.reserve(samples.size());
  std::optional<AngularRateState> out;
  std::vector<AuxiliaryReading> beside(auxiliary_imus.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (std::size_t i = 0; i < beside.size(); ++i) beside[i] = auxiliary_imus[i][k];
    if (k > 0 && seconds(samples[k].time_ns - samples[k - 1].time_ns) > params.rate.gap_max_s) {
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
  estimate.health["calibration_at_prior"] = is_at_prior(stream, state) ? 1.0 : 0.0;
  estimate.health["accel_delay_s"] = stream.sensor_errors(state).errors.accel_delay_s;
  report_rails(state.clipping_state.known_limits, estimate.health);
  const std::optional<double> carried_share =
      all.reported_sample_count > 0
          ? std::optional(all.regime_probability_sum.hand_held / static_cast<double>(all.reported_sample_count))
          : std::nullopt;
  if (estimate.status.ok() && found != nullptr) {
    if (std::optional<CalibratedRig> rig = calibrated_rig(stream, params.rate, given, state)) *found = std::move(rig);
  }
  if (estimate.status.ok()) {
    (void)check_imu(sensors, samples, estimate.rates, carried_share, estimate);
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                             std::optional<CalibratedRig>* found) {
  return without_outliers(sensors, [&](const sim::Sensors& kept) {
    return with_sample_times(
        kept, [&](const sim::Sensors& timed) { return rates_of_stream(timed, parameters, given, found); });
  });
}

Method rate_tumble_lag() {
  return make_method({.name = "tumble_lag",
                      .kind = Kind::rate,
                      .doc = "Runs the smoother of rate/tumble as a stream, with the same factors in a sliding window "
                             "and with a fixed lag.",
                      .ours = true,
                      .settings = {&rate_tumble_lag_settings()},
                      .robots = {"rig", "pendulum", "sphere"},
                      .calibrates_rig = true},
                     [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
                       return run_rate_tumble_lag(sensors, parameters, nullptr, nullptr);
                     });
}

}  // namespace tumble::scenarios
