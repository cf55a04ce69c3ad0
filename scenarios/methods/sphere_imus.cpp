// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/methods/bridge.hpp"
#include "tumble/attitude/imu_merge.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRangeShare = 0.98;  // of the stated range: calibration moves a rail by its error of scale

}  // namespace

Status merge_imus(const sim::Sensors& sensors, MergedImus& out) {
  out = {};
  std::vector<std::vector<ImuSample>> units(1);
  if (Status status = bridge::primary_imu_samples(sensors, units[0]); !status.ok()) return status;
  ImuMerge::Params params;
  params.T_CI[0] = sensors.imus.front().T_BI;
  params.gap_max_s = bridge::kGapMaxS;
  const sim::ImuRecord& primary = sensors.imus.front();
  if (primary.stated_gyro_range_rad_s > 0.0) out.gyro_range_rad_s = kRangeShare * primary.stated_gyro_range_rad_s;
  if (primary.stated_accel_range_m_s2 > 0.0) out.accel_range_m_s2 = kRangeShare * primary.stated_accel_range_m_s2;
  params.gyro_range_rad_s = out.gyro_range_rad_s;
  params.accel_range_m_s2 = out.accel_range_m_s2;
  for (std::size_t k = 1; k < sensors.imus.size() && params.count < ImuMerge::kImus; ++k) {
    const sim::ImuRecord& record = sensors.imus[k];
    std::vector<ImuSample> samples;
    if (record.name == "imu_reference" || record.time_ns != sensors.imus.front().time_ns) continue;
    if (!bridge::imu_samples(record, samples).ok()) continue;
    params.T_CI[static_cast<std::size_t>(params.count++)] = record.T_BI;
    units.push_back(std::move(samples));
  }

  const ImuMerge merge(params);
  ImuMerge::State state;
  std::vector<ImuSample> now(units.size());
  out.units = params.count;
  out.lever_arm_m = merge.p_C_m();
  out.samples.resize(units[0].size());
  for (std::size_t k = 0; k < out.samples.size(); ++k) {
    for (std::size_t unit = 0; unit < units.size(); ++unit) now[unit] = units[unit][k];
    if (Status status = merge.step(now, state, out.samples[k]); !status.ok()) return status;
  }
  for (std::size_t unit = 0; unit < units.size(); ++unit) {
    out.left_out += static_cast<double>(state.units[unit].left_out);
    out.offset_max_s = std::max(out.offset_max_s, std::abs(state.units[unit].offset_s()));
  }
  return {};
}

}  // namespace tumble::scenarios
