// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/rate_regimes.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/report_rails.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble::scenarios {

// A range or density of 0 means that the data sheet states no value. The smoother then assumes no range, or the
// library's default density.
RateSmoother::Params stated_params(const sim::ImuRecord& record, RateSmoother::Params params) {
  RateModelParams& model = params.model;
  model.nominal.lever_arm_m = bridge::lever_arm_I_m(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) model.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  if (record.accel_noise_m_s2_sqrt_hz > 0.0) model.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
  params.rails = stated_rails(record);
  return params;
}

RateSmoother::Params smoother_params(const sim::ImuRecord& record, const Settings<RateSmoother::Params>& settings,
                                     const sim::Values& parameters) {
  RateSmoother::Params params = stated_params(record, settings.defaults());
  settings.apply(parameters, params);
  return params;
}

Status auxiliary_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateModelParams& model,
                          std::vector<std::vector<AuxiliaryReading>>& out) {
  out.clear();
  const sim::ImuRecord& primary = sensors.imus.front();
  for (std::size_t i = 1; i < sensors.imus.size() && out.size() < kAuxiliaryImusMax; ++i) {
    const sim::ImuRecord& record = sensors.imus[i];
    if (record.name == "imu_reference") continue;  // reference IMU, for comparisons only
    std::vector<ImuSample> readings;
    if (Status status = bridge::imu_samples(record, readings); !status.ok()) return status;
    AuxiliaryImu auxiliary_imu;
    auxiliary_imu.T_IC = primary.T_BI.inverse(Eigen::Isometry) * record.T_BI;
    if (record.gyro_noise_rad_s_sqrt_hz > 0.0) auxiliary_imu.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
    if (record.accel_noise_m_s2_sqrt_hz > 0.0) auxiliary_imu.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
    std::vector<AuxiliaryReading> aligned;
    ClippingFinder::Params clipping;
    clipping.upright_rails = stated_rails(record);
    const ClippingFinder::Found found = ClippingFinder(clipping).find(readings);
    auxiliary_imu.gyro_elements = found.rails.rows(Triad::gyro, model.element_sigma);
    auxiliary_imu.accel_elements = found.rails.rows(Triad::accelerometer, model.element_sigma);
    const Status status = align(auxiliary_imu, readings, found.clippings, samples, bridge::kGapMaxS, aligned);
    if (!status.ok()) return status;
    model.auxiliary_imus.push_back(auxiliary_imu);
    out.push_back(std::move(aligned));
  }
  return {};
}

namespace {

/// Reports whether the smoother's unit check failed or passed.
void report_unit(Doubt::About unit, bool suspect, Estimate& result) {
  suspect ? add_doubt({unit}, result) : report_no_doubt(unit, result);
}

void report_health(const RateReport& report, Estimate& result) {
  std::map<std::string, double>& health = result.health;
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["restarts"] = report.restarts;
  health["calibration_mahalanobis"] = report.calibration_mahalanobis;
  health["calibration_at_prior"] = report.calibration_at_prior ? 1.0 : 0.0;
  health["flight_share"] = report.flight_share;
  health["readings_missing"] = static_cast<double>(report.missing_readings);
  health["rails_disagreeing"] = static_cast<double>(
      std::count(report.contradicts_stated_range.begin(), report.contradicts_stated_range.end(), true));
  constexpr int kDelay = SensorErrors::kDelay;
  health["accel_delay_s"] = report.sensor_errors.errors.accel_delay_s;
  health["accel_delay_sigma_s"] = std::sqrt(report.sensor_errors.covariance(kDelay, kDelay));
  health["device_calibrated"] = report.data_sheet_probability;
  health["triads_together"] = report.synchronous_probability;
  health["error_rounds"] = report.error_rounds;
  health["gyro_update_s"] = report.gyro_update_s;
  health["accel_update_s"] = report.accel_update_s;
  health["rails_upright"] = report.clips_after_compensation ? 1.0 : 0.0;
  report_unit(Doubt::About::rate_unit, report.rate_unit_suspect, result);
  report_unit(Doubt::About::force_unit, report.force_unit_suspect, result);
  const char* const names[] = {"x", "y", "z"};
  for (int j = 0; j < 3; ++j) {
    const std::string axis = names[j];
    health["learnt_lever_arm_" + axis + "_m"] = report.calibration.constants.lever_arm_m[j];
    health["learnt_lever_arm_sigma_" + axis + "_m"] = std::sqrt(report.calibration.covariance(j, j));
  }
  report_rails(report, health);
}

constexpr double kTrust = 4.0;
// Standard deviation of the change of a gyro's cross-axis sensitivity between runs. In six runs of a hand-held device,
// the cross-axis sensitivity was 0.017 to 0.021.
constexpr double kElementDrift = 2e-3;

}  // namespace

