// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_merge_state.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/attitude/detail/imu_merge.hpp"

namespace tumble {

namespace {

constexpr std::size_t kSingleSensorAlternatives = MultiImuSignCheck::kMirroredAlternatives / 2;

Eigen::Vector3d apply_mirroring(std::size_t sense, const Eigen::Vector3d& v) {
  Eigen::Vector3d out = v;
  const auto axis = static_cast<Eigen::Index>(sense % 3);
  if (sense < 3) {
    out[axis] = -out[axis];
  } else {
    std::swap(out[axis], out[(axis + 1) % 3]);
  }
  return out;
}

Eigen::Vector3d rotational_acceleration(const Eigen::Vector3d& w, const Eigen::Vector3d& a, const Eigen::Vector3d& d) {
  return a.cross(d) + w.cross(w.cross(d));
}

// An IMU counts as frozen if the IMU repeats one reading for kUnitFrozen_s while other IMUs change or gravity rotates.
// A sensor with a lower sample rate than the log repeats each reading for less than kUnitFrozen_s.
constexpr double kUnitFrozen_s = 0.1, kOthersRate_rad_s = 0.03, kOthersForce_m_s2 = 0.3, kGravityRotation_rad = 1.0;
constexpr double kUnfreeze_s = 0.5;
// The tolerated difference between a gyro and the median of all gyros grows with the rate, because of scale errors.
constexpr double kDisagreeRate_rad_s = 0.1, kDisagreeRateRatio = 0.06, kDisagreeForce_m_s2 = 1.0, kDisagrees_s = 0.3;
constexpr int kMinImusForFault = 3;
constexpr double kMisfitTau_s = 0.5;
constexpr double kComparableRateRatio = 0.8;  // fraction of the gyro's range up to which IMUs are compared

constexpr double kArmShareMin = 0.5;  // smallest plausible lever_arm_agreement() if the gyros are confirmed
// A gyro scale error of 3 % changes lever_arm_agreement() by 6 %, because the centripetal force grows with the squared
// rate.
constexpr double kArmShareOff = 0.06;

constexpr double kAxisContributionMin = 0.02;  // smallest contribution of a clipped axis that flags another axis

/// Returns the component of the IMU's rotation perpendicular to the repeated accelerometer reading. An accelerometer
/// reading is mostly gravity, so a rotation perpendicular to gravity should change the reading.
double rotation_across_force_rad(const ImuMerge::Repetition& hold) {
  return hold.turned_rad.cross(hold.repeated_reading.stableNormalized()).norm();
}

}  // namespace

/// See imu_merge.md (I9).
void MultiImuSignCheck::add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m,
                            const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& acceleration_rad_s2,
                            double length_s) {
  const Eigen::Vector3d read = rotational_acceleration(rate_rad_s, acceleration_rad_s2, position_m);
  for (std::size_t k = 0; k < kSingleSensorAlternatives; ++k) {
    const Eigen::Vector3d of_gyros =
        rotational_acceleration(apply_mirroring(k, rate_rad_s), apply_mirroring(k, acceleration_rad_s2), position_m);
    explained_effect_per_alternative[k] +=
        length_s * ((force_m_s2 - read).squaredNorm() - (force_m_s2 - of_gyros).squaredNorm());
    effect_per_alternative[k] += length_s * (of_gyros - read).squaredNorm();
    const Eigen::Vector3d force = apply_mirroring(k, force_m_s2);
    explained_effect_per_alternative[kSingleSensorAlternatives + k] +=
        length_s * ((force_m_s2 - read).squaredNorm() - (force - read).squaredNorm());
    effect_per_alternative[kSingleSensorAlternatives + k] += length_s * (apply_mirroring(k, read) - read).squaredNorm();
  }
}

std::optional<MultiImuSignCheck::DetectedMirroring> MultiImuSignCheck::detected_mirroring() const {
  std::optional<DetectedMirroring> best;
  double most = 0.0;
  for (std::size_t k = 0; k < kMirroredAlternatives; ++k) {
    if (effect_per_alternative[k] < kMinEffectOnForces ||
        explained_effect_per_alternative[k] < kMinExplainedFraction * effect_per_alternative[k])
      continue;
    if (explained_effect_per_alternative[k] <= most) continue;
    most = explained_effect_per_alternative[k];
    best = DetectedMirroring{k, explained_effect_per_alternative[k] / effect_per_alternative[k]};
  }
  return best;
}

