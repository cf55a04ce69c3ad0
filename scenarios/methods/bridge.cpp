// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble::scenarios::bridge {

namespace {

constexpr std::array<std::pair<int, ClipFlag>, 6> kClipBits = {
    {{0, kClipGyroX}, {1, kClipGyroY}, {2, kClipGyroZ}, {3, kClipAccelX}, {4, kClipAccelY}, {5, kClipAccelZ}}};

std::uint8_t clip_flags(std::uint8_t sim_bits) {
  std::uint8_t flags = 0;
  for (const auto& [bit, flag] : kClipBits) {
    if (sim_bits & (1u << bit)) flags = static_cast<std::uint8_t>(flags | flag);
  }
  return flags;
}

// Largest accepted ratio between the measured and the stated sample period of an IMU. Time stamps in a wrong unit give
// a ratio of 1000 or more.
constexpr double kPeriodsMax = 20.0;

Status check_period(const sim::ImuRecord& record, std::span<const ImuSample> samples) {
  if (record.period_ns <= 0 || samples.size() < 3) return {};
  const double step_s = median_period_s(samples), stated_s = seconds(record.period_ns);
  if (step_s > stated_s / kPeriodsMax && step_s < stated_s * kPeriodsMax) return {};
  return {ErrorCode::out_of_range,
          "median time step of the IMU in s (the step must differ from the stated period by less than a factor of 20)",
          step_s, step_s < stated_s ? stated_s / kPeriodsMax : stated_s * kPeriodsMax};
}

std::vector<ImuSample> samples_of(const sim::ImuRecord& record) {
  std::vector<ImuSample> samples(record.time_ns.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_ns = record.time_ns[k];
    samples[k].angular_velocity_rad_s = record.gyro_rad_s[k];
    samples[k].specific_force_m_s2 = record.accel_m_s2[k];
    samples[k].device_clip_flags = record.clip_flags.empty() ? std::uint8_t{0} : clip_flags(record.clip_flags[k]);
  }
  return samples;
}

bool in_range(const sim::ImuRecord& record, const ImuSample& sample) {
  return check_range(record, sample.angular_velocity_rad_s, sample.specific_force_m_s2).ok();
}

// If too many IMU readings are faulty, all readings count as usable, so that a later check rejects the recording.
std::vector<bool> find_usable(std::span<const ImuSample> samples) {
  std::vector<bool> usable(samples.size(), true);
  std::vector<TimeNs> stamps_ns;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto is_reading = [](const Eigen::Vector3d& triad) {
      return triad.allFinite() && triad.cwiseAbs().maxCoeff() <= kReadingMax;
    };
    usable[k] = is_reading(samples[k].angular_velocity_rad_s) && is_reading(samples[k].specific_force_m_s2);
    if (usable[k]) stamps_ns.push_back(samples[k].time_ns);
  }
  const std::vector<bool> in_order = stamps_in_order(stamps_ns);
  std::size_t reading = 0;
  for (std::size_t k = 0; k < usable.size(); ++k) {
    if (usable[k]) usable[k] = in_order[reading++];
  }
  const auto faulty = static_cast<std::size_t>(std::count(usable.begin(), usable.end(), false));
  if (!may_leave_out(faulty, usable.size())) usable.assign(usable.size(), true);
  return usable;
}

// Only isolated IMU readings beyond the range are removed. Frequent readings beyond the range are kept, so that a later
// check rejects the recording.
std::vector<bool> kept_samples(const sim::ImuRecord& record, std::span<const ImuSample> samples) {
  std::vector<bool> kept = find_usable(samples);
  std::size_t beyond = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) beyond += kept[k] && !in_range(record, samples[k]) ? 1 : 0;
  if (beyond > 0 && static_cast<double>(beyond) <= kWildShareMax * static_cast<double>(samples.size())) {
    const std::vector<bool> inlier = find_inliers(record);
    for (std::size_t k = 0; k < samples.size(); ++k) kept[k] = kept[k] && (inlier[k] || in_range(record, samples[k]));
  }
  return kept;
}

