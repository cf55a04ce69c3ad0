// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/imu_merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/attitude/timing.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kSmallest = 1e-12;
constexpr double kBiasSigma_rad_s = 0.01, kScaleSigma = 0.01;
constexpr double kTurning_rad_s2 = 1.0;  // an angular acceleration that tells a time offset from noise
constexpr double kBeyondDoubt = 4.0;     // sigmas
constexpr int kRecovering = 3;           // so many units tell the rate by their accelerometers
constexpr double kUnharmed = 0.8;        // of the accelerometer's range, up to which its errors are learnt
constexpr int kOffset = ImuMerge::kErrors - 1;
constexpr double kArmSquareMin_m2_s3 = 1.0;  // 1 m/s^2 for a second: a bias of 0.05 makes 0.05 of the share
constexpr double kHeld_s = 0.03;
constexpr double kWindowMax_s = 0.05;  // over a longer one a central difference says nothing

constexpr double kSuspect_s = 0.04;         // blows come in rows, and what one takes a filter gives back later
constexpr double kAccelerationShare = 0.3;  // of its change from sample to sample, that an acceleration is in doubt by

}  // namespace

ForceErrors::Params ImuMerge::force_params(const Params& p) {
  ForceErrors::Params out;
  out.count = std::clamp(p.count, 1, kImus);
  for (std::size_t k = 0; k < static_cast<std::size_t>(out.count); ++k) out.p_C_m[k] = p.T_CI[k].translation();
  return out;
}

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

ImuMerge::ImuMerge(const Params& p) : params_(p), forces_(force_params(p)), recovery_(recovery_params(p)) {
  require_within("count", p.count, 1, kImus);
  require_within("rate_tolerance_rad_s", p.rate_tolerance_rad_s, kSmallest, 1e3);
  require_within("rate_tolerance_share", p.rate_tolerance_share, 0.0, 1.0);
  require_within("force_tolerance_m_s2", p.force_tolerance_m_s2, kSmallest, 1e4);
  require_within("rate_noise_rad_s", p.rate_noise_rad_s, kSmallest, 10.0);
  require_within("offset_sigma_s", p.offset_sigma_s, 0.0, 0.1);
  require_within("gyro_range_rad_s", p.gyro_range_rad_s, kSmallest, 1e3);
  require_within("accel_range_m_s2", p.accel_range_m_s2, kSmallest, 1e5);
  require_within("hidden_share", p.hidden_share, kSmallest, 1.0);
  require_within("hidden_force_m_s2", p.hidden_force_m_s2, kSmallest, 1e4);
  require_within("gap_max_s", p.gap_max_s, 1e-9, 1e4);
  require_within("window_s", p.window_s, 0.0, 0.1);
  require_within("frozen_after_s", p.frozen_after_s, kSmallest, 1e3);
  require_within("frozen_rate_rad_s", p.frozen_rate_rad_s, kSmallest, 1e3);
  require_within("frozen_force_m_s2", p.frozen_force_m_s2, kSmallest, 1e4);
  require_within("thawed_after_s", p.thawed_after_s, kSmallest, 1e3);
  require_within("disagree_rate_rad_s", p.disagree_rate_rad_s, kSmallest, 1e3);
  require_within("disagree_rate_share", p.disagree_rate_share, 0.0, 1.0);
  require_within("disagree_force_m_s2", p.disagree_force_m_s2, kSmallest, 1e4);
  require_within("disagrees_after_s", p.disagrees_after_s, kSmallest, 1e3);
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
  Flags finite{}, present{};
  int heard = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    finite[k] = check(samples[k]).ok();
    heard += finite[k];
  }
  if (heard == 0) return check(samples[0]);
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
  const TimeNs time_ns = samples[0].time_ns;

  // from the middle of the last window to that of this reading
  const double since_s = state.window.length_s + 0.5 * dt_s + 0.5 * state.length_s;
  Vectors rates{}, raw_rates{}, raw_forces{}, forces{};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!finite[k]) {
      if (state.units[k].absent++ == 0) state.units[k].absent_since_ns = time_ns;
      continue;
    }
    const Eigen::Matrix3d R_CI = params_.T_CI[k].linear();
    raw_rates[k] = R_CI * samples[k].angular_velocity_rad_s;
    raw_forces[k] = R_CI * samples[k].specific_force_m_s2;
  }
  if (count > 1) watch_holds(finite, raw_rates, raw_forces, dt_s, time_ns, state);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Unit& unit = state.units[k];
    present[k] = finite[k] && !unit.left_out_for_long();
    rates[k] = raw_rates[k];
    forces[k] = raw_forces[k];
    const double offset_s = unit.offset_s();
    const bool late = offset_s * offset_s > kBeyondDoubt * kBeyondDoubt * unit.P(kOffset, kOffset);
    if (finite[k] && state.windows > 0 && late) {
      rates[k] -= offset_s / since_s * (raw_rates[k] - unit.last_rate_rad_s);
      forces[k] -= offset_s / since_s * (raw_forces[k] - unit.last_force_m_s2);
    }
    forces[k] = ForceErrors::corrected(static_cast<int>(k), forces[k], state.forces);
  }
  if (std::none_of(present.begin(), present.end(), [](bool one) { return one; })) present = finite;
  const int units = static_cast<int>(std::count(present.begin(), present.end(), true));

  // the places differ, so forces may by what the rate makes of it; the tolerance has to bear that
  const Eigen::Vector3d middle_rate = median(rates, present), middle_force = median(forces, present);
  const double rate_tolerance = params_.rate_tolerance_rad_s + params_.rate_tolerance_share * middle_rate.norm();
  Flags used{};
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double turned = (params_.T_CI[i].translation() - p_C_m_).norm() * middle_rate.squaredNorm() * 2.0;
    used[i] = units < 3 || ((rates[i] - middle_rate).norm() < rate_tolerance &&
                            (forces[i] - middle_force).norm() < params_.force_tolerance_m_s2 + turned);
    used[i] = used[i] && samples[i].specific_force_m_s2.cwiseAbs().maxCoeff() < params_.accel_range_m_s2;
    used[i] = used[i] && present[i];
    kept += used[i];
  }
  if (2 * kept <= units && kept < units) {  // no majority: nobody is to blame
    used = present;
    kept = units;
  }
  const bool apart = state.windows > 0 && dt_s > 0.0;  // there is a window to take derivatives from
  if (units >= kRecovering && apart && middle_rate.cwiseAbs().maxCoeff() < params_.gyro_range_rad_s) {
    leave_out_hidden(samples, present, forces, middle_rate, dt_s, state, used);
    kept = static_cast<int>(std::count(used.begin(), used.begin() + count, true));
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
    if (kept < count) place += ForceErrors::place_error_m(k, state.forces) / kept;
  }
  if (kept < count) {
    const Eigen::Vector3d d = p_C_m_ - place;
    if (apart) force += ((rate - state.rate_rad_s) / since_s).cross(d);
    force += rate.cross(rate.cross(d));
  }

  merged.time_ns = time_ns;
  merged.angular_velocity_rad_s = rate;
  merged.specific_force_m_s2 = force;
  merged.device_clip_flags = 0;

  state.all_used = state.all_used && kept == count;
  const double weight_s = state.samples > 0 ? dt_s : params_.window_s;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (finite[k]) state.units[k].window.add({time_ns, raw_rates[k], raw_forces[k], 0}, weight_s);
  }
  state.window.add(merged, weight_s);
  if (state.samples == 0 || state.window.full(params_.window_s, dt_s)) close_window(present, time_ns, state);

  if (units >= kRecovering) recover(samples, present, dt_s, state, merged);
  const auto suspect = [](const Unit& unit) { return unit.suspect_s > 0.0; };
  if (2 * std::count_if(state.units.begin(), state.units.begin() + count, suspect) > count) {
    merged.device_clip_flags =
        static_cast<std::uint8_t>(merged.device_clip_flags | kClipAccelX | kClipAccelY | kClipAccelZ);
  }
  state.middle_rate_rad_s = middle_rate;
  state.middle_force_m_s2 = middle_force;
  state.last_time_ns = time_ns;
  ++state.samples;
  return {};
}

