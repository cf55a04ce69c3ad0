// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/imu_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tumble/attitude/timing.hpp"

namespace tumble {

namespace {

constexpr double kSmallest = 1e-12;
constexpr double kBiasSigma_rad_s = 0.01, kScaleSigma = 0.01;
constexpr double kTurning_rad_s2 = 1.0;  // an angular acceleration that tells a time offset from noise
constexpr double kBeyondDoubt = 4.0;     // sigmas
constexpr int kRecovering = 3;           // so many units tell the rate by their accelerometers
constexpr int kOffset = ImuMerge::kErrors - 1;

using Vectors = std::array<Eigen::Vector3d, ImuMerge::kImus>;

Eigen::Vector3d median(const Vectors& values, int count) {
  Eigen::Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, ImuMerge::kImus> sorted;
    sorted.fill(std::numeric_limits<double>::infinity());
    for (int k = 0; k < count; ++k) sorted[static_cast<std::size_t>(k)] = values[static_cast<std::size_t>(k)][axis];
    std::sort(sorted.begin(), sorted.end());
    out[axis] = 0.5 * (sorted[static_cast<std::size_t>((count - 1) / 2)] + sorted[static_cast<std::size_t>(count / 2)]);
  }
  return out;
}

}  // namespace

/// About the mean place of the units.
RateRecovery::Params ImuMerge::recovery_params(const Params& p) {
  RateRecovery::Params out;
  out.count = p.count;
  out.gyro_range_rad_s = p.gyro_range_rad_s;
  out.accel_range_m_s2 = p.accel_range_m_s2;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto count = static_cast<std::size_t>(std::clamp(p.count, 0, kImus));
  for (std::size_t k = 0; k < count; ++k) mean += p.T_CI[k].translation() / p.count;
  for (std::size_t k = 0; k < count; ++k) {
    out.T_CI[k] = p.T_CI[k];
    out.T_CI[k].translation() -= mean;
  }
  return out;
}

