// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/repairable.hpp"
#include "scenarios/recordings/rounded_stamps.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/standard_gravity.hpp"

namespace tumble::scenarios {

namespace {

/// The median specific force of a robot is near gravity (9.8 m/s^2). The limits exclude readings in g, in mg and in raw
/// counts.
constexpr double kLeastMedian_m_s2 = 3.0, kLargestMedian_m_s2 = 30.0;

constexpr std::ptrdiff_t kStartReadings = 50;
constexpr double kWithoutGravity = 0.3;

bool near_factor(double ratio, double factor) {
  return ratio > factor / 2.0 && ratio < factor * 2.0;
}

const char* likely_force_unit(double median, AccelUnit read_as) {
  constexpr double kThousand = 1000.0;
  const double numbers = read_as == AccelUnit::g ? median / kStandardGravity_m_s2 : median;
  if (near_factor(numbers, kStandardGravity_m_s2)) return "m/s^2";
  if (near_factor(numbers, 1.0)) return "g";
  return near_factor(numbers, kThousand) ? "mg" : "raw counts of the sensor";
}

void require_plausible_force(const std::string& where, const sim::ImuRecord& imu, AccelUnit unit) {
  std::vector<double> norms;
  for (const Eigen::Vector3d& force : imu.accel_m_s2) norms.push_back(force.norm());
  const std::vector<double> start(norms.begin(), norms.begin() + std::min(std::ssize(norms), kStartReadings));
  const double middle = upper_median(std::move(norms));
  if (middle >= kLeastMedian_m_s2 && middle <= kLargestMedian_m_s2) return;
  // The reading of the accelerometer at the start indicates the unit, because a robot that starts at rest measures 1 g.
  if (const double first = upper_median(start); middle < kLeastMedian_m_s2 && first < kWithoutGravity * middle)
    throw BadInput(fmt::format(
        "{}: the specific force is {} at the start and {} in the median, so the readings may be linear acceleration, "
        "without gravity. No option repairs this; record the accelerometer with gravity (often the topic "
        "'imu/data_raw')",
        where, rounded(first), rounded(middle)));
  const char* read_as = unit == AccelUnit::g ? "g" : "m/s^2";
  const std::string likely = likely_force_unit(middle, unit);
  const bool known = likely == "g" || likely == "m/s^2";
  const std::string text = fmt::format(
      "{}: the median specific force is {} m/s^2 if the accelerometer is read in {}. The median must be from 3 to 30 "
      "m/s^2. The specific force may be in {}{}{}",
      where, std::to_string(middle), read_as, likely, known ? " (set '--accel-unit " + likely + "')" : "",
      middle < kLeastMedian_m_s2 ? "; the readings may be linear acceleration, without gravity" : "");
  if (known) throw RepairableInput(text, {"--accel-unit", likely});
  throw BadInput(text);
}

constexpr const char *kTakenInDegrees = " (set '--gyro-unit deg/s')", *kTakenInRadians = " (set '--gyro-unit rad/s')";

constexpr double kSensorReadingMax = 1e6;

double largest_of_triad(const Eigen::Vector3d& reading) {
  return reading.allFinite() ? reading.cwiseAbs().maxCoeff() : std::nan("");
}

constexpr double kLeastPeriod_s = 2e-5, kLargestPeriod_s = 2.0;

void require_plausible_period(const std::string& where, const sim::ImuRecord& imu) {
  const double period_s = static_cast<double>(imu.period_ns) * 1e-9;
  if (period_s >= kLeastPeriod_s && period_s <= kLargestPeriod_s) return;
  throw BadInput(fmt::format(
      "{}: the median time step is {} s; it must be from {} to {} s. The time stamps may be in another unit{}", where,
      rounded(period_s), rounded(kLeastPeriod_s), rounded(kLargestPeriod_s),
      period_s > kLargestPeriod_s ? ", ms or us" : " than s or ns"));
}

/// The IMU of a robot does not rotate faster than 100 rad/s.
constexpr double kLargestRate_rad_s = 100.0;
/// At most the fraction kBeyondShare of the samples may exceed kBeyondRange times the range, because single glitches
/// are normal.
constexpr double kBeyondShare = 0.01, kBeyondRange = 2.0;
constexpr double kDegreesPerRadian = 57.29577951308232;

double beyond_share(const sim::ImuRecord& imu, double bound_rad_s, double factor) {
  const auto beyond = std::count_if(imu.gyro_rad_s.begin(), imu.gyro_rad_s.end(), [&](const Eigen::Vector3d& w) {
    return factor * w.cwiseAbs().maxCoeff() > bound_rad_s;
  });
  return static_cast<double>(beyond) / static_cast<double>(imu.gyro_rad_s.size());
}

void require_rates_in_range(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit) {
  const bool stated = imu.stated_gyro_range_rad_s > 0.0;
  const double bound = stated ? kBeyondRange * imu.stated_gyro_range_rad_s : kLargestRate_rad_s;
  const double share = beyond_share(imu, bound, 1.0);
  if (share <= kBeyondShare) return;
  const bool as_rad = unit == GyroUnit::rad_s;
  const bool degrees = as_rad && beyond_share(imu, bound, 1.0 / kDegreesPerRadian) <= kBeyondShare;
  const std::string text = fmt::format(
      "{}: if the gyro is read in {}, {} % of the rates exceed {} rad/s ({}). At most 1 % of the rates may exceed this "
      "limit. The rates may be in {}{}",
      where, as_rad ? "rad/s" : "deg/s", rounded(100.0 * share), rounded(bound),
      stated ? "twice the device's range" : "above any robot's rate", degrees ? "deg/s" : "raw counts of the sensor",
      degrees ? kTakenInDegrees : "");
  if (degrees) throw RepairableInput(text, {"--gyro-unit", "deg/s"});
  throw BadInput(text);
}

constexpr double kRotationWindow_s = 0.2, kNearGravity = 0.1;
constexpr double kLeastRotation = 0.0175, kMostRotation = 0.4;  // relative change of the force
constexpr int kLeastWindows = 10;
constexpr double kLeastCorrelation = 0.8;
constexpr double kBriskRotation = 0.25;

/// Some drivers deliver IMU readings in bursts. Within a burst, a time step is at most 0.2 times the mean step, and at
/// least half of all time steps are within a burst.
constexpr double kBurstStep = 0.2, kBurstShare = 0.5;
constexpr std::size_t kLeastBursts = 10;
constexpr std::int64_t kBurstsApart_ns = 1'000'000'000;

std::string disorder_text(const std::vector<std::int64_t>& times_ns, std::size_t reading) {
  if (reading == 0 || times_ns[reading] > times_ns[reading - 1])
    return fmt::format("the time stamp of this IMU reading, {} ns, is out of order", times_ns[reading]);
  return fmt::format(
      "the time stamp (first time stamp + {} ns) must be larger than the previous time stamp (first time stamp + {} "
      "ns)",
      times_ns[reading] - times_ns.front(), times_ns[reading - 1] - times_ns.front());
}

std::string even_out_bursts(sim::ImuRecord& imu) {
  std::vector<std::int64_t>& times = imu.time_ns;
  if (times.size() < 2) return "";
  std::int64_t sum = 0;
  std::size_t steps = 0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const std::int64_t step = times[k] - times[k - 1];
    if (step < 0) return "";
    if (step < kBurstsApart_ns) sum += step, ++steps;
  }
  if (steps == 0 || sum == 0) return "";
  const double short_ns = kBurstStep * static_cast<double>(sum) / static_cast<double>(steps);
  std::vector<std::size_t> ends;  // after each burst
  for (std::size_t k = 1; k <= times.size(); ++k) {
    if (k == times.size() || static_cast<double>(times[k] - times[k - 1]) > short_ns) ends.push_back(k);
  }
  if (ends.size() < kLeastBursts ||
      static_cast<double>(times.size() - ends.size()) < kBurstShare * static_cast<double>(times.size()))
    return "";
  const std::int64_t period_ns = sum / static_cast<std::int64_t>(steps);
  std::int64_t before = times[ends.front() - 1] - static_cast<std::int64_t>(ends.front()) * period_ns;
  for (std::size_t b = 0, first = 0; b < ends.size(); first = ends[b++]) {
    const std::int64_t last = times[ends[b] - 1];
    const auto count = static_cast<std::int64_t>(ends[b] - first);
    const std::int64_t step = std::min((last - before) / count, 2 * period_ns);  // after a gap, from its end
    for (std::size_t k = first; k < ends[b]; ++k) times[k] = last - static_cast<std::int64_t>(ends[b] - 1 - k) * step;
    before = last;
  }
  return fmt::format(
      "caution: the readings have nearly equal time stamps in {} bursts of about {} readings; the import distributes "
      "the readings over the time between the bursts",
      ends.size(), times.size() / ends.size());
}

}  // namespace