/// Returns clip flags for the axes of the common frame C of all IMUs. An axis is flagged if a clipped axis of any
/// selected IMU has a component along this axis.
std::uint8_t ImuMerge::combined_flags(const Readings& readings, const ImuMask& which) const {
  unsigned out = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const unsigned flags = readings[k].device_clip_flags;
    if (!which[k] || flags == 0) continue;
    const Eigen::Matrix3d R_CI = setup_.T_mean_imu[k].linear();
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

Eigen::Vector3d ImuMerge::median(const Vectors& values, const ImuMask& which) {
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

/// An accelerometer that repeats one reading while the body rotates is frozen, even if all accelerometers repeat their
/// readings.
void ImuMerge::detect_frozen_units(const ImuMask& present, const Vectors& rates, const Vectors& forces, double dt_s,
                                   TimeNs time_ns, State& state) const {
  ImuMask counted = present;
  for (std::size_t k = 0; k < counted.size(); ++k) counted[k] = counted[k] && !state.imus[k].is_excluded();
  const Eigen::Vector3d middle_rate = median(rates, counted), middle_force = median(forces, counted);
  const auto watch = [&](const Eigen::Vector3d& reading, const Eigen::Vector3d& others, Repetition& hold) {
    const bool same = state.sample_count > 0 && reading == hold.repeated_reading;
    hold.repeated_s = same ? hold.repeated_s + dt_s : 0.0;
    hold.turned_rad += dt_s * middle_rate;
    if (!same) {
      hold.turned_rad.setZero();
      hold.repeated_reading = reading;
      hold.other_imus_reading = others;
      hold.since_ns = time_ns;
    }
    return same;
  };
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k]) continue;
    Unit& unit = state.imus[k];
    const bool rate_same = watch(rates[k], middle_rate, unit.repeated_rate);
    const bool force_same = watch(forces[k], middle_force, unit.repeated_force);
    const bool railed = rates[k].cwiseAbs().maxCoeff() >= setup_.gyro_range_rad_s ||
                        forces[k].cwiseAbs().maxCoeff() >= setup_.accel_range_m_s2;
    const bool rate_frozen = unit.repeated_rate.repeated_s >= kUnitFrozen_s &&
                             (middle_rate - unit.repeated_rate.other_imus_reading).norm() > kOthersRate_rad_s;
    const bool force_frozen = unit.repeated_force.repeated_s >= kUnitFrozen_s &&
                              ((middle_force - unit.repeated_force.other_imus_reading).norm() > kOthersForce_m_s2 ||
                               rotation_across_force_rad(unit.repeated_force) > kGravityRotation_rad);
    unit.changing_readings_duration_s = rate_same || force_same ? 0.0 : unit.changing_readings_duration_s + dt_s;
    if (unit.is_frozen) {
      unit.is_frozen = unit.changing_readings_duration_s < kUnfreeze_s;
    } else if (!railed && (rate_frozen || force_frozen)) {
      unit.is_frozen = true;
      unit.frozen_since_ns = rate_frozen ? unit.repeated_rate.since_ns : unit.repeated_force.since_ns;
    }
  }
}

Status ImuMerge::verdict(const State& state) {
  if (!state.all_frozen) return {};
  double repeated_s = 0.0;
  for (const Unit& unit : state.imus) {
    if (unit.is_frozen)
      repeated_s = std::max({repeated_s, unit.repeated_rate.repeated_s, unit.repeated_force.repeated_s});
  }
  return {ErrorCode::out_of_range, "time in s for which every IMU repeats one reading while the body rotates",
          repeated_s, kUnitFrozen_s};
}

