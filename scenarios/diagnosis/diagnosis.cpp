// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scenarios/estimates/findings.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/status.hpp"

namespace tumble::scenarios {

namespace {

/// Largest accepted time between the first IMU sample and the first lidar sweep [s].
constexpr double kApart_s = 0.5;
/// Largest accepted fraction of lost sensor readings. A single lost reading costs no accuracy, but many lost readings
/// indicate a fault of the bus, the driver or the recorder.
constexpr double kLostShareMax = 0.005;
constexpr std::int64_t kLeastLost = 2;
/// A sensor reading counts as lost if the time step between two readings exceeds 1.5 sample periods.
constexpr double kLostStep = 1.5;
/// The estimators initialise attitude and gyro bias in the first second of a recording.
constexpr double kStart_s = 1.0;
constexpr double kRegisteredShareMin = 0.8;
/// A gyro that saturates below kOfRangeMin times its stated range was probably configured with another range.
constexpr double kOfRangeMin = 0.7;

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

std::string percent_text(double share) {
  return rounded(100.0 * share) + " %";
}

std::optional<RecordingFinding> lost_items(const std::string& name, const char* items, std::int64_t period_ns,
                                           std::span<const std::int64_t> times_ns) {
  if (times_ns.size() < 2 || period_ns <= 0) return std::nullopt;
  std::int64_t missing = 0, longest_ns = 0;
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    const std::int64_t step_ns = times_ns[k] - times_ns[k - 1];
    longest_ns = std::max(longest_ns, step_ns);
    const double steps = static_cast<double>(step_ns) / static_cast<double>(period_ns);
    if (steps > kLostStep) missing += std::llround(steps) - 1;
  }
  const double share = static_cast<double>(missing) / static_cast<double>(missing + std::ssize(times_ns));
  if (missing < kLeastLost || share <= kLostShareMax) return std::nullopt;
  return RecordingFinding{
      name,
      fmt::format("in the recording, {} of {} {} are lost (share {}, limit {}); the longest gap lasts {} s", missing,
                  missing + std::ssize(times_ns), items, percent_text(share), percent_text(kLostShareMax),
                  rounded(1e-9 * static_cast<double>(longest_ns))),
      "record without loss, for example with larger queues or a faster disk, and check that the sensor's clock does "
      "not "
      "jump; the estimators bridge gaps up to 1 s"};
}

std::optional<RecordingFinding> late_start(const sim::Sensors& sensors) {
  if (sensors.imus.empty() || sensors.lidars.empty()) return std::nullopt;
  const sim::ImuRecord& imu = sensors.imus.front();
  const sim::LidarRecord& lidar = sensors.lidars.front();
  if (imu.time_ns.empty() || lidar.sweep_start_ns.empty()) return std::nullopt;
  const double late_s = seconds_between(imu.time_ns.front(), lidar.sweep_start_ns.front());
  if (std::abs(late_s) <= kApart_s) return std::nullopt;
  const bool lidar_late = late_s > 0.0;
  return RecordingFinding{
      lidar_late ? lidar.name : imu.name,
      fmt::format("this sensor starts {} s after '{}' (limit {} s)", rounded(std::abs(late_s)),
                  lidar_late ? imu.name : lidar.name, rounded(kApart_s)),
      lidar_late ? "start the recording after the lidar has started; the map starts at the first sweep"
                 : "start the recording after the IMU has started; sweeps before the first IMU reading are left out"};
}

std::optional<RecordingFinding> moving_start(const sim::ImuRecord& imu) {
  std::vector<ImuSample> samples;
  if (!bridge::imu_samples(imu, samples).ok() || samples.empty()) return std::nullopt;
  const TimeNs first_ns = samples.front().time_ns;
  std::erase_if(samples, [&](const ImuSample& each) { return seconds_between(first_ns, each.time_ns) > kStart_s; });
  Eigen::Vector3d mean_rad_s = Eigen::Vector3d::Zero(), mean_m_s2 = Eigen::Vector3d::Zero();
  for (const ImuSample& each : samples)
    mean_rad_s += each.angular_velocity_rad_s, mean_m_s2 += each.specific_force_m_s2;
  mean_rad_s /= static_cast<double>(samples.size()), mean_m_s2 /= static_cast<double>(samples.size());
  const std::vector<bool> rests = RestDetector({}).find(samples, mean_rad_s);
  if (std::ranges::count(rests, true) > 0) return std::nullopt;
  double rate_rad_s = 0.0, force_m_s2 = 0.0;
  for (const ImuSample& each : samples) {
    rate_rad_s = std::max(rate_rad_s, (each.angular_velocity_rad_s - mean_rad_s).cwiseAbs().maxCoeff());
    force_m_s2 = std::max(force_m_s2, (each.specific_force_m_s2 - mean_m_s2).cwiseAbs().maxCoeff());
  }
  const RestDetector::Params limits;
  return RecordingFinding{
      imu.name,
      fmt::format("the robot moves during the first second: angular rates vary by {} rad/s (limit {}), specific forces "
                  "by {} m/s^2 (limit {})",
                  rounded(rate_rad_s), rounded(limits.rate_spread_rad_s), rounded(force_m_s2),
                  rounded(limits.force_spread_m_s2)),
      "keep the robot still for 1 s after the start of the recording; otherwise the initial attitude and gyro bias are "
      "less accurate"};
}

Saturation saturation_beyond(const SaturationLimitDetector::Params& stated, const sim::ImuRecord& imu) {
  std::vector<ImuSample> samples;
  Saturation out;
  if (!bridge::imu_samples(imu, samples).ok() || samples.empty()) return out;
  ClippingFinder::Params params;
  params.axis_limit_params = stated;
  const std::vector<Clipping> clippings = ClippingFinder(params).find(samples).clipping_per_sample;
  std::size_t gyro = 0, accel = 0;
  const auto keep_smallest = [](const Eigen::Vector3d& reading, unsigned axes, double& smallest) {
    for (int j = 0; j < 3; ++j) {
      if ((axes >> static_cast<unsigned>(j) & 1u) == 0u) continue;
      const double size = std::abs(reading[j]);
      smallest = smallest > 0.0 ? std::min(smallest, size) : size;
    }
  };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    gyro += clippings[k].gyro != 0 ? 1 : 0;
    accel += clippings[k].accel != 0 ? 1 : 0;
    keep_smallest(samples[k].angular_velocity_rad_s, clippings[k].gyro, out.gyro_rad_s);
    keep_smallest(samples[k].specific_force_m_s2, clippings[k].accel, out.accel_m_s2);
  }
  out.gyro_share = static_cast<double>(gyro) / static_cast<double>(samples.size());
  out.accel_share = static_cast<double>(accel) / static_cast<double>(samples.size());
  return out;
}