std::string gaps_text(const sim::ImuRecord& imu) {
  constexpr std::int64_t kGap_ns = 1'000'000'000;
  std::size_t gaps = 0, longest = 0;
  const auto step_ns = [&](std::size_t k) { return k == 0 ? 0 : imu.time_ns[k] - imu.time_ns[k - 1]; };
  for (std::size_t k = 1; k < imu.time_ns.size(); ++k) {
    if (step_ns(k) <= std::max(kGap_ns, 2 * imu.period_ns)) continue;
    ++gaps;
    if (step_ns(k) > step_ns(longest)) longest = k;
  }
  if (gaps == 0) return "";
  return fmt::format(
      "caution: the recording has {}{} of more than 1 s without data; the longest gap lasts {} s before reading {}",
      gaps, gaps == 1 ? " gap" : " gaps", rounded(1e-9 * static_cast<double>(step_ns(longest))), longest);
}

GravityRotation gravity_rotation(const sim::ImuRecord& imu, RotationWindows windows) {
  GravityRotation turn;
  double predicted2 = 0.0, seen2 = 0.0, both = 0.0;
  const std::size_t count = imu.time_ns.size();
  const auto near = [&](std::size_t k) {
    return std::abs(imu.accel_m_s2[k].norm() / kStandardGravity_m_s2 - 1.0) < kNearGravity;
  };
  for (std::size_t begin = 0; begin + 4 < count;) {
    std::size_t end = begin;
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();
    const auto turned = [&] {
      return windows == RotationWindows::brisk && end >= begin + 4 &&
             (imu.accel_m_s2[end] - imu.accel_m_s2[begin]).norm() > kBriskRotation * kStandardGravity_m_s2;
    };
    while (end + 1 < count && near(end) && !turned() &&
           1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[begin]) < kRotationWindow_s) {
      ++end;
      angle += imu.gyro_rad_s[end] * (1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[end - 1]));
    }
    const double length_s = 1e-9 * static_cast<double>(imu.time_ns[end] - imu.time_ns[begin]);
    const bool whole = near(end) && end >= begin + 4 && (length_s >= kRotationWindow_s || turned()) &&
                       length_s < 1.5 * kRotationWindow_s;
    if (whole) {
      // To reduce noise, the specific force is averaged over the first and over the last quarter of the readings, and
      // the change is the difference of these means.
      const std::size_t quarter = std::max<std::size_t>(1, (end - begin) / 4);
      Eigen::Vector3d first = Eigen::Vector3d::Zero(), last = Eigen::Vector3d::Zero(), middle = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < quarter; ++k) first += imu.accel_m_s2[begin + k], last += imu.accel_m_s2[end - k];
      for (std::size_t k = begin; k <= end; ++k) middle += imu.accel_m_s2[k];
      const Eigen::Vector3d seen = (last - first) / static_cast<double>(quarter);
      const double share = 1.0 - static_cast<double>(quarter - 1) / static_cast<double>(end - begin);
      const Eigen::Vector3d predicted = -share * angle.cross(middle / static_cast<double>(end - begin + 1));
      if (seen.norm() > kLeastRotation * kStandardGravity_m_s2 && seen.norm() < kMostRotation * kStandardGravity_m_s2) {
        ++turn.windows;
        both += predicted.dot(seen), predicted2 += predicted.squaredNorm(), seen2 += seen.squaredNorm();
      }
    }
    begin = std::max(end, begin + 1);
  }
  if (predicted2 > 0.0 && seen2 > 0.0) {
    turn.ratio = both / predicted2;
    turn.correlation = both / std::sqrt(predicted2 * seen2);
  }
  return turn;
}

