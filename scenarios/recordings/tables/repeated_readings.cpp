// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/repeated_readings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/recordings/tables/steady_stamps.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kHeldShare = 0.05, kFrozenShare = 0.98;
constexpr double kRailLeast_m_s2 = 14.7;
constexpr int kRailReadings = 5, kRailContrast = 3;

/// Returns the first row, and all rows whose reading differs from that in the previous row.
std::vector<std::size_t> fresh_rows(const std::vector<Eigen::Vector3d>& readings) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k == 0 || readings[k] != readings[k - 1]) rows.push_back(k);
  }
  return rows;
}

/// Returns regular times for the readings in `rows`. The true time of each reading is between the previous row and its
/// row.
std::vector<std::int64_t> beat_of(const std::vector<std::int64_t>& time_ns, const std::vector<std::size_t>& rows) {
  std::vector<std::int64_t> stamps;
  std::vector<StampBounds> bounds;
  for (const std::size_t row : rows) {
    stamps.push_back(time_ns[row]);
    bounds.push_back({row == 0 ? 0 : time_ns[row] - time_ns[row - 1] - 1, 0});
  }
  return steady_stamps(stamps, bounds);
}

double repeated_share(std::size_t fresh, std::size_t rows) {
  return rows < 2 ? 0.0 : static_cast<double>(rows - fresh) / static_cast<double>(rows - 1);
}

/// A sensor whose readings almost always repeat is frozen, or noise-free at rest; its period is unknown.
bool is_repeated(double share) {
  return share > kHeldShare && share < kFrozenShare;
}

/// Interpolates readings linearly at the increasing times `times`. Before the first and after the last reading, the
/// value is constant.
std::vector<Eigen::Vector3d> interpolated(const std::vector<std::int64_t>& own,
                                          const std::vector<Eigen::Vector3d>& values,
                                          const std::vector<std::int64_t>& times) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(times.size());
  std::size_t next = 0;
  for (const std::int64_t time : times) {
    while (next < own.size() && own[next] < time) ++next;
    if (next == 0 || next == own.size()) {
      out.push_back(values[next == 0 ? 0 : next - 1]);
      continue;
    }
    const double share = static_cast<double>(time - own[next - 1]) / static_cast<double>(own[next] - own[next - 1]);
    out.push_back((1.0 - share) * values[next - 1] + share * values[next]);
  }
  return out;
}

std::vector<Eigen::Vector3d> at_rows(const std::vector<Eigen::Vector3d>& values, const std::vector<std::size_t>& rows) {
  std::vector<Eigen::Vector3d> out;
  for (const std::size_t row : rows) out.push_back(values[row]);
  return out;
}

}  // namespace

RepeatReport remove_repeats(const LoggedReadings& log, sim::ImuRecord& imu) {
  RepeatReport report;
  report.rows = log.time_ns.size();
  const std::vector<std::size_t> gyro = fresh_rows(log.gyro_rad_s), accel = fresh_rows(log.accel_m_s2);
  report.gyro_repeated = repeated_share(gyro.size(), report.rows);
  report.accel_repeated = repeated_share(accel.size(), report.rows);
  report.accel_readings = accel.size();
  report.gyro_repeats = is_repeated(report.gyro_repeated);
  imu.time_ns = report.gyro_repeats ? beat_of(log.time_ns, gyro) : log.time_ns;
  imu.gyro_rad_s = report.gyro_repeats ? at_rows(log.gyro_rad_s, gyro) : log.gyro_rad_s;
  const std::vector<Eigen::Vector3d> beside = report.gyro_repeats ? at_rows(log.accel_m_s2, gyro) : log.accel_m_s2;
  report.accel_repeats = is_repeated(repeated_share(fresh_rows(beside).size(), beside.size()));
  imu.accel_m_s2 = report.accel_repeats
                       ? interpolated(beat_of(log.time_ns, accel), at_rows(log.accel_m_s2, accel), imu.time_ns)
                       : beside;
  imu.clip_flags.assign(imu.time_ns.size(), 0);
  report.readings = imu.time_ns.size();
  return report;
}

std::string RepeatReport::text() const {
  if (!gyro_repeats && !accel_repeats) return "";
  std::string out = fmt::format(
      "the device repeats readings (sample and hold): {:.1f} % of the gyro's rows and {:.1f} % of the accelerometer's "
      "rows equal the previous row. There are {} different gyro readings and {} different accelerometer readings in {} "
      "rows",
      100.0 * gyro_repeated, 100.0 * accel_repeated, gyro_repeats ? readings : rows, accel_readings, rows);
  if (gyro_repeats) out += "; repeated rows are left out, and the remaining readings get the sample times of the gyro";
  if (accel_repeats) out += "; the accelerometer is interpolated between its distinct readings";
  return out;
}

std::string accel_rail_text(const std::vector<Eigen::Vector3d>& logged) {
  const std::vector<Eigen::Vector3d> readings = at_rows(logged, fresh_rows(logged));
  std::string out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      double extreme = 0.0;
      for (const Eigen::Vector3d& f : readings) extreme = std::max(extreme, sign * f[axis]);
      if (extreme < kRailLeast_m_s2) continue;
      const auto within = [&](double low, double high) {
        return static_cast<int>(std::count_if(readings.begin(), readings.end(), [&](const Eigen::Vector3d& f) {
          return sign * f[axis] > low * extreme && sign * f[axis] <= high * extreme;
        }));
      };
      const int top = within(0.98, 1.0), below = within(0.96, 0.98);
      if (top < kRailReadings || top < kRailContrast * below) continue;
      out += fmt::format("{}{}{} within 2 % of {:.2f} m/s^2 ({})", out.empty() ? "" : ", ", sign > 0 ? "+" : "-",
                         "xyz"[axis], sign * extreme, top);
    }
  }
  return out.empty()
             ? ""
             : fmt::format(
                   "the accelerometer seems to be saturated, because many readings are near the largest value: {}",
                   out);
}

}  // namespace tumble::scenarios
