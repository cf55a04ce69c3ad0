// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/report_rates.hpp"
#include "scenarios/methods/sample_times.hpp"

namespace tumble::scenarios {

// A range or noise density of 0 means that the data sheet lacks this value; the smoother then uses its default.
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

const CalibratedRig* RigCalibrationUse::found() const {
  const bool more = of_batch && of_batch->only_saturation_limits && of_stream && !of_stream->only_saturation_limits;
  if (of_batch && !more) return &*of_batch;
  return of_stream ? &*of_stream : nullptr;
}

namespace {

/// Returns false, and adds a health finding, if the saved calibration and the calibration that was estimated without it
/// cannot belong to one rig.
bool may_be_of_this_rig(const CalibratedRig& given, const std::optional<CalibratedRig>& fresh, Estimate& result) {
  constexpr double kDistanceMax = 2.0;  // standard deviations
  if (!fresh || fresh->only_saturation_limits) return true;
  const double distance = calibration_distance(given.calibration, fresh->calibration);
  if (distance <= kDistanceMax) return true;
  SensorHealth health;
  health.add(HealthFinding::Kind::rig_calibration,
             {ErrorCode::out_of_range,
              "difference between the calibration in the --learnt file and the calibration of this run, in standard "
              "deviations",
              distance, kDistanceMax},
             "imu");
  add_finding(health.findings.front(), result);
  return false;
}

}  // namespace

Method calibrating_method(const Method& method, RigCalibrationUse& learning) {
  const std::string name = full_name(method.info);
  const bool batch = name == "rate/tumble";
  if (!batch && name != "rate/tumble_lag") {
    throw BadInput(fmt::format("method '{}' does not calibrate the rig; use 'rate/tumble' or 'rate/tumble_lag'", name));
  }
  Method out = method;
  out.run = with_settings(
      method.info, [batch, &learning](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
        const CalibratedRig* const start = learning.given ? &*learning.given : nullptr;
        std::optional<CalibratedRig> rig;
        const auto run = batch ? run_rate_tumble : run_rate_tumble_lag;
        Estimate estimate = run(sensors, parameters, start, &rig);
        bool of_this_rig = true;
        if (start != nullptr && estimate.status.ok()) {
          std::optional<CalibratedRig> fresh;
          run(sensors, parameters, nullptr, &fresh);
          of_this_rig = may_be_of_this_rig(*start, fresh, estimate);
        }
        if (rig && of_this_rig) (batch ? learning.of_batch : learning.of_stream) = rig;
        return estimate;
      });
  return out;
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

Estimate rates_of_batch(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                        std::optional<CalibratedRig>* found) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples, bridge::kAnyGapS);
  if (estimate.status.ok()) {
    AngularRateSmoother::Params params = smoother_params(sensors.imus.front(), rate_tumble_settings(), parameters);
    if (given != nullptr) apply_saved_calibration(*given, params);
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
      if (std::optional<CalibratedRig> rig = calibrated_rig(report.rate, given, params.model); rig && found != nullptr)
        *found = std::move(rig);
    }
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const CalibratedRig* given,
                         std::optional<CalibratedRig>* found) {
  return without_outliers(sensors, [&](const sim::Sensors& kept) {
    return with_sample_times(
        kept, [&](const sim::Sensors& timed) { return rates_of_batch(timed, parameters, given, found); });
  });
}

Method rate_tumble() {
  return make_method(
      {.name = "tumble",
       .kind = Kind::rate,
       .doc = "Smooths the rates of the whole recording with bounds from clipped readings, the specific force at the "
              "lever arm "
              "in free flight, and Euler's equation. The method also calibrates the rig (lever arm, biases, inertia "
              "ratios, gyro axis directions). The method uses all IMUs on the body except the comparison IMU "
              "'imu_reference'. During hand-held motion, the method runs the hand-held smoother.",
       .ours = true,
       .source = "ours: extends Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024",
       .settings = {&rate_tumble_settings()},
       .robots = {"rig", "pendulum", "sphere"},
       .calibrates_rig = true},
      [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
        return run_rate_tumble(sensors, parameters, nullptr, nullptr);
      });
}

}  // namespace tumble::scenarios
