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
// At a maximum of the motion, readings can resemble a plane of saturated readings.
constexpr double kCertainLogOdds = 10.0;
// smallest standard deviation of a cross-axis sensitivity: rails.md (R59)
constexpr double kSlopeSigmaMin = 3e-4;

std::optional<double> lowest_rail(const CalibratedRig& rig, std::size_t first) {
  std::optional<double> out;
  for (std::size_t j = first; j < first + 3; ++j) {
    if (rig.rail[j] && (!out || *rig.rail[j] < *out)) out = rig.rail[j];
  }
  return out;
}

// Saturation levels are stable to 0.05 %, but the sensor's bias shifts saturated readings.
constexpr double kLevelToleranceRatio = 2e-3;

// If two sensing elements only clip together, the readings determine neither their cross-axis sensitivity nor their
// saturation level.
bool is_level_known(const RailPlane& plane, int sign) {
  const Eigen::Vector4d cut(0.0, 0.0, sign, 1.0);
  const double variance = cut.dot(plane.covariance * cut), most = 0.5 * kLevelToleranceRatio * plane.distance_rad_s;
  return variance <= most * most;
}

}  // namespace

CalibratedRig learnt(const RateReport& report) {
  CalibratedRig out{report.calibration, report.rail};
  out.device_errors = report.sensor_errors;
  if (!report.clips_after_compensation) out.keep(report.planes);
  out.keep(report.accel_planes, Triad::accelerometer);
  return out;
}

void CalibratedRig::keep(const RailPlanes& planes, Triad triad) {
  Planes& kept = triad == Triad::gyro ? gyro_planes_rad_s : accelerometer_planes_m_s2;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = planes.element[j];
    if (plane && plane->log_odds < kCertainLogOdds) {
      const double sigma = RateModelParams{}.element_sigma;
      const Eigen::Index at = RigConstants::kElements + 2 * static_cast<Eigen::Index>(j);
      if (triad == Triad::gyro) calibration.covariance.diagonal().segment<2>(at).array() += sigma * sigma;
      continue;
    }
    for (const int sign : {-1, 1}) {
      if (plane && plane->seen(sign) && is_level_known(*plane, sign)) {
        kept[j][sign > 0 ? 1 : 0] = plane->offset_rad_s + sign * plane->distance_rad_s;
      }
    }
    if (!plane || triad == Triad::gyro) continue;
    for (std::size_t i = 0; i < 2; ++i) {
      accelerometer_elements[static_cast<Eigen::Index>(2 * j + i)] =
          plane->row[static_cast<Eigen::Index>((j + 1 + i) % 3)];
    }
  }
}

namespace {

void store_element(const RailPlane& plane, Triad triad, std::size_t j, CalibratedRig& rig) {
  const auto first = static_cast<Eigen::Index>(2 * j), at = RigConstants::kElements + first;
  const Eigen::Vector2d slopes(plane.row[static_cast<Eigen::Index>((j + 1) % 3)],
                               plane.row[static_cast<Eigen::Index>((j + 2) % 3)]);
  rig.rail[triad == Triad::gyro ? j : j + 3] = plane.distance_rad_s;
  if (triad == Triad::accelerometer) {
    rig.accelerometer_elements.segment<2>(first) = slopes;
    return;
  }
  rig.calibration.constants.elements.segment<2>(first) = slopes;
  RigConstants::Matrix& covariance = rig.calibration.covariance;
  covariance.middleRows<2>(at).setZero();
  covariance.middleCols<2>(at).setZero();
  covariance.block<2, 2>(at, at) =
      plane.covariance.topLeftCorner<2, 2>() + kSlopeSigmaMin * kSlopeSigmaMin * Eigen::Matrix2d::Identity();
}

}  // namespace

