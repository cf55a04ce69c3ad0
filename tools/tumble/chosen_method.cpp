// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/chosen_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/external/external_method.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "tools/tumble/progress.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"

namespace tumble::tools {

using scenarios::BadInput;

std::string failure_reason(const Status& status, const sim::Sensors& sensors) {
  const std::string field = status.field;
  if (status.error_code == ErrorCode::empty && field == "imus")
    return "the method needs an IMU, but the recording contains no IMU";
  const std::string place = trouble_place(status, sensors);
  return status.message() + (place.empty() ? "" : ": " + place);
}

scenarios::MethodPointer chosen_method(const std::string& name, const scenarios::Subject& subject) {
  std::vector<scenarios::MethodPointer> fitting;
  std::string refused;
  for (const scenarios::MethodPointer& method : scenarios::find_methods(name)) {
    if (method->info.needs_truth) {
      refused = fmt::format("method '{}' needs the truth, which this command never reads; use 'tumble run' instead",
                            full_name(method->info));
    } else if (const std::string why = method->info.why_not(subject); !why.empty()) {
      refused = "method '" + full_name(method->info) + "': it " + why;
    } else {
      fitting.push_back(method);
    }
  }
  if (fitting.empty()) throw BadInput(refused);
  if (fitting.size() > 1) {
    std::string line = fmt::format("--method {} is the name of several methods; choose one of:", name);
    for (const scenarios::MethodPointer& method : fitting) line += " " + full_name(method->info);
    throw BadInput(line);
  }
  return fitting.front();
}

scenarios::Estimate run_method(const Session& session, const scenarios::Method& method, const sim::Sensors& sensors) {
  using Clock = std::chrono::steady_clock;
  ProgressDisplay display = ProgressDisplay::on_standard_error();
  Clock::time_point pass = Clock::now();
  RegistrationProgress progress;
  scenarios::OracleInput input;
  if (!session.quiet && display.is_on_terminal())
    input.on_sweep = [&](std::size_t done, std::size_t all) {
      if (done <= progress.done) pass = Clock::now();
      progress = {done, all, std::chrono::duration<double>(Clock::now() - pass).count()};
      display.show(progress);
    };
  try {
    scenarios::Estimate estimate = method.run(sensors, {}, input);
    if (progress.all > 0) display.finish(progress);
    return estimate;
  } catch (const scenarios::NoAnswer& error) {
    throw BadInput(full_name(method.info) + ": " + error.what());
  }
}

namespace {

double recording_time_s(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

std::string place_of_gap(const sim::Sensors& sensors) {
  std::int64_t longest_ns = 0;
  std::string place;
  for (const sim::ImuRecord& imu : sensors.imus) {
    for (std::size_t k = 1; k < imu.time_ns.size(); ++k) {
      const std::int64_t from_ns = imu.time_ns[k - 1], to_ns = imu.time_ns[k];
      if (to_ns - from_ns <= longest_ns) continue;
      longest_ns = to_ns - from_ns;
      place = fmt::format("{} has no readings between {:.3f} and {:.3f} s", imu.name, recording_time_s(from_ns),
                          recording_time_s(to_ns));
    }
  }
  return place;
}

bool has_trouble(ErrorCode error_code, const sim::ImuRecord& imu, std::size_t k) {
  if (error_code == ErrorCode::time_order) return k > 0 && imu.time_ns[k] <= imu.time_ns[k - 1];
  ImuSample sample;
  sample.angular_velocity_rad_s = imu.gyro_rad_s[k];
  sample.specific_force_m_s2 = imu.accel_m_s2[k];
  return check_sample(sample).error_code == error_code ||
         scenarios::bridge::check_range(imu, sample.angular_velocity_rad_s, sample.specific_force_m_s2).error_code ==
             error_code;
}

std::string place_of_reading(ErrorCode error_code, const sim::Sensors& sensors) {
  for (const sim::ImuRecord& imu : sensors.imus) {
    for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
      if (has_trouble(error_code, imu, k))
        return fmt::format("the affected reading is number {} of {}, at {:.3f} s", k, imu.name,
                           recording_time_s(imu.time_ns[k]));
    }
  }
  return "";
}

std::string size_of_sweeps(const sim::Sensors& sensors) {
  std::vector<std::size_t> sizes;
  for (std::size_t k = 0; !sensors.lidars.empty() && k < sensors.lidars.front().sweep_start_ns.size(); ++k)
    sizes.push_back(sensors.lidars.front().sweep_first[k + 1] - sensors.lidars.front().sweep_first[k]);
  if (sizes.empty()) return "";
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return fmt::format("the sweeps of {} have {} points (median); a map needs sweeps with at least {} points",
                     sensors.lidars.front().name, *middle, MatchingParams::kMatchesMin);
}

}  // namespace

std::string trouble_place(const Status& status, const sim::Sensors& sensors) {
  if (status.error_code == ErrorCode::gap) return place_of_gap(sensors);
  const std::string field = status.field;
  if (field == "lidar.sweeps_registered") return size_of_sweeps(sensors);
  const bool of_reading = field.starts_with("angular_velocity_rad_s") || field.starts_with("specific_force_m_s2") ||
                          (status.error_code == ErrorCode::time_order && field == "time_ns");
  return of_reading ? place_of_reading(status.error_code, sensors) : "";
}

}  // namespace tumble::tools
