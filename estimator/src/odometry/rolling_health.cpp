// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <string>

#include "rolling_odometry_impl.hpp"

namespace tumble {

namespace {

using Kind = HealthFinding::Kind;

constexpr double kUnitSilent_s = 0.5;  // time without readings after which an IMU counts as silent

/// If the forces of all IMUs contradict gravity at rest, the finding concerns the merged IMU. If only some IMUs
/// contradict gravity, these IMUs get the finding `unit_disagrees`.
void add_forces_at_rest(const MergedChecks& checks, std::size_t count, SensorHealth& health) {
  const auto verdict = [&](std::size_t unit) {
    return checks.rest_gravity.magnitude_verdict(checks.rest_gravity_state[unit]);
  };
  bool all = true;
  for (std::size_t unit = 0; unit < count; ++unit) all = all && !verdict(unit).ok();
  if (all) health.add(Kind::force_at_rest, verdict(0), "imu");
  for (std::size_t unit = 0; unit < count && !all; ++unit)
    health.add(Kind::unit_disagrees, verdict(unit), unit_name(unit, count));
}

}  // namespace

SensorHealth RollingOdometry::Impl::health() const {
  if (is_whole()) return whole_ ? whole_->health : SensorHealth{};
  SensorHealth out;
  add_frozen(frozen_, out);
  const std::size_t count = params_.units.size();
  TimeNs newest_ns = 0;
  for (std::size_t unit = 0; unit < count; ++unit) newest_ns = std::max(newest_ns, frozen_[unit].last_time_ns);
  for (std::size_t unit = 0; unit < count; ++unit) {
    const std::string name = unit_name(unit, count);
    const TimeNs last_ns = frozen_[unit].last_time_ns;
    const double silent_s = frozen_[unit].started ? seconds(newest_ns - last_ns) : 0.0;
    if (silent_s >= kUnitSilent_s)
      out.add(Kind::unit_silent, {ErrorCode::out_of_range, "time in s without readings", silent_s, kUnitSilent_s}, name,
              "", last_ns);
    ImuMerge::add_finding(imu_merge_state_->units[unit], name, out);
  }
  add_forces_at_rest(checks_, count, out);
  add_findings(checks_.plausibility, checks_.plausibility_state, "imu", out);
  ImuMerge::add_findings(imu_merge_state_->sign_check.detected(), ImuMerge::lever_arm_agreement(*imu_merge_state_),
                         confirms_gyro(checks_.plausibility, checks_.plausibility_state), out);
  return out;
}

/// Adds findings about frozen axes. If other IMUs replace the frozen IMU, the finding is `unit_frozen`.
void RollingOdometry::Impl::add_frozen(const Frozen& frozen, SensorHealth& health) const {
  const std::size_t count = params_.units.size();
  const auto end = frozen.begin() + static_cast<std::ptrdiff_t>(count);
  const bool replaced = !std::all_of(frozen.begin(), end, FrozenAxes::any_frozen);
  for (std::size_t unit = 0; unit < count; ++unit)
    frozen_axis_detectors_[unit].add_findings(replaced ? Kind::unit_frozen : Kind::frozen_axis, unit_name(unit, count),
                                              frozen[unit], health);
}

}  // namespace tumble