void ImuMerge::add_finding(const Unit& unit, const std::string& name, SensorHealth& health) {
  using Kind = HealthFinding::Kind;
  const double repeated_s = std::max(unit.repeated_rate.repeated_s, unit.repeated_force.repeated_s);
  if (unit.is_frozen)
    health.add(Kind::imu_frozen,
               {ErrorCode::out_of_range, "time in s for which the IMU repeats one reading while the others change",
                repeated_s, kUnitFrozen_s},
               name, "", unit.frozen_since_ns);
  if (unit.disagrees)
    health.add(Kind::imu_contradicts_other_imus,
               {ErrorCode::out_of_range, "time in s for which the IMU disagrees with the others", unit.disagreement_s,
                kDisagrees_s},
               name, "", unit.disagrees_since_ns);
}

void ImuMerge::add_findings(const std::optional<MultiImuSignCheck::DetectedMirroring>& mislabelled_axes,
                            const std::optional<double>& lever_arm_agreement, bool gyro_confirmed,
                            SensorHealth& health) {
  using Kind = HealthFinding::Kind;
  if (mislabelled_axes)
    health.add(
        Kind::wrong_axes_or_signs,
        {ErrorCode::out_of_range, "share of the force differences between the IMUs that other axes or signs explain",
         mislabelled_axes->explained_fraction, MultiImuSignCheck::kMinExplainedFraction},
        "imu");
  if (!lever_arm_agreement) return;
  constexpr const char* kQuantity =
      "difference between the forces of the IMUs, relative to the value predicted from rotation and lever arms";
  const double share = *lever_arm_agreement;
  const double off = gyro_confirmed ? 1.0 - kArmShareMin : kArmShareOff, bound = 1.0 + std::copysign(off, share - 1.0);
  if (std::abs(share - 1.0) <= off) return;
  health.add(share < 0.0 ? Kind::wrong_axes_or_signs : Kind::gyro_scale,
             {ErrorCode::out_of_range, kQuantity, share, bound}, "imu");
}

void ImuMerge::detect_disagreeing_units(const ImuMask& present, const Vectors& rates, const Vectors& forces,
                                        TimeNs time_ns, State& state) const {
  if (std::count(present.begin(), present.end(), true) < kMinImusForFault) return;
  const double h = state.window_count > 0 ? state.window_s : Setup::kWindow_s, share = -std::expm1(-h / kMisfitTau_s);
  bool railed = false;
  for (std::size_t k = 0; k < present.size(); ++k) {
    const ImuAverage& window = state.imus[k].window;
    if (!present[k] || window.readings == 0) continue;
    railed |= window.rate_peak_rad_s >= kComparableRateRatio * setup_.gyro_range_rad_s ||
              window.force_peak_m_s2 >= Setup::kSubsampleSaturationRatio * setup_.accel_range_m_s2;
  }
  if (railed) return;
  const Eigen::Vector3d middle_rate = median(rates, present), middle_force = median(forces, present);
  state.rotation_rate_rad_s += share * (middle_rate.norm() - state.rotation_rate_rad_s);
  for (std::size_t k = 0; k < present.size(); ++k) {
    if (!present[k] || state.imus[k].window.readings == 0) continue;
    Unit& unit = state.imus[k];
    const double turned =
        (setup_.T_mean_imu[k].translation() - mean_imu_position_m_).norm() * 2.0 * middle_rate.squaredNorm();
    const double force = std::max(0.0, (forces[k] - middle_force).norm() - turned);
    unit.rate_difference_to_others_rad_s +=
        share * ((rates[k] - middle_rate).norm() - unit.rate_difference_to_others_rad_s);
    unit.force_disagreement_m_s2 += share * (force - unit.force_disagreement_m_s2);
    const double rate_bound = kDisagreeRate_rad_s + kDisagreeRateRatio * state.rotation_rate_rad_s;
    const bool off =
        unit.rate_difference_to_others_rad_s > rate_bound || unit.force_disagreement_m_s2 > kDisagreeForce_m_s2;
    if (off && unit.disagreement_s == 0.0) unit.disagreement_since_ns = time_ns;
    unit.disagreement_s = off ? unit.disagreement_s + h : 0.0;
    if (unit.disagreement_s < kDisagrees_s) continue;
    unit.disagrees = true;
    unit.disagrees_since_ns = unit.disagreement_since_ns;
    break;  // the median changes without the faulty IMU, so the next window tests again
  }
}

}  // namespace tumble