namespace {

bool has_sufficient_rotation(const GravityRotation& turn) {
  return turn.windows >= kLeastWindows && std::abs(turn.correlation) >= kLeastCorrelation;
}

GravityRotation sufficient_rotation(const sim::ImuRecord& imu) {
  const GravityRotation turn = gravity_rotation(imu, RotationWindows::even);
  // During 0.2 s, a fast rolling sphere rotates too far for the comparison with the gyro, so shorter intervals are also
  // tried.
  return has_sufficient_rotation(turn) ? turn : gravity_rotation(imu, RotationWindows::brisk);
}

std::string undetermined_text(const GravityRotation& turn) {
  if (turn.windows < kLeastWindows)
    return "unit and axes are not checked, because gravity rotates too little in the accelerometer axes";
  return fmt::format(
      "unit and axes are not checked, because gyro and accelerometer measure different rotations ({} time windows, "
      "correlation {})",
      turn.windows, rounded(turn.correlation));
}

}  // namespace

std::string require_plausible_rates(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit) {
  require_rates_in_range(where, imu, unit);
  const GravityRotation turn = sufficient_rotation(imu);
  const bool dead =
      std::all_of(imu.gyro_rad_s.begin(), imu.gyro_rad_s.end(), [](const auto& w) { return w.isZero(0.0); });
  if (dead) {
    return fmt::format(
        "caution: the gyro reads 0 on all axes in all {} samples; the gyro may be defective or was not recorded",
        imu.gyro_rad_s.size());
  }
  if (!has_sufficient_rotation(turn)) return "";
  const std::string seen = fmt::format(
      "the rotation measured by the accelerometer is {} times the rotation measured by the gyro ({} time windows, "
      "correlation {})",
      rounded(turn.ratio), turn.windows, rounded(turn.correlation));
  const bool as_deg = unit == GyroUnit::deg_s;
  if (!as_deg && near_factor(turn.ratio, 1.0 / kDegreesPerRadian))
    throw RepairableInput(fmt::format("{}: if the gyro is read in rad/s, {}. The ratio of accelerometer rotation to "
                                      "gyro rotation must be from 0.5 to 2. The rates may be in deg/s{}",
                                      where, seen, kTakenInDegrees),
                          {"--gyro-unit", "deg/s"});
  if (as_deg && near_factor(turn.ratio, kDegreesPerRadian))
    throw RepairableInput(fmt::format("{}: if the gyro is read in deg/s, {}. The ratio of accelerometer rotation to "
                                      "gyro rotation must be from 0.5 to 2. The rates may be in rad/s{}",
                                      where, seen, kTakenInRadians),
                          {"--gyro-unit", "rad/s"});
  if (near_factor(turn.ratio, 1.0)) return fmt::format("{}, so gyro and accelerometer agree in units and axes", seen);
  return fmt::format(
      "caution: {}. The rotation of measured gravity should equal the rotation measured by the gyro (ratio 1). Check "
      "units, signs and order of the axes of both sensors",
      seen);
}