std::optional<double> ImuMerge::arm_share(const State& state) {
  if (state.arm_square_m2_s3 < kArmSquareMin_m2_s3) return std::nullopt;
  return state.arm_product / state.arm_square_m2_s3;
}

/// Learns from the means over the window, and begins the next.
void ImuMerge::close_window(const Flags& present, TimeNs time_ns, State& state) const {
  const bool follows = state.windows > 1 && state.window.length_s < kWindowMax_s;
  // a unit that repeats itself may turn out to be frozen, and nothing is to be learnt from one; where all do, it is the
  // body that keeps its rate
  const auto end = state.units.begin() + params_.count;
  const auto some_hold = [&](Hold Unit::* hold) {
    const auto holding =
        std::count_if(state.units.begin(), end, [&](const Unit& unit) { return (unit.*hold).held_s >= kHeld_s; });
    return holding > 0 && holding < params_.count;
  };
  const bool held = some_hold(&Unit::rate_hold) || some_hold(&Unit::force_hold);
  if (state.all_used && !held && params_.count > 1 && follows) learn(state);
  watch_misfits(present, time_ns, state);
  for (Unit& unit : state.units) {
    if (unit.window.readings > 0) {
      unit.last_rate_rad_s = unit.window.mean.angular_velocity_rad_s;
      unit.last_force_m_s2 = unit.window.mean.specific_force_m_s2;
    }
    unit.window = {};
  }
  state.rate_before_rad_s = state.rate_rad_s;
  state.rate_rad_s = state.window.mean.angular_velocity_rad_s;
  state.length_before_s = state.length_s;
  state.length_s = state.window.length_s;
  state.window = {};
  state.all_used = true;
  ++state.windows;
}

