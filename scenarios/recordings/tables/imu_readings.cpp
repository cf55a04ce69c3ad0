// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_readings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/upper_median.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kG_m_s2 = 9.80665;
/// At rest and while rolling or carried the median is near g; in g, mg or raw counts it is not.
constexpr double kLeastMedian_m_s2 = 3.0, kLargestMedian_m_s2 = 30.0;

void require_plausible_force(const std::string& where, const sim::ImuRecord& imu, AccelUnit unit) {
  std::vector<double> norms;
  for (const Eigen::Vector3d& force : imu.accel_m_s2) norms.push_back(force.norm());
  const double middle = upper_median(std::move(norms));
  if (middle >= kLeastMedian_m_s2 && middle <= kLargestMedian_m_s2) return;
  const char* read_as = unit == AccelUnit::g ? "g" : "m/s^2";
  throw BadInput(where + ": read in " + read_as + " the median specific force is " + std::to_string(middle) +
                 " m/s^2, must be within 3 and 30: is the file in " + (unit == AccelUnit::g ? "m/s^2" : "g") + "?");
}

constexpr double kTurnWindow_s = 0.2, kNearGravity = 0.1;
constexpr double kLeastTurn = 0.0175, kMostTurn = 0.4;  // of the force, as shares of it: from one degree on
constexpr int kLeastWindows = 10;
constexpr double kLeastCorrelation = 0.8;
constexpr double kDegreesPerRadian = 57.29577951308232;

bool near_factor(double ratio, double factor) {
  return ratio > factor / 2.0 && ratio < factor * 2.0;
}

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

GravityTurn gravity_turn(const sim::ImuRecord& imu) {
  GravityTurn turn;
  double said2 = 0.0, seen2 = 0.0, both = 0.0;
  const std::size_t count = imu.time_ns.size();
  const auto near = [&](std::size_t k) { return std::abs(imu.accel_m_s2[k].norm() / kG_m_s2 - 1.0) < kNearGravity; };
  for (std::size_t begin = 0; begin + 4 < count;) {
    std::size_t end = begin;
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();
    while (end + 1 < count && near(end) &&
           1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[begin]) < kTurnWindow_s) {
      ++end;
      // a sample is the mean over what ends at its stamp
      angle += imu.gyro_rad_s[end] * (1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[end - 1]));
    }
    const double length_s = 1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[begin]);
    const bool whole = near(end) && end >= begin + 4 && length_s >= kTurnWindow_s && length_s < 1.5 * kTurnWindow_s;
    if (whole) {
      // the ends' means over a quarter each, so that noise does not pass for turning
      const std::size_t quarter = std::max<std::size_t>(1, (end - begin) / 4);
      Eigen::Vector3d first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero(), middle = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < quarter; ++k) first += imu.accel_m_s2[begin + k], last += imu.accel_m_s2[end - k];
      for (std::size_t k = begin; k <= end; ++k) middle += imu.accel_m_s2[k];
      const Eigen::Vector3d seen = (last - first) / static_cast<double>(quarter);
      const double share = 1.0 - static_cast<double>(quarter - 1) / static_cast<double>(end - begin);
      const Eigen::Vector3d said = -share * angle.cross(middle / static_cast<double>(end - begin + 1));
      if (seen.norm() > kLeastTurn * kG_m_s2 && seen.norm() < kMostTurn * kG_m_s2) {
        ++turn.windows;
        both += said.dot(seen), said2 += said.squaredNorm(), seen2 += seen.squaredNorm();
      }
    }
    begin = std::max(end, begin + 1);
  }
  if (said2 > 0.0 && seen2 > 0.0) {
    turn.ratio = both / said2;
    turn.correlation = both / std::sqrt(said2 * seen2);
  }
  return turn;
}

std::string require_gravity_turns(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit) {
  const GravityTurn turn = gravity_turn(imu);
  if (turn.windows < kLeastWindows || std::abs(turn.correlation) < kLeastCorrelation) return "";
  const std::string seen = "gravity turns in the accelerometer " + rounded(turn.ratio) + " times as the gyro says (" +
                           std::to_string(turn.windows) + " windows, correlation " + rounded(turn.correlation) + ")";
  const bool as_deg = unit == GyroUnit::deg_s;
  if (!as_deg && near_factor(turn.ratio, 1.0 / kDegreesPerRadian))
    throw BadInput(where + ": read in rad/s, " + seen + ", must be within 0.5 and 2: are the rates in deg/s?");
  if (as_deg && near_factor(turn.ratio, kDegreesPerRadian))
    throw BadInput(where + ": read in deg/s, " + seen + ", must be within 0.5 and 2: are the rates in rad/s?");
  if (near_factor(turn.ratio, 1.0)) return seen + ": units and axes agree";
  return "caution: " + seen + ", and should once: another unit, sign or order of the axes?";
}

sim::ImuRecord without_readings(sim::ImuRecord device) {
  for (auto* rows : {&device.gyro_rad_s, &device.accel_m_s2}) rows->clear();
  device.time_ns.clear();
  device.clip_flags.clear();
  return device;
}

void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu) {
  if (!rate_rad_s.allFinite() || !force_m_s2.allFinite()) throw BadInput(where + ": a reading is not finite");
  if (!imu.time_ns.empty() && stamp_ns <= imu.time_ns.back()) {
    throw BadInput(where + ": stamp does not rise: " + std::to_string(stamp_ns - imu.time_ns.front()) +
                   " ns after the first, the one before " + std::to_string(imu.time_ns.back() - imu.time_ns.front()));
  }
  imu.time_ns.push_back(stamp_ns);
  imu.gyro_rad_s.push_back(rate_rad_s);
  imu.accel_m_s2.push_back(force_m_s2);
  imu.clip_flags.push_back(0);
}

void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu) {
  if (imu.time_ns.size() < 2)
    throw BadInput(where + ": holds " + std::to_string(imu.time_ns.size()) + " samples, needs 2");
  require_plausible_force(where, imu, unit);
  imu.period_ns = median_step_ns(imu.time_ns);
}

double scale_of(AccelUnit unit) {
  return unit == AccelUnit::g ? kG_m_s2 : 1.0;
}

double scale_of(GyroUnit unit) {
  return unit == GyroUnit::deg_s ? 1.0 / kDegreesPerRadian : 1.0;
}

}  // namespace tumble::scenarios
