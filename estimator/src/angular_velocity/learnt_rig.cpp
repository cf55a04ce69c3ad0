// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/learnt_rig.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

namespace {

constexpr double kNextRunInflation = 4.0;
// In six runs of one hand-held device, a gyro's cross-axis sensitivity ranged from 0.017 to 0.021.
constexpr double kElementDrift = 2e-3;
constexpr double kSlopeDrift = 2e-3;
// Saturation planes with log odds below kCertainLogOdds are not saved for the next run. Near a maximum of rate or
// force, unsaturated readings can by chance be close to one plane.
constexpr double kCertainLogOdds = 10.0;
// smallest standard deviation of a cross-axis sensitivity: rails.md (R59)
constexpr double kSlopeSigmaMin = 3e-4;

std::optional<double> lowest_saturation_limit(const CalibratedRig& rig, std::size_t first) {
  std::optional<double> out;
  for (std::size_t j = first; j < first + 3; ++j) {
    if (rig.saturation_limits[j] && (!out || *rig.saturation_limits[j] < *out)) out = rig.saturation_limits[j];
  }
  return out;
}

// The saturation level of a sensor is stable to 0.05 %, but the bias of the sensor shifts its saturated readings.
constexpr double kLevelToleranceRatio = 2e-3;

// If two sensing elements always clip at the same time, the readings determine neither their cross-axis sensitivity nor
// their saturation level.
bool is_level_known(const SaturationPlane& plane, int sign) {
  const Eigen::Vector4d cut(0.0, 0.0, sign, 1.0);
  const double variance = cut.dot(plane.covariance * cut),
               most = 0.5 * kLevelToleranceRatio * plane.saturation_limit_rad_s;
  return variance <= most * most;
}

}  // namespace

CalibratedRig calibrated_rig(const AngularRateReport& report) {
  CalibratedRig out{report.calibration, report.saturation_limits};
  out.known_sensor_errors = report.sensor_errors;
  if (!report.clips_after_compensation) out.keep_prior_planes(report.gyro_planes);
  out.keep_prior_planes(report.accel_saturation_planes, Triad::accelerometer);
  return out;
}

void CalibratedRig::keep_prior_planes(const SaturationPlanes& planes, Triad triad) {
  Planes& kept = triad == Triad::gyro ? gyro_saturation_planes_rad_s : accel_saturation_planes_m_s2;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::optional<SaturationPlane>& plane = planes.sensing_axis[j];
    if (plane && plane->log_odds < kCertainLogOdds) {
      const double sigma = AngularRateModelParams{}.element_sigma;
      const Eigen::Index at = RigConstants::kGyroMisalignment + 2 * static_cast<Eigen::Index>(j);
      if (triad == Triad::gyro) calibration.covariance.diagonal().segment<2>(at).array() += sigma * sigma;
      continue;
    }
    for (const int sign : {-1, 1}) {
      if (plane && plane->was_reached(sign) && is_level_known(*plane, sign)) {
        kept[j][sign > 0 ? 1 : 0] = plane->offset_rad_s + sign * plane->saturation_limit_rad_s;
      }
    }
    if (!plane || triad == Triad::gyro) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      accel_misalignment[static_cast<Eigen::Index>(2 * j + i)] = plane->row[static_cast<Eigen::Index>((j + 1 + i) % 3)];
    }
  }
}

namespace {

void store_saturation_limit(const SaturationPlane& plane, Triad triad, std::size_t j, CalibratedRig& rig) {
  const auto first = static_cast<Eigen::Index>(2 * j), at = RigConstants::kGyroMisalignment + first;
  const Eigen::Vector2d slopes(plane.row[static_cast<Eigen::Index>((j + 1) % 3)],
                               plane.row[static_cast<Eigen::Index>((j + 2) % 3)]);
  rig.saturation_limits[triad == Triad::gyro ? j : j + 3] = plane.saturation_limit_rad_s;
  if (triad == Triad::accelerometer) {
    rig.accel_misalignment.segment<2>(first) = slopes;
    return;
  }
  rig.calibration.constants.gyro_misalignment.segment<2>(first) = slopes;
  RigConstants::Matrix& covariance = rig.calibration.covariance;
  covariance.middleRows<2>(at).setZero();
  covariance.middleCols<2>(at).setZero();
  covariance.block<2, 2>(at, at) =
      plane.covariance.topLeftCorner<2, 2>() + kSlopeSigmaMin * kSlopeSigmaMin * Eigen::Matrix2d::Identity();
}

}  // namespace