std::string rates_text(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit) {
  const std::string warning = require_plausible_rates(where, imu, unit);
  if (!warning.empty()) return warning;
  return fmt::format("the import reads rates in {}, with unchanged signs and axes: {}",
                     unit == GyroUnit::deg_s ? "deg/s" : "rad/s", undetermined_text(sufficient_rotation(imu)));
}

sim::ImuRecord without_readings(sim::ImuRecord device) {
  for (auto* rows : {&device.gyro_rad_s, &device.accel_m_s2}) rows->clear();
  device.time_ns.clear();
  device.period_ns = 0;
  device.clip_flags.clear();
  return device;
}

void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu) {
  for (const double value : {largest_of_triad(rate_rad_s), largest_of_triad(force_m_s2)}) {
    if (!std::isfinite(value)) throw BadInput(fmt::format("{}: an IMU reading has a value that is not finite", where));
    if (value > kSensorReadingMax)
      throw BadInput(fmt::format(
          "{}: an IMU reading has the magnitude {} rad/s or m/s^2; it must be at most {}, the limit of any sensor",
          where, rounded(value), rounded(kSensorReadingMax)));
  }
  imu.time_ns.push_back(stamp_ns);
  imu.gyro_rad_s.push_back(rate_rad_s);
  imu.accel_m_s2.push_back(force_m_s2);
  imu.clip_flags.push_back(0);
}

