// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include <algorithm>
#include <utility>

#include "scenarios/methods/bridge.hpp"

namespace tumble::scenarios {

namespace {

/// Returns the usable readings of an IMU: finite, in order and within the device's range. Throws BadInput if the
/// record's arrays differ in length.
std::vector<ImuSample> readings_of(const sim::ImuRecord& record, Status& status, int& beyond_range) {
  std::vector<ImuSample> samples;
  status = bridge::imu_samples(record, samples, bridge::kAnyGapS);
  if (status.ok()) {
    beyond_range += static_cast<int>(record.time_ns.size() - samples.size());
    return samples;
  }
  for (std::size_t k = 0; k < record.time_ns.size(); ++k) {
    const TimeNs time_ns = record.time_ns[k];
    if (!record.gyro_rad_s[k].allFinite() || !record.accel_m_s2[k].allFinite()) continue;
    if (!bridge::check_range(record, record.gyro_rad_s[k], record.accel_m_s2[k]).ok()) {
      ++beyond_range;
      continue;
    }
    if (!samples.empty() && time_ns <= samples.back().time_ns) continue;
    samples.push_back({time_ns, record.gyro_rad_s[k], record.accel_m_s2[k], 0});
  }
  return samples;
}

HealthFinding finding_of(const UnitFault& fault, const std::string& name, TimeNs start_ns) {
  const double since_s = seconds(fault.since_ns - start_ns);
  switch (fault.kind) {
    case UnitFault::Kind::silent:
      return {HealthFinding::About::unit_silent, since_s, name};
    case UnitFault::Kind::frozen:
      return {HealthFinding::About::unit_frozen, since_s, name};
    case UnitFault::Kind::frozen_axis:
      return {HealthFinding::About::unit_frozen, since_s, name + "_" + to_string(fault.axis)};
    case UnitFault::Kind::disagrees:
      break;
  }
  return {HealthFinding::About::unit_disagrees, since_s, name};
}

}  // namespace

std::string to_string(const FrozenAxis& frozen) {
  return std::string(frozen.triad == Triad::gyro ? "gyro_" : "accel_") + "xyz"[frozen.axis];
}

Status sphere_imus(const sim::Sensors& sensors, SphereImus& out) {
  out = {};
  if (sensors.imus.empty()) return {ErrorCode::empty, "imus", 0.0, 1.0};
  Status primary;
  bool any_valid = false;
  for (const sim::ImuRecord& record : sensors.imus) {
    const bool is_primary = &record == &sensors.imus.front();
    if (!is_primary && record.name == "imu_reference") continue;
    if (out.recordings.size() == ImuMerge::kImus) break;
    Status status;
    std::vector<ImuSample> samples = readings_of(record, status, out.beyond_range);
    if (is_primary) primary = status;
    if (samples.empty()) continue;
    any_valid = any_valid || status.ok();
    out.names.push_back(record.name);
    out.recordings.push_back({bridge::imu_sheet(record), record.T_BI, std::move(samples)});
  }
  return any_valid ? Status{} : primary;
}

Status merge_imus(const sim::Sensors& sensors, MergedImus& out) {
  out = {};
  SphereImus units;
  if (Status status = sphere_imus(sensors, units); !status.ok()) return status;
  out.beyond_range = units.beyond_range;
  ImuMerge::Params params;
  params.gap_max_s = bridge::kGapMaxS;
  const TimeNs start_ns = units.recordings.front().samples.front().time_ns;
  for (const UnitRecording& unit : units.recordings) {
    params.gyro_range_rad_s = std::min(params.gyro_range_rad_s, unsaturated_range(unit.sheet.gyro_range_rad_s));
    params.accel_range_m_s2 = std::min(params.accel_range_m_s2, unsaturated_range(unit.sheet.accel_range_m_s2));
  }
  const Status status = merge_recordings(units.recordings, params, out.merged);
  for (const UnitFault& fault : out.merged.faults)
    out.faults.push_back(finding_of(fault, units.names[fault.unit], start_ns));
  return status;
}

}  // namespace tumble::scenarios