std::optional<CalibratedRig> calibration_with_saturation_limits(const CalibratedRig& before,
                                                                const SaturationLevels& rails) {
  CalibratedRig found, out = before;
  if (!rails.gyro_clips_after_compensation) found.keep_prior_planes(rails.gyro_planes);
  if (!rails.accel_clips_after_compensation)
    found.keep_prior_planes(rails.accel_saturation_planes, Triad::accelerometer);
  out.only_saturation_limits = true;
  bool sure = false;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    const bool gyro = triad == Triad::gyro;
    const CalibratedRig::Planes& now = gyro ? found.gyro_saturation_planes_rad_s : found.accel_saturation_planes_m_s2;
    CalibratedRig::Planes& kept = gyro ? out.gyro_saturation_planes_rad_s : out.accel_saturation_planes_m_s2;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<SaturationPlane>& plane =
          (gyro ? rails.gyro_planes : rails.accel_saturation_planes).sensing_axis[j];
      for (std::size_t i = 0; i < 2; ++i) {
        if (now[j][i] || !plane || plane->samples[i] == 0) kept[j][i] = now[j][i];
      }
      if (!now[j][0] && !now[j][1]) continue;
      store_saturation_limit(*plane, triad, j, out);
      sure = true;
    }
  }
  return sure ? std::optional(out) : std::nullopt;
}

SaturationPlanes CalibratedRig::saturation_planes(Triad triad) const {
  constexpr double kDistanceShare = 1e-3;
  const bool gyro = triad == Triad::gyro;
  const RigConstants of_accel{.gyro_misalignment = accel_misalignment};
  SaturationPlanes out;
  for (int j = 0; j < 3; ++j) {
    const auto& [low, high] =
        (gyro ? gyro_saturation_planes_rad_s : accel_saturation_planes_m_s2)[static_cast<std::size_t>(j)];
    if (!low && !high) continue;
    const Eigen::Index first = RigConstants::kGyroMisalignment + 2 * j;
    SaturationPlane plane;
    plane.row = (gyro ? calibration.constants : of_accel).sensing_direction(j);
    plane.saturation_limit_rad_s = low && high ? 0.5 * (*high - *low) : low ? -*low : *high;
    plane.offset_rad_s = low && high ? 0.5 * (*high + *low) : 0.0;
    const double sigma = kDistanceShare * plane.saturation_limit_rad_s;
    plane.covariance.diagonal() << 0.0, 0.0, sigma * sigma, sigma * sigma;
    plane.covariance.topLeftCorner<2, 2>() =
        gyro ? Eigen::Matrix2d(calibration.covariance.block<2, 2>(first, first))
             : Eigen::Matrix2d(kSlopeDrift * kSlopeDrift * Eigen::Matrix2d::Identity());
    plane.samples = {low ? 1 : 0, high ? 1 : 0};
    plane.log_odds = kCertainLogOdds;
    plane.tolerance_rad_s = kLevelToleranceRatio * plane.saturation_limit_rad_s;
    plane.deviation_rad_s = 0.25 * plane.tolerance_rad_s;
    out.sensing_axis[static_cast<std::size_t>(j)] = plane;
  }
  return out;
}

void start_from_calibration(const CalibratedRig& rig, double trust, AngularRateSmoother::Params& params) {
  if (!(trust >= 1.0)) throw std::invalid_argument("trust is " + std::to_string(trust) + "; it must be at least 1");
  params.model.calibration = rig.calibration;
  params.model.calibration->covariance *= trust;
  params.expert.gyro_planes.known_limits = rig.saturation_planes();
  params.expert.accel_saturation_planes.known_limits = rig.saturation_planes(Triad::accelerometer);
  for (SaturationPlanes* const known :
       {&params.expert.gyro_planes.known_limits, &params.expert.accel_saturation_planes.known_limits}) {
    for (std::optional<SaturationPlane>& plane : known->sensing_axis) {
      if (plane) plane->covariance *= trust;
    }
  }
  if (rig.known_sensor_errors) {
    params.calibrated_errors = rig.known_sensor_errors;
    params.calibrated_errors->covariance *= trust;
  }
  if (const auto rail = lowest_saturation_limit(rig, 0)) params.saturation_detector.stated_gyro_range_rad_s = rail;
  if (const auto rail = lowest_saturation_limit(rig, 3)) params.saturation_detector.stated_accel_range_m_s2 = rail;
}

void apply_saved_calibration(const CalibratedRig& rig, AngularRateSmoother::Params& params) {
  const RigConstants::Matrix prior = AngularRateModel(params.model, 0.01).prior_covariance();
  start_from_calibration(rig, kNextRunInflation, params);
  // Biases change at every switch-on.
  constexpr int kBias = 3, kBiases = 6;
  RigConstants& constants = params.model.calibration->constants;
  constants.gyro_bias_rad_s = params.model.nominal.gyro_bias_rad_s;
  constants.accel_bias_m_s2 = params.model.nominal.accel_bias_m_s2;
  RigConstants::Matrix& covariance = params.model.calibration->covariance;
  covariance.diagonal().tail<RigConstants::kSize - RigConstants::kGyroMisalignment>().array() +=
      kElementDrift * kElementDrift;
  covariance.middleRows<kBiases>(kBias).setZero();
  covariance.middleCols<kBiases>(kBias).setZero();
  const RigConstants::Matrix floor = (1.0 - 1.0 / kNextRunInflation) * prior.inverse();
  RigConstants::Matrix filled = covariance;
  filled.block<kBiases, kBiases>(kBias, kBias).setIdentity();
  RigConstants::Matrix information = filled.inverse() + floor;
  information.block<kBiases, kBiases>(kBias, kBias) = prior.block<kBiases, kBiases>(kBias, kBias).inverse();
  covariance = information.inverse();
}

