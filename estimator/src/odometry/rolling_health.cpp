// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <string>

#include "rolling_odometry_impl.hpp"

namespace tumble {

namespace {

using Kind = HealthFinding::Kind;

constexpr double kUnitSilent_s = 0.5;  // time without readings after which an IMU counts as silent

/// If the accelerometers of all IMUs contradict gravity at rest, the finding concerns the merged IMU. If only some IMUs
/// contradict gravity, these IMUs get the finding `imu_disagrees`.
void add_forces_at_rest(const MergedImuChecks& checks, std::size_t count, SensorHealth& health) {
  const auto verdict = [&](std::size_t unit) {
    return checks.rest_gravity.gravity_magnitude_verdict(checks.rest_gravity_state[unit]);
  };
  bool all = true;
  for (std::size_t unit = 0; unit < count; ++unit) all = all && !verdict(unit).ok();
  if (all) health.add(Kind::wrong_force_magnitude_at_rest, verdict(0), "imu");
  for (std::size_t unit = 0; unit < count && !all; ++unit)
    health.add(Kind::imu_contradicts_other_imus, verdict(unit), imu_name(unit, count));
}

}  // namespace

SensorHealth RollingOdometry::Impl::health() const {
  if (uses_whole_recording()) return whole_recording_result_ ? whole_recording_result_->health : SensorHealth{};
  SensorHealth out;
  add_frozen_findings(frozen_imus_, out);
  const std::size_t count = params_.imus.size();
  TimeNs newest_ns = 0;
  for (std::size_t unit = 0; unit < count; ++unit) newest_ns = std::max(newest_ns, frozen_imus_[unit].last_time_ns);
  for (std::size_t unit = 0; unit < count; ++unit) {
    const std::string name = imu_name(unit, count);
    const TimeNs last_ns = frozen_imus_[unit].last_time_ns;
    const double silent_s = frozen_imus_[unit].started ? seconds(newest_ns - last_ns) : 0.0;
    if (silent_s >= kUnitSilent_s)
      out.add(Kind::imu_silent, {ErrorCode::out_of_range, "time in s without readings", silent_s, kUnitSilent_s}, name,
              "", last_ns);
    ImuMerge::add_finding(imu_merge_state_->imus[unit], name, out);
  }
  add_forces_at_rest(merged_imu_checks_, count, out);
  add_findings(merged_imu_checks_.plausibility, merged_imu_checks_.plausibility_state, "imu", out);
  ImuMerge::add_findings(imu_merge_state_->imu_sign_check.detected_mirroring(),
                         ImuMerge::lever_arm_agreement(*imu_merge_state_),
                         confirms_gyro(merged_imu_checks_.plausibility, merged_imu_checks_.plausibility_state), out);
  return out;
}

/// If an IMU has a frozen axis and other IMUs replace this IMU, the finding is `imu_frozen` instead of `frozen_axis`.
void RollingOdometry::Impl::add_frozen_findings(const Frozen& frozen, SensorHealth& health) const {
  const std::size_t count = params_.imus.size();
  const auto end = frozen.begin() + static_cast<std::ptrdiff_t>(count);
  const bool replaced = !std::all_of(frozen.begin(), end, FrozenAxes::any_frozen);
  for (std::size_t unit = 0; unit < count; ++unit)
    frozen_axis_detectors_[unit].add_findings(replaced ? Kind::imu_frozen : Kind::frozen_axis, imu_name(unit, count),
                                              frozen[unit], health);
}

}  // namespace tumble