void add_saturation(const sim::ImuRecord& imu, std::vector<RecordingFinding>& out) {
  Saturation found = saturation_of(imu);
  if (found.gyro_share == 0.0) {  // the stated range hides a smaller range
    const Saturation detected = saturation_beyond({}, imu);
    if (detected.gyro_rad_s < kOfRangeMin * imu.stated_gyro_range_rad_s)
      found.gyro_share = detected.gyro_share, found.gyro_rad_s = detected.gyro_rad_s;
  }
  const auto range = [](double stated, const char* unit) {
    return stated > 0.0 ? fmt::format(" (stated range: {} {})", rounded(stated), unit) : std::string();
  };
  if (found.gyro_share > 0.0) {
    const bool below = found.gyro_rad_s < kOfRangeMin * imu.stated_gyro_range_rad_s;
    out.push_back(
        {imu.name,
         fmt::format("the gyro is saturated in {} of the samples; its smallest saturated reading is {} rad/s{}",
                     percent_text(found.gyro_share), rounded(found.gyro_rad_s),
                     range(imu.stated_gyro_range_rad_s, "rad/s")),
         below ? "leave out --device: the gyro saturates far below the range of the data sheet"
               : "set a larger gyro range in the IMU's driver, if possible; 'tumble odometry' estimates the "
                 "rates beyond the range",
         false});
  }
  if (found.accel_share > 0.0)
    out.push_back(
        {imu.name,
         fmt::format(
             "the accelerometer is saturated in {} of the samples; its smallest saturated reading is {} m/s^2{}",
             percent_text(found.accel_share), rounded(found.accel_m_s2), range(imu.stated_accel_range_m_s2, "m/s^2")),
         "set a larger accelerometer range in the IMU's driver", false});
}

}  // namespace