Status check_stream(const sim::ImuRecord& record, std::span<const ImuSample> samples, double gap_max_s) {
  if (samples.empty()) return {ErrorCode::empty, "time_ns", 0.0, 1.0};
  if (const Status status = check_samples(samples, gap_max_s); !status.ok()) return status;
  for (const ImuSample& sample : samples) {
    const Status status = check_range(record, sample.angular_velocity_rad_s, sample.specific_force_m_s2);
    if (!status.ok()) return status;
  }
  return check_period(record, samples);
}

}  // namespace

ImuDataSheet imu_sheet(const sim::ImuRecord& record) {
  ImuDataSheet sheet;
  if (record.period_ns > 0) sheet.rate_hz = 1.0 / seconds(record.period_ns);
  sheet.gyro_range_rad_s = record.stated_gyro_range_rad_s;
  sheet.accel_range_m_s2 = record.stated_accel_range_m_s2;
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) sheet.gyro_noise_rad_s_sqrt_hz = record.gyro_noise_rad_s_sqrt_hz;
  if (record.accel_noise_m_s2_sqrt_hz > 0.0) sheet.accel_noise_m_s2_sqrt_hz = record.accel_noise_m_s2_sqrt_hz;
  return sheet;
}

Status check_range(const sim::ImuRecord& record, const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2) {
  const auto beyond = [](const Eigen::Vector3d& reading, double stated, const char* field) -> Status {
    const double bound = kStatedRangesMax * stated;
    if (!(bound > 0.0) || reading.cwiseAbs().maxCoeff() <= bound) return {};
    return {ErrorCode::out_of_range, field, reading.cwiseAbs().maxCoeff(), bound};
  };
  const Status gyro = beyond(gyro_rad_s, record.stated_gyro_range_rad_s,
                             "angular_velocity_rad_s (the rate must be within twice the stated range; check the unit)");
  if (!gyro.ok()) return gyro;
  return beyond(accel_m_s2, record.stated_accel_range_m_s2,
                "specific_force_m_s2 (the specific force must be within twice the stated range; check the unit)");
}

std::vector<bool> find_inliers(const sim::ImuRecord& record) {
  const std::size_t count = record.time_ns.size();
  std::vector<bool> all(count, true);
  const bool whole = record.gyro_rad_s.size() == count && record.accel_m_s2.size() == count &&
                     (record.clip_flags.empty() || record.clip_flags.size() == count);
  if (!whole) return all;
  std::vector<ImuSample> samples = samples_of(record);
  std::vector<bool> kept = find_usable(samples);
  keep_rows(kept, samples);
  if (!check_samples(samples, std::numeric_limits<double>::infinity()).ok()) return all;
  const std::vector<bool> inlier =
      tumble::find_inliers(OutlierFilter({.gyro_range_rad_s = record.stated_gyro_range_rad_s,
                                          .accel_range_m_s2 = record.stated_accel_range_m_s2,
                                          .period_s = std::max(0.0, seconds(record.period_ns))}),
                           samples);
  std::size_t reading = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (kept[k]) kept[k] = inlier[reading++];
  }
  return kept;
}

Status imu_samples(const sim::ImuRecord& record, std::vector<ImuSample>& out, double gap_max_s) {
  out.clear();
  const std::size_t count = record.time_ns.size();
  const std::string place = "imu '" + record.name + "'";
  require_length(place, "gyro_rad_s", record.gyro_rad_s.size(), count);
  require_length(place, "accel_m_s2", record.accel_m_s2.size(), count);
  if (!record.clip_flags.empty()) require_length(place, "clip_flags", record.clip_flags.size(), count);
  std::vector<ImuSample> samples = samples_of(record);
  keep_rows(kept_samples(record, samples), samples);
  const Status status = check_stream(record, samples, gap_max_s);
  if (status.ok()) out = std::move(samples);
  return status;
}

Status delivered_samples(const sim::ImuRecord& record, DeliveredSamples& out) {
  out = {};
  std::vector<ImuSample> kept_only;
  if (Status status = imu_samples(record, kept_only, kAnyGapS); !status.ok()) return status;
  out.samples = samples_of(record);
  const std::vector<bool> kept = kept_samples(record, out.samples);
  TimeNs arrival_ns = kept_only.front().time_ns;
  for (std::size_t k = 0; k < out.samples.size(); ++k) {
    if (kept[k]) arrival_ns = out.samples[k].time_ns;
    out.arrival_ns.push_back(arrival_ns);
  }
  return {};
}