std::optional<CalibratedRig> calibration_with_rails(const CalibratedRig& before, const SaturationLevels& rails) {
  CalibratedRig found, out = before;
  if (!rails.gyro_clips_after_compensation) found.keep(rails.planes);
  if (!rails.accel_clips_after_compensation) found.keep(rails.accel_planes, Triad::accelerometer);
  out.only_rails = true;
  bool sure = false;
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    const bool gyro = triad == Triad::gyro;
    const CalibratedRig::Planes& now = gyro ? found.gyro_planes_rad_s : found.accelerometer_planes_m_s2;
    CalibratedRig::Planes& kept = gyro ? out.gyro_planes_rad_s : out.accelerometer_planes_m_s2;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<RailPlane>& plane = (gyro ? rails.planes : rails.accel_planes).element[j];
      for (std::size_t i = 0; i < 2; ++i) {
        if (now[j][i] || !plane || plane->samples[i] == 0) kept[j][i] = now[j][i];
      }
      if (!now[j][0] && !now[j][1]) continue;
      store_element(*plane, triad, j, out);
      sure = true;
    }
  }
  return sure ? std::optional(out) : std::nullopt;
}

RailPlanes CalibratedRig::planes(Triad triad) const {
  constexpr double kDistanceShare = 1e-3;
  const bool gyro = triad == Triad::gyro;
  const RigConstants of_accel{.elements = accelerometer_elements};
  RailPlanes out;
  for (int j = 0; j < 3; ++j) {
    const auto& [low, high] = (gyro ? gyro_planes_rad_s : accelerometer_planes_m_s2)[static_cast<std::size_t>(j)];
    if (!low && !high) continue;
    const Eigen::Index first = RigConstants::kElements + 2 * j;
    RailPlane plane;
    plane.row = (gyro ? calibration.constants : of_accel).sensing_direction(j);
    plane.distance_rad_s = low && high ? 0.5 * (*high - *low) : low ? -*low : *high;
    plane.offset_rad_s = low && high ? 0.5 * (*high + *low) : 0.0;
    const double sigma = kDistanceShare * plane.distance_rad_s;
    plane.covariance.diagonal() << 0.0, 0.0, sigma * sigma, sigma * sigma;
    plane.covariance.topLeftCorner<2, 2>() =
        gyro ? Eigen::Matrix2d(calibration.covariance.block<2, 2>(first, first))
             : Eigen::Matrix2d(kSlopeDrift * kSlopeDrift * Eigen::Matrix2d::Identity());
    plane.samples = {low ? 1 : 0, high ? 1 : 0};
    plane.log_odds = kCertainLogOdds;
    plane.tolerance_rad_s = kLevelToleranceRatio * plane.distance_rad_s;
    plane.deviation_rad_s = 0.25 * plane.tolerance_rad_s;
    out.element[static_cast<std::size_t>(j)] = plane;
  }
  return out;
}

void start_from(const CalibratedRig& rig, double trust, RateSmoother::Params& params) {
  if (!(trust >= 1.0)) throw std::invalid_argument("trust is " + std::to_string(trust) + "; it must be at least 1");
  params.model.calibration = rig.calibration;
  params.model.calibration->covariance *= trust;
  params.expert.planes.known = rig.planes();
  params.expert.accel_planes.known = rig.planes(Triad::accelerometer);
  for (RailPlanes* const known : {&params.expert.planes.known, &params.expert.accel_planes.known}) {
    for (std::optional<RailPlane>& plane : known->element) {
      if (plane) plane->covariance *= trust;
    }
  }
  if (rig.device_errors) {
    params.calibrated_errors = rig.device_errors;
    params.calibrated_errors->covariance *= trust;
  }
  if (const auto rail = lowest_rail(rig, 0)) params.rails.stated_gyro_rad_s = rail;
  if (const auto rail = lowest_rail(rig, 3)) params.rails.stated_accel_m_s2 = rail;
}

void apply_saved_calibration(const CalibratedRig& rig, RateSmoother::Params& params) {
  const RigConstants::Matrix prior = RateModel(params.model, 0.01).prior_covariance();
  start_from(rig, kNextRunInflation, params);
  // Biases change at every switch-on.
  constexpr int kBias = 3, kBiases = 6;
  RigConstants& constants = params.model.calibration->constants;
  constants.gyro_bias_rad_s = params.model.nominal.gyro_bias_rad_s;
  constants.accel_bias_m_s2 = params.model.nominal.accel_bias_m_s2;
  RigConstants::Matrix& covariance = params.model.calibration->covariance;
  covariance.diagonal().tail<RigConstants::kSize - RigConstants::kElements>().array() += kElementDrift * kElementDrift;
  covariance.middleRows<kBiases>(kBias).setZero();
  covariance.middleCols<kBiases>(kBias).setZero();
  const RigConstants::Matrix floor = (1.0 - 1.0 / kNextRunInflation) * prior.inverse();
  RigConstants::Matrix filled = covariance;
  filled.block<kBiases, kBiases>(kBias, kBias).setIdentity();
  RigConstants::Matrix information = filled.inverse() + floor;
  information.block<kBiases, kBiases>(kBias, kBias) = prior.block<kBiases, kBiases>(kBias, kBias).inverse();
  covariance = information.inverse();
}