std::string recommended_option(const std::string& message) {
  const std::string mark = "set '";
  const std::size_t begin = message.find(mark + "--");
  if (begin == std::string::npos) return "";
  const std::size_t first = begin + mark.size(), end = message.find('\'', first);
  return end == std::string::npos ? "" : message.substr(first, end - first);
}

std::vector<RecordingFinding> findings_in_notes(std::span<const std::string> notes) {
  const std::string mark = "caution: ";
  std::vector<RecordingFinding> out;
  for (const std::string& note : notes) {
    const std::size_t at = note.find(mark);
    if (at == std::string::npos) continue;
    const std::string where = at >= 2 ? note.substr(0, at - 2) : "";
    out.push_back({where, note.substr(at + mark.size()), recommended_option(note)});
  }
  return out;
}

Saturation saturation_of(const sim::ImuRecord& imu) {
  return saturation_beyond(stated_rails(imu), imu);
}

std::vector<RecordingFinding> findings_in_readings(const sim::Sensors& sensors,
                                                   std::span<const std::vector<std::string>> cloud_fields) {
  std::vector<RecordingFinding> out;
  const auto add = [&](std::optional<RecordingFinding> finding) {
    if (finding) out.push_back(std::move(*finding));
  };
  add(late_start(sensors));
  for (const sim::ImuRecord& imu : sensors.imus) {
    add(lost_items(imu.name, "readings", imu.period_ns, imu.time_ns));
    add(moving_start(imu));
    add_saturation(imu, out);
  }
  for (std::size_t k = 0; k < sensors.lidars.size(); ++k) {
    const sim::LidarRecord& lidar = sensors.lidars[k];
    add(lost_items(lidar.name, "sweeps", lidar.sweep_period_ns, lidar.sweep_start_ns));
    if (lidar.point_times == sim::PointTimes::unknown)
      out.push_back(
          {lidar.name, "the points have no times, so sweeps cannot be deskewed",
           fmt::format(
               "set --time-field NAME to the field that contains the point times{}, or enable point times in the "
               "lidar's driver",
               k < cloud_fields.size() ? fmt::format(" (fields of the cloud: {})", fmt::join(cloud_fields[k], ", "))
                                       : "")});
  }
  return out;
}

std::vector<RecordingFinding> findings_in_estimate(const Estimate& estimate, const std::string& method,
                                                   std::size_t sweeps) {
  std::vector<RecordingFinding> out;
  if (!estimate.status.ok()) {
    out.push_back({method, "failed: " + estimate.status.message(), ""});
    return out;
  }
  const auto registered =
      std::ranges::count_if(estimate.sweeps, [](const auto& sweep) { return sweep.verdict != SweepVerdict::rejected; });
  const double share = sweeps > 0 ? static_cast<double>(registered) / static_cast<double>(sweeps) : 0.0;
  if (share < kRegisteredShareMin)
    out.push_back(
        {method,
         fmt::format("only {} of {} sweeps were registered to the map (share {}, minimum {})", registered, sweeps,
                     percent_text(share), percent_text(kRegisteredShareMin)),
         "check the options --T-body-lidar, --lever-arm, --gyro-unit and --accel-unit, and the other faults in this "
         "list"});
  for (const HealthFinding& finding : estimate.faults.findings) {
    const bool mounting = finding.kind == HealthFinding::Kind::lidar_calibration;
    out.push_back({method, report_text(finding),
                   mounting ? "set --T-body-lidar to the measured pose of the lidar on the body" : "",
                   is_current(finding)});
  }
  return out;
}

}  // namespace tumble::scenarios