CalibratedRig prior_rig_calibration(const CalibratedRig* given, const AngularRateModelParams& model) {
  if (given != nullptr) return *given;
  const AngularRateModel assumed(model, 0.01);
  return {{assumed.prior_constants(), assumed.prior_covariance()}, {}};
}

void apply_saved_calibration(const CalibratedRig& rig, AngularRateStream::Params& params) {
  AngularRateSmoother::Params batch;
  batch.model = params.model;
  batch.saturation_detector = params.saturation_detector;
  batch.expert.gyro_planes = params.expert.gyro_planes;
  batch.expert.accel_saturation_planes = params.expert.accel_saturation_planes;
  apply_saved_calibration(rig, batch);
  params.model = batch.model;
  params.saturation_detector = batch.saturation_detector;
  params.expert.gyro_planes = batch.expert.gyro_planes;
  params.expert.accel_saturation_planes = batch.expert.accel_saturation_planes;
  if (batch.calibrated_errors) params.calibrated_errors = std::make_shared<KnownSensorErrors>(*batch.calibrated_errors);
}

std::optional<CalibratedRig> calibrated_rig(const AngularRateReport& report, const CalibratedRig* given,
                                            const AngularRateModelParams& model) {
  if (!report.calibration_at_prior) return calibrated_rig(report);
  SaturationLevels rails;
  rails.gyro_planes = report.gyro_planes;
  rails.gyro_clips_after_compensation = report.clips_after_compensation;
  rails.accel_saturation_planes = report.accel_saturation_planes;
  return calibration_with_saturation_limits(prior_rig_calibration(given, model), rails);
}

bool is_at_prior(const AngularRateStream& stream, const AngularRateStream::State& state) {
  const RigConstants::Matrix before = stream.start().rig_covariance;
  return !(state.rig_covariance.topLeftCorner<3, 3>().trace() < before.topLeftCorner<3, 3>().trace());
}

namespace {

CalibratedRig stream_calibration(const AngularRateStream& stream, const AngularRateStream::Params& params,
                                 const AngularRateStream::State& state) {
  CalibratedRig rig{stream.calibration(state), {}};
  const SaturationLimitDetector axis_aligned_rails(params.saturation_detector);
  const SaturationLevels& known = state.clipping_state.known_limits;
  for (int c = 0; c < 6; ++c) {
    std::optional<double>& rail = rig.saturation_limits[static_cast<std::size_t>(c)];
    rail = axis_aligned_rails.saturation_limit(known.axis_limit_state, c);
    const auto& plane =
        (c < 3 ? known.gyro_planes : known.accel_saturation_planes).sensing_axis[static_cast<std::size_t>(c % 3)];
    if (plane) rail = plane->saturation_limit_rad_s;
  }
  if (!known.gyro_clips_after_compensation) rig.keep_prior_planes(known.gyro_planes);
  if (!known.accel_clips_after_compensation) rig.keep_prior_planes(known.accel_saturation_planes, Triad::accelerometer);
  return rig;
}

}  // namespace

std::optional<CalibratedRig> calibrated_rig(const AngularRateStream& stream, const AngularRateStream::Params& params,
                                            const CalibratedRig* given, const AngularRateStream::State& state) {
  const bool late = state.sensor_errors.front().accel_delay_state.delay_found;
  std::optional<CalibratedRig> rig;
  if (!is_at_prior(stream, state)) {
    rig = stream_calibration(stream, params, state);
    if (given != nullptr) rig->known_sensor_errors = given->known_sensor_errors;
  } else {
    const CalibratedRig before = prior_rig_calibration(given, params.model);
    rig = calibration_with_saturation_limits(before, state.clipping_state.known_limits);
    if (!rig && late) {
      rig = before;
      rig->only_saturation_limits = true;
    }
  }
  if (late) rig->known_sensor_errors = stream.sensor_errors(state);
  return rig;
}

double calibration_distance(const RigCalibration& before, const RigCalibration& now) {
  const RigConstants::Vector apart = now.constants.vector() - before.constants.vector();
  const RigConstants::Matrix spread = kNextRunInflation * before.covariance + now.covariance;
  const auto of = [&]<int kFirst, int kCount>() {
    const Eigen::Matrix<double, kCount, 1> part = apart.segment<kCount>(kFirst);
    const Eigen::Matrix<double, kCount, kCount> block = spread.block<kCount, kCount>(kFirst, kFirst);
    return std::sqrt(part.dot(block.llt().solve(part)) / kCount);
  };
  constexpr int kInertia = 9, kInertias = RigConstants::kGyroMisalignment - kInertia;
  return std::max(of.operator()<0, 3>(), of.operator()<kInertia, kInertias>());
}

}  // namespace tumble
