// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"

namespace tumble::scenarios {

namespace {

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

}  // namespace

void require_sphere(const char* method, const sim::Sensors& sensors) {
  if (!(sensors.sphere_radius_m > 0.0)) {
    throw BadInput(fmt::format(
        "the method {} needs a recording of a sphere, but this recording states sphere_radius_m = 0", method));
  }
}

void report_beyond_range(int readings, Estimate& estimate) {
  if (readings > 0) estimate.health["readings_beyond_range"] = readings;
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
  out.names = units.names;
  out.beyond_range = units.beyond_range;
  ImuMerge::Setup setup;
  for (const ImuRecording& unit : units.recordings) {
    setup.gyro_range_rad_s =
        std::min(setup.gyro_range_rad_s, max_unsaturated_reading(unit.data_sheet.gyro_range_rad_s));
    setup.accel_range_m_s2 =
        std::min(setup.accel_range_m_s2, max_unsaturated_reading(unit.data_sheet.accel_range_m_s2));
  }
  return merge_recordings(units.recordings, setup, out.merged);
}

}  // namespace tumble::scenarios