ImuMerge::ImuMerge(const Params& p) : params_(p), recovery_(recovery_params(p)) {
  require_within("count", p.count, 1, kImus);
  require_within("rate_tolerance_rad_s", p.rate_tolerance_rad_s, kSmallest, 1e3);
  require_within("rate_tolerance_share", p.rate_tolerance_share, 0.0, 1.0);
  require_within("force_tolerance_m_s2", p.force_tolerance_m_s2, kSmallest, 1e4);
  require_within("rate_noise_rad_s", p.rate_noise_rad_s, kSmallest, 10.0);
  require_within("offset_sigma_s", p.offset_sigma_s, 0.0, 0.1);
  require_within("gyro_range_rad_s", p.gyro_range_rad_s, kSmallest, 1e3);
  require_within("accel_range_m_s2", p.accel_range_m_s2, kSmallest, 1e5);
  require_within("gap_max_s", p.gap_max_s, 1e-9, 1e4);
  for (int k = 0; k < p.count; ++k) {
    const Eigen::Isometry3d& T = p.T_CI[static_cast<std::size_t>(k)];
    require_within("T_CI", T.translation().norm(), 0.0, 1e3);
    require_within("T_CI", (T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-6);
    p_C_m_ += T.translation() / p.count;
  }
}

Status ImuMerge::step(std::span<const ImuSample> samples, State& state, ImuSample& merged) const {
  const int count = params_.count;
  if (samples.size() != static_cast<std::size_t>(count)) {
    return {Trouble::too_few, "samples", static_cast<double>(samples.size()), static_cast<double>(count)};
  }
  for (const ImuSample& sample : samples) {
    if (const Status bad = check(sample); !bad.ok()) return bad;
  }
  double dt_s = 0.0;
  if (state.samples > 0) {
    const Status bad = elapsed(samples[0].time_ns, state.last_time_ns, params_.gap_max_s, dt_s);
    if (!bad.ok()) return bad;
  } else {
    for (Unit& unit : state.units) {
      unit.P.diagonal().setConstant(kScaleSigma * kScaleSigma);
      unit.P.diagonal().head<3>().setConstant(kBiasSigma_rad_s * kBiasSigma_rad_s);
      unit.P(kOffset, kOffset) = params_.offset_sigma_s * params_.offset_sigma_s;
    }
  }

  Vectors rates{}, raw_rates{}, forces{};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::Matrix3d R_CI = params_.T_CI[k].linear();
    Unit& unit = state.units[k];
    raw_rates[k] = R_CI * samples[k].angular_velocity_rad_s;
    const Eigen::Vector3d force = R_CI * samples[k].specific_force_m_s2;
    rates[k] = raw_rates[k];
    forces[k] = force;
    const double offset_s = unit.offset_s();
    const bool late = offset_s * offset_s > kBeyondDoubt * kBeyondDoubt * unit.P(kOffset, kOffset);
    if (dt_s > 0.0 && late) {
      rates[k] -= offset_s / dt_s * (raw_rates[k] - unit.last_rate_rad_s);
      forces[k] -= offset_s / dt_s * (force - unit.last_force_m_s2);
    }
    unit.last_force_m_s2 = force;
  }

  // the places differ, so forces may by what the rate makes of it; the tolerance has to bear that
  const Eigen::Vector3d middle_rate = median(rates, count), middle_force = median(forces, count);
  const double rate_tolerance = params_.rate_tolerance_rad_s + params_.rate_tolerance_share * middle_rate.norm();
  std::array<bool, kImus> used{};
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double turned = (params_.T_CI[i].translation() - p_C_m_).norm() * middle_rate.squaredNorm() * 2.0;
    used[i] = count < 3 || ((rates[i] - middle_rate).norm() < rate_tolerance &&
                            (forces[i] - middle_force).norm() < params_.force_tolerance_m_s2 + turned);
    used[i] = used[i] && samples[i].specific_force_m_s2.cwiseAbs().maxCoeff() < params_.accel_range_m_s2;
    kept += used[i];
  }
  if (2 * kept <= count && kept < count) {  // no majority: nobody is to blame
    used.fill(true);
    kept = count;
  }

  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero(), place = Eigen::Vector3d::Zero();
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (!used[i]) {
      ++state.units[i].left_out;
      continue;
    }
    rate += rates[i] / kept;
    force += forces[i] / kept;
    place += params_.T_CI[i].translation() / kept;
  }
  if (kept < count && dt_s > 0.0) {
    const Eigen::Vector3d d = p_C_m_ - place;
    force += ((rate - state.rate_rad_s) / dt_s).cross(d) + rate.cross(rate.cross(d));
  }
  if (kept == count && count > 1 && dt_s > 0.0 && state.samples > 1)
    learn({raw_rates.data(), samples.size()}, dt_s, state);
  for (std::size_t k = 0; k < samples.size(); ++k) state.units[k].last_rate_rad_s = raw_rates[k];

  merged.time_ns = samples[0].time_ns;
  merged.angular_velocity_rad_s = rate;
  merged.specific_force_m_s2 = force;
  merged.device_clip_flags = 0;
  if (count >= kRecovering) recovery_.step(samples, dt_s, state.recovery, merged);
  state.rate_before_rad_s = state.rate_rad_s;
  state.rate_rad_s = rate;
  state.last_time_ns = samples[0].time_ns;
  ++state.samples;
  return {};
}

/// A unit's rate at the last sample less the mean of all, explained by bias, scale and time offset; the angular
/// acceleration is the central difference, from the sample before to this one.
void ImuMerge::learn(std::span<const Eigen::Vector3d> rates, double dt_s, State& state) const {
  Eigen::Vector3d now = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < rates.size(); ++k) {
    now += rates[k] / static_cast<double>(rates.size());
    mean += state.units[k].last_rate_rad_s / static_cast<double>(rates.size());
  }
  const Eigen::Vector3d acceleration = (now - state.rate_before_rad_s) / (2.0 * dt_s);
  if (acceleration.norm() < kTurning_rad_s2) return;
  const double variance = params_.rate_noise_rad_s * params_.rate_noise_rad_s;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    Unit& unit = state.units[k];
    const Eigen::Vector3d residual = unit.last_rate_rad_s - mean;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix<double, kErrors, 1> row = Eigen::Matrix<double, kErrors, 1>::Zero();
      row[axis] = 1.0;
      row.segment<3>(3 + 3 * axis) = mean;
      row[kOffset] = acceleration[axis];
      const Eigen::Matrix<double, kErrors, 1> PHt = unit.P * row;
      const double s = row.dot(PHt) + variance;
      unit.x += PHt * ((residual[axis] - row.dot(unit.x)) / s);
      unit.P -= PHt * (PHt / s).transpose();
    }
    unit.P = (0.5 * (unit.P + unit.P.transpose())).eval();
  }
}

}  // namespace tumble