const std::vector<std::string>& stated_densities() {
  static const std::vector<std::string> names = {"gyro_noise_density", "accel_noise_density"};
  return names;
}

const Settings<RateSmoother::Params>& rate_tumble_settings() {
  static const Settings<RateSmoother::Params> all(RateSmoother::Params{}, {.stated = stated_densities()});
  return all;
}

void start_from_learnt(const LearntRig& rig, RateSmoother::Params& params) {
  const RigConstants::Matrix prior = RateModel(params.model, 0.01).prior_covariance();
  start_from(rig, kTrust, params);
  // Biases change at every switch-on, so the default prior replaces the saved covariance of the biases.
  constexpr int kBias = 3, kBiases = 6;
  RigConstants& constants = params.model.calibration->constants;
  constants.gyro_bias_rad_s = params.model.nominal.gyro_bias_rad_s;
  constants.accel_bias_m_s2 = params.model.nominal.accel_bias_m_s2;
  RigConstants::Matrix& covariance = params.model.calibration->covariance;
  covariance.diagonal().tail<RigConstants::kSize - RigConstants::kElements>().array() += kElementDrift * kElementDrift;
  covariance.middleRows<kBiases>(kBias).setZero();
  covariance.middleCols<kBiases>(kBias).setZero();
  // Limits the covariance to the default prior.
  const RigConstants::Matrix floor = (1.0 - 1.0 / kTrust) * prior.inverse();
  RigConstants::Matrix filled = covariance;
  filled.block<kBiases, kBiases>(kBias, kBias).setIdentity();
  RigConstants::Matrix information = filled.inverse() + floor;
  information.block<kBiases, kBiases>(kBias, kBias) = prior.block<kBiases, kBiases>(kBias, kBias).inverse();
  covariance = information.inverse();
}

LearntRig known_before(const LearntRig* given, const RateModelParams& model) {
  if (given != nullptr) return *given;
  const RateModel assumed(model, 0.01);
  return {{assumed.prior_constants(), assumed.prior_covariance()}, {}};
}

const LearntRig* Learning::found() const {
  const bool more = of_batch && of_batch->rails_alone && of_stream && !of_stream->rails_alone;
  if (of_batch && !more) return &*of_batch;
  return of_stream ? &*of_stream : nullptr;
}

double distance_of_rigs(const RigCalibration& before, const RigCalibration& now, double trust) {
  const RigConstants::Vector apart = now.constants.vector() - before.constants.vector();
  const RigConstants::Matrix spread = trust * before.covariance + now.covariance;
  const auto of = [&]<int kFirst, int kCount>() {
    const Eigen::Matrix<double, kCount, 1> part = apart.segment<kCount>(kFirst);
    const Eigen::Matrix<double, kCount, kCount> block = spread.block<kCount, kCount>(kFirst, kFirst);
    return std::sqrt(part.dot(block.llt().solve(part)) / kCount);
  };
  constexpr int kInertia = 9, kInertias = RigConstants::kElements - kInertia;
  return std::max(of.operator()<0, 3>(), of.operator()<kInertia, kInertias>());
}

namespace {

/// Compares a stored calibration with a calibration from a run that did not use the stored calibration. Returns false
/// and adds a failed health check if the two calibrations belong to different rigs.
bool may_be_of_this_rig(const LearntRig& given, const std::optional<LearntRig>& fresh, Estimate& result) {
  constexpr double kDistanceMax = 2.0;  // see distance_of_rigs
  report_no_doubt(Doubt::About::learnt_rig, result);
  if (!fresh || fresh->rails_alone) return true;
  const double distance = distance_of_rigs(given.calibration, fresh->calibration, kTrust);
  if (distance <= kDistanceMax) return true;
  add_doubt({Doubt::About::learnt_rig, distance}, result);
  return false;
}

}  // namespace

