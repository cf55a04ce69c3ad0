// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kOwnZero_ns = 1000000000;

void shift(sim::Sensors& sensors, std::int64_t by_ns) {
  for (sim::ImuRecord& imu : sensors.imus) {
    for (std::int64_t& time : imu.time_ns) time += by_ns;
  }
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::int64_t& time : lidar.sweep_start_ns) time += by_ns;
  }
  for (sim::SeriesRecord& series : sensors.series) {
    for (std::int64_t& time : series.time_ns) time += by_ns;
  }
}

}  // namespace

std::pair<std::int64_t, std::int64_t> span_of(const sim::Sensors& sensors) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max(), last = std::numeric_limits<std::int64_t>::min();
  for (const sim::ImuRecord& imu : sensors.imus) {
    if (imu.time_ns.empty()) continue;
    first = std::min(first, imu.time_ns.front());
    last = std::max(last, imu.time_ns.back());
  }
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    if (lidar.sweep_start_ns.empty()) continue;
    first = std::min(first, lidar.sweep_start_ns.front());
    last = std::max(last, lidar.sweep_start_ns.back() + lidar.sweep_period_ns);
  }
  for (const sim::SeriesRecord& series : sensors.series) {
    if (series.time_ns.empty()) continue;
    first = std::min(first, series.time_ns.front());
    last = std::max(last, series.time_ns.back());
  }
  if (first > last) throw BadInput("the recording contains no readings of any sensor");
  return {first, last};
}

std::int64_t origin_of(std::int64_t first_ns) {
  for (const std::int64_t zero_ns : {std::int64_t{0}, kExportOrigin_ns})
    if (first_ns >= zero_ns && first_ns < zero_ns + kOwnZero_ns) return zero_ns;
  return first_ns;
}

std::optional<std::int64_t> clock_shift_ns(const StampSpan& moved, const StampSpan& fixed,
                                           std::initializer_list<std::int64_t> shifts_ns) {
  for (const std::int64_t shift_ns : shifts_ns)
    if (moved.first <= fixed.second - shift_ns && moved.second >= fixed.first - shift_ns) return shift_ns;
  return std::nullopt;
}

std::string clock_note(const std::string& what, std::int64_t shift_ns) {
  return fmt::format(
      "the time stamps of {} count from {} s. The import shifts these time stamps by {} s, because exported recordings "
      "start at {} s",
      what, shift_ns > 0 ? 0 : kExportOrigin_ns / kSecond_ns, shift_ns / kSecond_ns, kExportOrigin_ns / kSecond_ns);
}

void start_clock(Imported& recording) {
  recording.info.origin_ns = origin_of(span_of(recording.sensors).first);
  shift(recording.sensors, -recording.info.origin_ns);
}

void add_lidar(Imported& recording, BuiltSweeps built) {
  recording.sensors.lidars.push_back(std::move(built.lidar));
  recording.cloud_fields.push_back(std::move(built.fields));
  if (built.points) recording.points.push_back(std::move(*built.points));
}

void correct_lidar_clock(double imu_minus_lidar_clock_s, Imported& recording) {
  for (sim::LidarRecord& lidar : recording.sensors.lidars) {
    for (std::int64_t& start_ns : lidar.sweep_start_ns) start_ns += std::llround(1e9 * imu_minus_lidar_clock_s);
  }
  recording.imu_minus_lidar_clock_s += imu_minus_lidar_clock_s;
  if (recording.record_shift_s) *recording.record_shift_s -= imu_minus_lidar_clock_s;
}

void attach_imus(Imported& recording, Imported imu) {
  const auto [first, last] = span_of(recording.sensors);
  const auto [imu_first, imu_last] = span_of(imu.sensors);
  std::int64_t ahead_ns = imu.info.origin_ns - recording.info.origin_ns;
  const auto shift_ns = clock_shift_ns({imu_first + ahead_ns, imu_last + ahead_ns}, {first, last},
                                       {0, kExportOrigin_ns, -kExportOrigin_ns});
  if (!shift_ns) {
    throw BadInput(
        fmt::format("the IMU readings cover {} to {} ns on the sweeps' clock, but the sweeps cover {} to {} ns; check "
                    "that both use the same clock",
                    imu_first + ahead_ns, imu_last + ahead_ns, first, last));
  }
  if (*shift_ns != 0) recording.notes.push_back(clock_note("the IMU readings", *shift_ns));
  imu.info.origin_ns += *shift_ns;
  const std::int64_t origin_ns = std::min(recording.info.origin_ns, imu.info.origin_ns);
  shift(recording.sensors, recording.info.origin_ns - origin_ns);
  shift(imu.sensors, imu.info.origin_ns - origin_ns);
  recording.info.origin_ns = origin_ns;
  recording.info.attribution += "; " + imu.info.attribution;
  recording.notes.insert(recording.notes.end(), imu.notes.begin(), imu.notes.end());
  for (sim::ImuRecord& each : imu.sensors.imus) recording.sensors.imus.push_back(std::move(each));
}

}  // namespace tumble::scenarios
