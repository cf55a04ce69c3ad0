// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sphere_imus.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/methods/bridge.hpp"
#include "tumble/attitude/imu_merge.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRangeShare = 0.98;     // of the stated range: calibration moves a rail by its error of scale
constexpr double kUncoveredMaxS = 0.05;  // at either end, where the nearest reading stands in

/// Readings of a unit at the times of another, linearly between two: stamps are ends of windows, so both are means over
/// a window that ends there. Empty when the unit does not cover them.
std::vector<ImuSample> at_times_of(const std::vector<ImuSample>& primary, const std::vector<ImuSample>& own) {
  const bool covers = seconds(own.front().time_ns - primary.front().time_ns) <= kUncoveredMaxS &&
                      seconds(primary.back().time_ns - own.back().time_ns) <= kUncoveredMaxS;
  if (!covers) return {};
  std::vector<ImuSample> out(primary.size());
  std::size_t next = 0;
  for (std::size_t k = 0; k < primary.size(); ++k) {
    const TimeNs time_ns = primary[k].time_ns;
    while (next < own.size() && own[next].time_ns < time_ns) ++next;
    const ImuSample& after = own[std::min(next, own.size() - 1)];
    const ImuSample& before = next > 0 ? own[next - 1] : own.front();
    const double length_s = seconds(after.time_ns - before.time_ns);
    const double share = length_s > 0.0 ? seconds(time_ns - before.time_ns) / length_s : 1.0;
    out[k] = after;
    out[k].time_ns = time_ns;
    out[k].angular_velocity_rad_s =
        before.angular_velocity_rad_s + share * (after.angular_velocity_rad_s - before.angular_velocity_rad_s);
    out[k].specific_force_m_s2 =
        before.specific_force_m_s2 + share * (after.specific_force_m_s2 - before.specific_force_m_s2);
    out[k].device_clip_flags = static_cast<std::uint8_t>(before.device_clip_flags | after.device_clip_flags);
  }
  return out;
}

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
  std::vector<std::string> names = {primary.name};
  params.gyro_range_rad_s = out.gyro_range_rad_s;
  params.accel_range_m_s2 = out.accel_range_m_s2;
  for (std::size_t k = 1; k < sensors.imus.size() && params.count < ImuMerge::kImus; ++k) {
    const sim::ImuRecord& record = sensors.imus[k];
    std::vector<ImuSample> samples;
    if (record.name == "imu_reference" || !bridge::imu_samples(record, samples).ok() || samples.empty()) continue;
    if (record.time_ns != primary.time_ns) {
      samples = at_times_of(units[0], samples);
      if (samples.empty()) continue;
      ++out.resampled;
    }
    names.push_back(record.name);
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
    const ImuMerge::Unit& learnt = state.units[unit];
    out.offset_max_s = std::max(out.offset_max_s, std::abs(learnt.offset_s()));
    if (units.size() < 2) continue;
    constexpr int kOffset = ImuMerge::kErrors - 1;
    out.each.push_back({names[unit], learnt.offset_s(), std::sqrt(std::max(0.0, learnt.P(kOffset, kOffset))),
                        learnt.x.head<3>().norm()});
  }
  return {};
}

}  // namespace tumble::scenarios