CalibratedRig prior_rig_calibration(const CalibratedRig* given, const RateModelParams& model) {
  if (given != nullptr) return *given;
  const RateModel assumed(model, 0.01);
  return {{assumed.prior_constants(), assumed.prior_covariance()}, {}};
}

void apply_saved_calibration(const CalibratedRig& rig, RateStream::Params& params) {
  RateSmoother::Params batch;
  batch.model = params.model;
  batch.rails = params.rails;
  batch.expert.planes = params.expert.planes;
  batch.expert.accel_planes = params.expert.accel_planes;
  apply_saved_calibration(rig, batch);
  params.model = batch.model;
  params.rails = batch.rails;
  params.expert.planes = batch.expert.planes;
  params.expert.accel_planes = batch.expert.accel_planes;
  if (batch.calibrated_errors) params.calibrated_errors = std::make_shared<KnownSensorErrors>(*batch.calibrated_errors);
}

std::optional<CalibratedRig> learnt(const RateReport& report, const CalibratedRig* given,
                                    const RateModelParams& model) {
  if (!report.calibration_at_prior) return learnt(report);
  SaturationLevels rails;
  rails.planes = report.planes;
  rails.gyro_clips_after_compensation = report.clips_after_compensation;
  rails.accel_planes = report.accel_planes;
  return calibration_with_rails(prior_rig_calibration(given, model), rails);
}

bool is_at_prior(const RateStream& stream, const RateStream::State& state) {
  const RigConstants::Matrix before = stream.start().rig_covariance;
  return !(state.rig_covariance.topLeftCorner<3, 3>().trace() < before.topLeftCorner<3, 3>().trace());
}

namespace {

CalibratedRig stream_calibration(const RateStream& stream, const RateStream::Params& params,
                                 const RateStream::State& state) {
  CalibratedRig rig{stream.calibration(state), {}};
  const RailDetector axis_aligned_rails(params.rails);
  const SaturationLevels& known = state.rails.known;
  for (int c = 0; c < 6; ++c) {
    std::optional<double>& rail = rig.rail[static_cast<std::size_t>(c)];
    rail = axis_aligned_rails.rail(known.axis_aligned_rails, c);
    const auto& plane = (c < 3 ? known.planes : known.accel_planes).element[static_cast<std::size_t>(c % 3)];
    if (plane) rail = plane->distance_rad_s;
  }
  if (!known.gyro_clips_after_compensation) rig.keep(known.planes);
  if (!known.accel_clips_after_compensation) rig.keep(known.accel_planes, Triad::accelerometer);
  return rig;
}

}  // namespace

std::optional<CalibratedRig> learnt(const RateStream& stream, const RateStream::Params& params,
                                    const CalibratedRig* given, const RateStream::State& state) {
  const bool late = state.device.front().delay.found;
  std::optional<CalibratedRig> rig;
  if (!is_at_prior(stream, state)) {
    rig = stream_calibration(stream, params, state);
    if (given != nullptr) rig->device_errors = given->device_errors;
  } else {
    const CalibratedRig before = prior_rig_calibration(given, params.model);
    rig = calibration_with_rails(before, state.rails.known);
    if (!rig && late) {
      rig = before;
      rig->only_rails = true;
    }
  }
  if (late) rig->device_errors = stream.sensor_errors(state);
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
  constexpr int kInertia = 9, kInertias = RigConstants::kElements - kInertia;
  return std::max(of.operator()<0, 3>(), of.operator()<kInertia, kInertias>());
}

}  // namespace tumble