std::string leave_out_faulty(const ReadingText& where, const ReadingText& disorder, LeftOut& left_out,
                             sim::ImuRecord& imu) {
  const std::string bursts = even_out_bursts(imu);
  std::vector<bool> kept = stamps_in_order(imu.time_ns);
  std::vector<std::int64_t> in_order;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (kept[k])
      in_order.push_back(imu.time_ns[k]);
    else
      left_out.add("a wrong time stamp", where(k) + ": " + (disorder ? disorder(k) : disorder_text(imu.time_ns, k)));
  }
  left_out.require_few(in_order.size());
  imu.period_ns = median_step_ns(in_order);  // lost readings leave gaps
  std::size_t lost = 0;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (!kept[k] || !imu.gyro_rad_s[k].isZero(0.0) || !imu.accel_m_s2[k].isZero(0.0)) continue;
    left_out.add_unlimited("values that are exactly 0", where(k));
    kept[k] = false;
    ++lost;
  }
  if (lost > 0 && lost == in_order.size())
    throw BadInput(fmt::format("{}: all values of all readings are exactly 0, so the file contains no data", where(0)));
  keep_rows(kept, imu.time_ns), keep_rows(kept, imu.gyro_rad_s), keep_rows(kept, imu.accel_m_s2);
  keep_rows(kept, imu.clip_flags), keep_rows(kept, imu.magnetic_field_t);
  return bursts;
}

void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu) {
  if (imu.time_ns.size() < 2)
    throw BadInput(fmt::format("{}: the file has {} IMU samples; it needs at least 2", where, imu.time_ns.size()));
  require_plausible_force(where, imu, unit);
  if (imu.period_ns <= 0) imu.period_ns = median_step_ns(imu.time_ns);
  require_plausible_period(where, imu);
}

bool is_in_g(const sim::ImuRecord& imu) {
  constexpr double kMedianOff = 0.1, kAtRestOff = 0.02, kAtRestShare = 0.2;
  std::vector<double> norms;
  for (const Eigen::Vector3d& force : imu.accel_m_s2) norms.push_back(force.norm());
  const auto at_rest =
      std::count_if(norms.begin(), norms.end(), [](double norm) { return std::abs(norm - 1.0) < kAtRestOff; });
  const bool rests = static_cast<double>(at_rest) >= kAtRestShare * static_cast<double>(norms.size());
  return !norms.empty() && rests && std::abs(upper_median(std::move(norms)) - 1.0) < kMedianOff;
}

std::string even_out_stamps(sim::ImuRecord& imu) {
  if (!are_rounded(imu.time_ns)) return "";
  imu.time_ns = evened(imu.time_ns);
  imu.period_ns = mean_step_ns(imu.time_ns);
  return fmt::format(
      "the time stamps are whole milliseconds, but the IMU samples every {} ms. The import replaces the time stamps by "
      "equally spaced times, which shifts each time by at most 1 ms",
      rounded(1e-6 * static_cast<double>(imu.period_ns)));
}

double scale_of(AccelUnit unit) {
  return unit == AccelUnit::g ? kStandardGravity_m_s2 : 1.0;
}

double scale_of(GyroUnit unit) {
  return unit == GyroUnit::deg_s ? 1.0 / kDegreesPerRadian : 1.0;
}

}  // namespace tumble::scenarios