/// A blow may take a unit to its rail for less than a sample. On a rigid body one unit tells what the others feel,
/// along the line between the two without the angular acceleration. The one that most others agree with is believed,
/// among equals the one whose force changed least.
void ImuMerge::leave_out_hidden(std::span<const ImuSample> samples, const Flags& present, const Vectors& forces,
                                const Eigen::Vector3d& rate, double dt_s, State& state, Flags& used) const {
  const double since_s = state.window.length_s + 0.5 * dt_s + 0.5 * state.length_s;
  const double apart_s = 0.5 * (state.length_s + state.length_before_s);
  const Eigen::Vector3d acceleration = (rate - state.rate_rad_s) / since_s;
  const Eigen::Vector3d before = (state.rate_rad_s - state.rate_before_rad_s) / apart_s;
  const auto peak = [&](std::size_t k) { return samples[k].specific_force_m_s2.cwiseAbs().maxCoeff(); };
  const auto change = [&](std::size_t k) {
    return (params_.T_CI[k].linear() * samples[k].specific_force_m_s2 - state.units[k].last_force_m_s2).norm();
  };
  const auto place = [&](std::size_t k) -> Eigen::Vector3d {
    return params_.T_CI[k].translation() + ForceErrors::place_error_m(static_cast<int>(k), state.forces);
  };
  const auto agree = [&](std::size_t k, std::size_t j) {
    if (std::max(peak(k), peak(j)) < params_.hidden_share * params_.accel_range_m_s2) return true;
    const Eigen::Vector3d d = place(k) - place(j);
    const Eigen::Vector3d misfit = forces[k] - forces[j] - acceleration.cross(d) - rate.cross(rate.cross(d));
    const double doubt = kAccelerationShare * (acceleration - before).norm() * d.norm();
    return std::abs(misfit.dot(d)) <= params_.hidden_force_m_s2 * d.norm() &&
           misfit.norm() <= params_.hidden_force_m_s2 + doubt;
  };
  std::size_t believed = 0;
  std::pair<int, double> most(-1, 0.0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!present[k]) continue;
    int others = 0;
    for (std::size_t j = 0; j < samples.size(); ++j) others += present[j] && j != k && agree(k, j);
    const std::pair<int, double> rank(others, -change(k));
    if (rank > most) {
      most = rank;
      believed = k;
    }
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!present[k]) continue;
    double& suspect_s = state.units[k].suspect_s;
    suspect_s = k == believed || agree(k, believed) ? std::max(0.0, suspect_s - dt_s) : kSuspect_s;
    used[k] = used[k] && suspect_s == 0.0;
  }
  if (std::none_of(used.begin(), used.begin() + params_.count, [](bool one) { return one; })) used[believed] = true;
}

void ImuMerge::recover(std::span<const ImuSample> samples, const Flags& present, double dt_s, State& state,
                       ImuSample& merged) const {
  std::array<ImuSample, kImus> corrected{};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    corrected[k] = samples[k];
    if (!present[k]) {
      corrected[k].angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if (samples[k].specific_force_m_s2.cwiseAbs().maxCoeff() >= params_.accel_range_m_s2) continue;
    const Eigen::Matrix3d R_CI = params_.T_CI[k].linear();
    const Eigen::Vector3d force = R_CI * samples[k].specific_force_m_s2;
    corrected[k].specific_force_m_s2 =
        R_CI.transpose() * ForceErrors::corrected(static_cast<int>(k), force, state.forces);
  }
  recovery_.step({corrected.data(), samples.size()}, dt_s, state.recovery, merged);
}

/// A unit's rate over the last window less the mean of all, explained by bias, scale and time offset; the angular
/// acceleration is the central difference, from the window before to this one.
void ImuMerge::learn(State& state) const {
  const auto count = static_cast<std::size_t>(params_.count);
  Eigen::Vector3d now = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    now += state.units[k].window.mean.angular_velocity_rad_s / static_cast<double>(count);
    mean += state.units[k].last_rate_rad_s / static_cast<double>(count);
  }
  const double apart_s = 0.5 * (state.window.length_s + state.length_before_s) + state.length_s;
  const Eigen::Vector3d acceleration = (now - state.rate_before_rad_s) / apart_s;
  Vectors forces{};
  double peak = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    forces[k] = state.units[k].last_force_m_s2;
    peak = std::max(peak, forces[k].cwiseAbs().maxCoeff());
  }
  const bool railed = mean.cwiseAbs().maxCoeff() >= params_.gyro_range_rad_s;
  if (!railed && peak < kUnharmed * params_.accel_range_m_s2) {
    forces_.learn({forces.data(), count}, mean, acceleration, state.length_s, state.forces);
  }
  const Eigen::Matrix3d by_place = so3::hat(acceleration) + so3::hat(mean) * so3::hat(mean);
  for (std::size_t k = 0; k < count && !railed; ++k) {
    const Eigen::Vector3d by_turning = by_place * (params_.T_CI[k].translation() - p_C_m_);
    state.arm_product += state.length_s * by_turning.dot(forces[k]);  // the mean of all drops out of the sum
    state.arm_square_m2_s3 += state.length_s * by_turning.squaredNorm();
  }
  if (acceleration.norm() < kTurning_rad_s2) return;
  const double variance = params_.rate_noise_rad_s * params_.rate_noise_rad_s;
  for (std::size_t k = 0; k < count; ++k) {
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