Method learning_method(const Method& method, Learning& learning) {
  const std::string name = full_name(method.info);
  const bool batch = name == "rate/tumble";
  if (!batch && name != "rate/tumble_lag") {
    throw BadInput("'" + name + "' does not calibrate the rig; use 'rate/tumble' or 'rate/tumble_lag'");
  }
  Method out = method;
  out.run = [name, batch, info = method.info, &learning](const sim::Sensors& sensors, const sim::Values& given,
                                                         const OracleInput&) {
    const LearntRig* const start = learning.given ? &*learning.given : nullptr;
    std::optional<LearntRig> rig;
    try {
      const sim::Values parameters = resolve_settings("method " + name, given, info.settings);
      const auto run = batch ? run_rate_tumble : run_rate_tumble_lag;
      Estimate estimate = run(sensors, parameters, start, &rig);
      bool of_this_rig = true;
      if (start != nullptr && estimate.status.ok()) {
        std::optional<LearntRig> fresh;
        run(sensors, parameters, nullptr, &fresh);
        of_this_rig = may_be_of_this_rig(*start, fresh, estimate);
      }
      if (rig && of_this_rig) (batch ? learning.of_batch : learning.of_stream) = rig;
      return estimate;
    } catch (const sim::InvalidSituation& error) {
      throw BadInput(error.what());
    } catch (const InvalidParams& error) {
      throw BadInput("method " + name + ": " + error.what());
    }
  };
  return out;
}

Status tumble_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, RateSmoother::Params params,
                    SmoothedRates& out, Estimate& result) {
  out = {};
  std::vector<std::vector<AuxiliaryReading>> auxiliary_imus;
  Status status = auxiliary_readings(sensors, samples, params.model, auxiliary_imus);
  out.auxiliary_imus = auxiliary_imus.size();
  if (status.ok()) status = RateSmoother(params).estimate(samples, auxiliary_imus, out.rates, out.report);
  if (status.ok()) {
    report_health(out.report, result);
    // Auxiliary IMUs determine the rate even if the body is hand-held, but the hand-held smoother does not use
    // auxiliary IMUs.
    if (auxiliary_imus.empty()) out.carried = join_regimes(sensors, samples, out.report, out.rates, result.health);
  }
  return status;
}

namespace {

/// Writes the calibration of a run to `found`.
void learn(const RateReport& report, const LearntRig* given, const RateModelParams& model,
           std::optional<LearntRig>& found) {
  if (!report.calibration_at_prior) {
    found = learnt(report);
    return;
  }
  SaturationLevels rails;
  rails.planes = report.planes;
  rails.upright = report.clips_after_compensation;
  rails.accel_planes = report.accel_planes;
  if (std::optional<LearntRig> rig = with_rails(known_before(given, model), rails)) found = std::move(rig);
}

Estimate rates_of_batch(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                        std::optional<LearntRig>* found) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) {
    RateSmoother::Params params = smoother_params(sensors.imus.front(), rate_tumble_settings(), parameters);
    if (given != nullptr) start_from_learnt(*given, params);
    SmoothedRates smoothed;
    estimate.status = tumble_rates(sensors, samples, params, smoothed, estimate);
    estimate.rates = std::move(smoothed.rates);
    if (estimate.status.ok()) {
      if (!check_rates(sensors, samples, smoothed.carried.share, estimate)) inflate_rates(estimate);
      inflate_frozen_rates(report_frozen_axes(sensors, samples, estimate), samples, estimate);
    }
    estimate.health["imus"] = 1.0 + static_cast<double>(smoothed.auxiliary_imus);
    if (estimate.status.ok() && found != nullptr) learn(smoothed.report, given, params.model, *found);
  }
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Estimate run_rate_tumble(const sim::Sensors& sensors, const sim::Values& parameters, const LearntRig* given,
                         std::optional<LearntRig>* found) {
  return without_outliers(sensors, [&](const sim::Sensors& kept) {
    return with_sample_times(
        kept, [&](const sim::Sensors& timed) { return rates_of_batch(timed, parameters, given, found); });
  });
}

Method rate_tumble() {
  MethodInfo info;
  info.name = "tumble";
  info.kind = Kind::rate;
  info.doc =
      "Smoother over the whole recording with bounds for clipped axes, rigid-body flight at the lever arm, Euler's "
      "equation and the rig constants. It uses further IMUs on the body (not imu_reference), and the hand-held "
      "smoother where readings indicate hand-held motion.";
  info.ours = true;
  info.source = "ours, from Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024";
  info.settings = {&rate_tumble_settings()};
  info.robots = {"rig", "pendulum"};
  info.learns_rig = true;
  return make_method(std::move(info),
                     [](const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
                       return run_rate_tumble(sensors, parameters, nullptr, nullptr);
                     });
}

}  // namespace tumble::scenarios
