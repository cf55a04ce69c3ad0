// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "tumble/attitude/imu_merge.hpp"

// This file detects faulty IMUs: saturation, frozen readings, disagreement.
namespace tumble {

namespace {

constexpr int kMinImusForFault = 3;  // minimum number of IMUs for identifying the faulty IMU
constexpr double kMisfitTau_s = 0.5;
constexpr double kComparableRateRatio = 0.8;  // fraction of the gyro's range up to which IMUs are compared

constexpr double kAxisContributionMin =
    0.02;  // contribution of a clipped axis above which another axis counts as clipped

/// Returns the rotation across the direction of the repeated force, which is mostly gravity.
double rotation_across_force_rad(const ImuMerge::Repetition& hold) {
  return hold.turned_rad.cross(hold.reading.stableNormalized()).norm();
}

}  // namespace

/// Returns the saturation flags of the selected IMUs, for the axes of the common frame C. An axis of C is flagged if a
/// clipped axis of an IMU contributes to the axis of C.
std::uint8_t ImuMerge::combined_flags(const Readings& readings, const UnitMask& which) const {
  unsigned out = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const unsigned flags = readings[k].device_clip_flags;
    if (!which[k] || flags == 0) continue;
    const Eigen::Matrix3d R_CI = params_.T_CI[k].linear();
    for (int axis = 0; axis < 3; ++axis) {
      for (int own = 0; own < 3; ++own) {
        if (std::abs(R_CI(axis, own)) <= kAxisContributionMin) continue;
        if ((flags & static_cast<unsigned>(kClipGyroX << own)) != 0) out |= static_cast<unsigned>(kClipGyroX << axis);
        if ((flags & static_cast<unsigned>(kClipAccelX << own)) != 0) out |= static_cast<unsigned>(kClipAccelX << axis);
      }
    }
  }
  return static_cast<std::uint8_t>(out);
}

Eigen::Vector3d ImuMerge::median(const Vectors& values, const UnitMask& which) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, kImus> sorted;
    sorted.fill(std::numeric_limits<double>::infinity());
    std::size_t count = 0;
    for (std::size_t k = 0; k < which.size(); ++k) {
      if (which[k]) sorted[count++] = values[k][axis];
    }
    if (count == 0) return out;
    std::sort(sorted.begin(), sorted.end());
    out[axis] = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
  }
  return out;
}

/// Detects triads that repeat readings while the median of the IMUs changes. For accelerometers, a rotation of the body
/// replaces the change of the median, since all IMUs may freeze together.
void ImuMerge::detect_frozen_units(const UnitMask& present, const Vectors& rates, const Vectors& forces, double dt_s,
                                   TimeNs time_ns, State& state) const {
  UnitMask counted = present;
  for (std::size_t k = 0; k < counted.size(); ++k) counted[k] = counted[k] && !state.units[k].is_excluded();
  const Eigen::Vector3d middle_rate = median(rates, counted), middle_force = median(forces, counted);
  const auto watch = [&](const Eigen::Vector3d& reading, const Eigen::Vector3d& others, Repetition& hold) {
    const bool same = state.samples > 0 && reading == hold.reading;
    hold.repeated_s = same ? hold.repeated_s + dt_s : 0.0;
    hold.turned_rad += dt_s * middle_rate;
    if (!same) {
      hold.turned_rad.setZero();
      hold.reading = reading;
      hold.others = others;
      hold.since_ns = time_ns;
    }
    return same;
  };
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k]) continue;
    Unit& unit = state.units[k];
    const bool rate_same = watch(rates[k], middle_rate, unit.rate_repeat);
    const bool force_same = watch(forces[k], middle_force, unit.force_repeat);
    const bool railed = rates[k].cwiseAbs().maxCoeff() >= params_.gyro_range_rad_s ||
                        forces[k].cwiseAbs().maxCoeff() >= params_.accel_range_m_s2;
    const bool rate_frozen = unit.rate_repeat.repeated_s >= params_.expert.frozen.after_s &&
                             (middle_rate - unit.rate_repeat.others).norm() > params_.expert.frozen.rate_rad_s;
    const bool force_frozen = unit.force_repeat.repeated_s >= params_.expert.frozen.after_s &&
                              ((middle_force - unit.force_repeat.others).norm() > params_.expert.frozen.force_m_s2 ||
                               rotation_across_force_rad(unit.force_repeat) > params_.expert.frozen.turned_rad);
    unit.changing_readings_s = rate_same || force_same ? 0.0 : unit.changing_readings_s + dt_s;
    if (unit.frozen) {
      unit.frozen = unit.changing_readings_s < params_.expert.frozen.unfreeze_after_s;
    } else if (!railed && (rate_frozen || force_frozen)) {
      unit.frozen = true;
      unit.frozen_since_ns = rate_frozen ? unit.rate_repeat.since_ns : unit.force_repeat.since_ns;
    }
  }
}