Status primary_imu_samples(const sim::Sensors& sensors, std::vector<ImuSample>& out, double gap_max_s) {
  out.clear();
  if (sensors.imus.empty()) return {ErrorCode::empty, "imus", 0.0, 1.0};
  return imu_samples(sensors.imus.front(), out, gap_max_s);
}

Status unclipped_samples(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::vector<ImuSample>& out) {
  const std::string place = "truth of imu '" + record.name + "'";
  require_length(place, "gyro_unclipped_rad_s", truth.gyro_unclipped_rad_s.size(), record.time_ns.size());
  require_length(place, "accel_unclipped_m_s2", truth.accel_unclipped_m_s2.size(), record.time_ns.size());
  sim::ImuRecord twin = record;
  twin.gyro_rad_s = truth.gyro_unclipped_rad_s;
  twin.accel_m_s2 = truth.accel_unclipped_m_s2;
  twin.clip_flags.clear();
  twin.stated_gyro_range_rad_s = twin.stated_accel_range_m_s2 = 0.0;  // unclipped readings have no range
  return imu_samples(twin, out);
}

Eigen::Vector3d lever_arm_I_m(const sim::ImuRecord& record) {
  return record.T_BI.linear().transpose() * record.T_BI.translation();
}

Eigen::Isometry3d T_IL(const sim::ImuRecord& imu, const sim::LidarRecord& lidar) {
  return imu.T_BI.inverse(Eigen::Isometry) * lidar.T_BL;
}

double gyro_variance_rad2_s2(const sim::ImuRecord& record) {
  const double period_s = seconds(record.period_ns);
  if (!(period_s > 0.0)) return 0.0;
  return record.gyro_noise_rad_s_sqrt_hz * record.gyro_noise_rad_s_sqrt_hz / period_s;
}

std::size_t sweep_count(const sim::LidarRecord& record) {
  const std::size_t sweeps = record.sweep_start_ns.size();
  const std::size_t points = record.position_L_m.size();
  const std::string place = "lidar '" + record.name + "'";
  if (sweeps == 0 && record.sweep_first.empty()) return 0;
  require_length(place, "sweep_first", record.sweep_first.size(), sweeps + 1);
  require_length(place, "offset_ns", record.offset_ns.size(), points);
  require_length(place, "ring", record.ring.size(), points);
  require_length(place, "intensity", record.intensity.size(), points);
  for (std::size_t k = 0; k < sweeps; ++k) {
    if (record.sweep_first[k] > record.sweep_first[k + 1]) {
      throw BadInput(fmt::format("{}.sweep_first must not decrease, but decreases at sweep {}", place, k));
    }
  }
  require_length(place, "position_L_m", points, record.sweep_first[sweeps]);
  return sweeps;
}

Sweep sweep(const sim::LidarRecord& record, std::size_t index) {
  Sweep out;
  out.start_ns = record.sweep_start_ns.at(index);
  const bool spread = record.point_times == sim::PointTimes::measured;
  out.end_ns = out.start_ns + (spread ? record.sweep_period_ns : 0);
  const bool follows = index + 1 < record.sweep_start_ns.size();
  const bool cut = follows && record.sweep_start_ns[index + 1] < out.end_ns;
  if (cut) out.end_ns = record.sweep_start_ns[index + 1];
  const std::int64_t length_ns = out.end_ns - out.start_ns;
  const std::size_t first = record.sweep_first.at(index);
  const std::size_t last = record.sweep_first.at(index + 1);
  out.points.reserve(last - first);
  for (std::size_t k = first; k < last; ++k) {
    std::int64_t offset_ns = record.offset_ns[k];
    if (cut && offset_ns > length_ns) {
      if (offset_ns > length_ns + kRounding_ns) continue;
      offset_ns = length_ns;
    }
    LidarPoint& point = out.points.emplace_back();
    point.position_L_m = record.position_L_m[k];
    point.intensity = record.intensity[k];
    point.offset_ns = static_cast<std::uint32_t>(offset_ns);
    point.ring = record.ring[k];
  }
  return out;
}

}  // namespace tumble::scenarios::bridge
