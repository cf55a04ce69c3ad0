// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/report_rails.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/regime_stream.hpp"

namespace tumble::scenarios {

namespace {

const Settings<RegimeStream::Params>& rate_tumble_lag_settings() {
  static const Settings<RegimeStream::Params> all = [] {
    std::vector<std::string> stated = stated_densities();
    stated.insert(stated.end(), {"period_s", "evidence_gravity_m_s2", "carried_gravity_m_s2", "carried_min"});
    // RegimeStream takes these parameters from its RateStream. The hand-held stream iterates continuously.
    const std::vector<std::string> fixed = {"carried_period_s", "carried_lag_s", "carried_gap_max_s",
                                            "carried_iterations_max"};
    return Settings<RegimeStream::Params>(RegimeStream::Params{}, {.stated = stated, .fixed = fixed});
  }();
  return all;
}

RegimeStream::Params stream_params(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given) {
  const sim::ImuRecord& record = sensors.imus.front();
  RegimeStream::Params params = rate_tumble_lag_settings().defaults();
  RateStream::Params& rate = params.rate;
  RateSmoother::Params batch;
  batch.model = rate.model;
  batch = stated_params(record, std::move(batch));
  rate.model = batch.model;
  rate.rails = batch.rails;
  if (record.period_ns > 0) rate.period_s = seconds(record.period_ns);
  params.evidence.gravity_m_s2 = params.carried.body.gravity_m_s2 = sensors.gravity_m_s2;
  rate_tumble_lag_settings().apply(parameters, params);
  rate.lag_s = std::max(rate.lag_s, 2.0 * rate.period_s);
  params.carried.body.expert.gap_max_s = rate.gap_max_s;
  if (given == nullptr) return params;

  batch.model = rate.model;
  batch.rails = rate.rails;
  batch.expert.planes = rate.expert.planes;
  batch.expert.accel_planes = rate.expert.accel_planes;
  start_from_learnt(*given, batch);
  rate.model = batch.model;
  rate.rails = batch.rails;
  rate.expert.planes = batch.expert.planes;
  rate.expert.accel_planes = batch.expert.accel_planes;
  if (batch.calibrated_errors) rate.calibrated_errors = std::make_shared<KnownSensorErrors>(*batch.calibrated_errors);
  return params;
}

LearntRig rig_of(const RateStream& stream, const RateStream::Params& params, const RateStream::State& state) {
  LearntRig rig{stream.calibration(state), {}};
  const RailDetector upright_rails(params.rails);
  const SaturationLevels& known = state.rails.known;
  for (int c = 0; c < 6; ++c) {
    std::optional<double>& rail = rig.rail[static_cast<std::size_t>(c)];
    rail = upright_rails.rail(known.upright_rails, c);
    const auto& plane = (c < 3 ? known.planes : known.accel_planes).element[static_cast<std::size_t>(c % 3)];
    if (plane) rail = plane->distance_rad_s;
  }
  if (!known.upright) rig.keep(known.planes);
  if (!known.accel_clips_after_compensation) rig.keep(known.accel_planes, Triad::accelerometer);
  return rig;
}

/// Returns the calibration of a stream. `at_prior` is true if the rig's constants were not estimated. The delay is the
/// only device error that the stream estimates.
std::optional<LearntRig> learnt_by(const RateStream& stream, const RateStream::Params& params, const LearntRig* given,
                                   bool at_prior, const RateStream::State& state) {
  const bool late = state.device.front().delay.found;
  std::optional<LearntRig> rig;
  if (!at_prior) {
    rig = rig_of(stream, params, state);
    if (given != nullptr) rig->device_errors = given->device_errors;
  } else {
    const LearntRig before = known_before(given, params.model);
    rig = with_rails(before, state.rails.known);
    if (!rig && late) {
      rig = before;
      rig->rails_alone = true;
    }
  }
  if (late) rig->device_errors = stream.sensor_errors(state);
  return rig;
}

}  // namespace

namespace {

Estimate rates_of_stream(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                         std::optional<LearntRig>* found) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  RegimeStream::Params params = stream_params(sensors, parameters, given);
  std::vector<std::vector<AuxiliaryReading>> auxiliary_imus;
  estimate.status = auxiliary_readings(sensors, samples, params.rate.model, auxiliary_imus);
  if (!estimate.status.ok()) return estimate;
  // Auxiliary IMUs determine the rate even if the body is hand-held, but the hand-held smoother does not use auxiliary
  // IMUs.
  if (!auxiliary_imus.empty() && !parameters.has("carried_min")) params.carried_min = 1.0;
  const RegimeStream joined(params);
  const RateStream& stream = joined.rate();
  RegimeStream::State all = joined.start();
  estimate.rates.reserve(samples.size());
  std::optional<RateState> out;
  std::vector<AuxiliaryReading> beside(auxiliary_imus.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (std::size_t i = 0; i < beside.size(); ++i) beside[i] = auxiliary_imus[i][k];
    estimate.status = joined.push(samples[k], beside, all, out);
    if (!estimate.status.ok()) break;
    if (out) estimate.rates.push_back(*out);
  }
  joined.flush(all, estimate.rates);
  const RateStream::State& state = all.rate;
  // If the constants were reset, they may not have been estimated since then.
  const RigConstants::Matrix before = stream.start().rig_covariance;
  const bool at_prior = !(state.rig_covariance.topLeftCorner<3, 3>().trace() < before.topLeftCorner<3, 3>().trace());
  estimate.health["calibration_at_prior"] = at_prior ? 1.0 : 0.0;
  estimate.health["rig_resets"] = static_cast<double>(state.rig_resets);
  estimate.health["device_unlike"] = state.device.front().posterior.unlike;
  const KnownSensorErrors device = stream.sensor_errors(state);
  constexpr int kDelay = SensorErrors::kDelay;
  estimate.health["accel_delay_s"] = device.errors.accel_delay_s;
  estimate.health["accel_delay_sigma_s"] = std::sqrt(device.covariance(kDelay, kDelay));
  estimate.health["steps_skipped"] = static_cast<double>(state.failures);
  report_rails(state.rails.known, estimate.health);
  std::optional<double> carried_share;
  if (all.reported > 0) {
    const double each = 1.0 / static_cast<double>(all.reported);
    estimate.health["regime_flight_share"] = each * all.sum.flight;
    estimate.health["regime_contact_share"] = each * all.sum.contact;
    carried_share = each * all.sum.carried;
    estimate.health["regime_carried_share"] = *carried_share;
  }
  estimate.health["regime_carried_joined"] = static_cast<double>(all.joined);
  estimate.health["regime_carried_starts"] = static_cast<double>(all.starts);
  estimate.health["carried_steps_skipped"] = static_cast<double>(all.carried.failures);
  estimate.health["carried_revolutions_open"] = static_cast<double>(all.carried.revolutions_open);
  if (estimate.status.ok() && found != nullptr) {
    if (std::optional<LearntRig> rig = learnt_by(stream, params.rate, given, at_prior, state)) *found = std::move(rig);
  }
  if (estimate.status.ok()) {
    (void)check_rates(sensors, samples, carried_share,
                      estimate);  // reported only, because the results are already final
    (void)report_frozen_axes(sensors, samples, estimate);
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Estimate run_rate_tumble_lag(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                             std::optional<LearntRig>* found) {
  return without_outliers(sensors, [&](const sim::Sensors& kept) {
    return with_sample_times(
        kept, [&](const sim::Sensors& timed) { return rates_of_stream(timed, parameters, given, found); });
  });
}

Method rate_tumble_lag() {
  MethodInfo info;
  info.name = "tumble_lag";
  info.kind = Kind::rate;
  info.doc = "The smoother of rate/tumble as a stream: the same factors in a sliding window, with a fixed lag.";
  info.ours = true;
  info.settings = {&rate_tumble_lag_settings()};
  info.robots = {"rig", "pendulum"};
  info.learns_rig = true;
  return make_method(std::move(info),
                     [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
                       return run_rate_tumble_lag(sensors, parameters, nullptr, nullptr);
                     });
}

}  // namespace tumble::scenarios