Status ImuMerge::verdict(const State& state) const {
  if (!state.all_frozen) return {};
  double repeated_s = 0.0;
  for (const Unit& unit : state.units) {
    if (unit.frozen) repeated_s = std::max({repeated_s, unit.rate_repeat.repeated_s, unit.force_repeat.repeated_s});
  }
  return {ErrorCode::out_of_range, "time in s for which every IMU repeats one reading while the body rotates",
          repeated_s, params_.expert.frozen.after_s};
}

/// Detects IMUs that disagree with the other IMUs for a long time.
void ImuMerge::detect_disagreeing_units(const UnitMask& present, const Vectors& rates, const Vectors& forces,
                                        TimeNs time_ns, State& state) const {
  if (std::count(present.begin(), present.end(), true) < kMinImusForFault) return;
  const double h = state.windows > 0 ? state.window_s : params_.window_s, share = -std::expm1(-h / kMisfitTau_s);
  bool railed = false;
  for (std::size_t k = 0; k < present.size(); ++k) {
    const ImuAverage& window = state.units[k].window;
    if (!present[k] || window.readings == 0) continue;
    railed |= window.rate_peak_rad_s >= kComparableRateRatio * params_.gyro_range_rad_s ||
              window.force_peak_m_s2 >= params_.expert.outliers.subsample_saturation_ratio * params_.accel_range_m_s2;
  }
  if (railed) return;
  const Eigen::Vector3d middle_rate = median(rates, present), middle_force = median(forces, present);
  state.rotation_rate_rad_s += share * (middle_rate.norm() - state.rotation_rate_rad_s);
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k] || state.units[k].window.readings == 0) continue;
    Unit& unit = state.units[k];
    const double turned = (params_.T_CI[k].translation() - p_C_m_).norm() * 2.0 * middle_rate.squaredNorm();
    const double force = std::max(0.0, (forces[k] - middle_force).norm() - turned);
    unit.rate_disagreement_rad_s += share * ((rates[k] - middle_rate).norm() - unit.rate_disagreement_rad_s);
    unit.force_disagreement_m_s2 += share * (force - unit.force_disagreement_m_s2);
    const double rate_bound =
        params_.expert.disagreeing.rate_rad_s + params_.expert.disagreeing.rate_share * state.rotation_rate_rad_s;
    const bool off = unit.rate_disagreement_rad_s > rate_bound ||
                     unit.force_disagreement_m_s2 > params_.expert.disagreeing.force_m_s2;
    if (off && unit.disagreement_s == 0.0) unit.disagreement_since_ns = time_ns;
    unit.disagreement_s = off ? unit.disagreement_s + h : 0.0;
    if (unit.disagreement_s < params_.expert.disagreeing.after_s) continue;
    unit.disagrees = true;
    unit.disagrees_since_ns = unit.disagreement_since_ns;
    break;  // if the faulty IMU is removed, the median changes
  }
}

}  // namespace tumble
