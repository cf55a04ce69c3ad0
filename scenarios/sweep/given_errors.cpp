// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/given_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "sim/random/stream.hpp"

namespace tumble::scenarios {

namespace {

Eigen::Vector3d direction(sim::Stream& stream) {
  const double z = stream.normal(), y = stream.normal(), x = stream.normal();
  return Eigen::Vector3d(x, y, z).normalized();
}

Eigen::Vector3d direction(const sim::Situation& situation, const char* name) {
  sim::Stream stream(situation.seed, std::string("given.") + name);
  return direction(stream);
}

sim::ImuRecord& primary(sim::Sensors& sensors, const sim::Truth& truth) {
  if (sensors.imus.empty() || truth.imus.empty())
    throw BadInput("the recording has no IMU, so this error cannot be applied");
  return sensors.imus.front();
}

/// An error of the calibrated centre of mass changes the lever arm of every sensor.
void lever_arm(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const Eigen::Vector3d given_m = primary(sensors, truth).T_BI.translation();
  const Eigen::Vector3d shift_m =
      truth.imus.front().T_BI.translation() + size * direction(situation, "lever_arm") - given_m;
  for (sim::ImuRecord& imu : sensors.imus) imu.T_BI.translation() += shift_m;
  for (sim::LidarRecord& lidar : sensors.lidars) lidar.T_BL.translation() += shift_m;
  for (sim::SeriesRecord& series : sensors.series) series.T_BX.translation() += shift_m;
}

void extrinsic_rotation(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const Eigen::Matrix3d R_BI_given = primary(sensors, truth).T_BI.linear();
  if (sensors.lidars.empty() || truth.lidars.empty())
    throw BadInput("the recording has no lidar, so this error cannot be applied");
  const Eigen::Matrix3d R_IL_true = truth.imus.front().T_BI.linear().transpose() * truth.lidars.front().T_BL.linear();
  const Eigen::AngleAxisd error(size, direction(situation, "extrinsic_rotation"));
  sensors.lidars.front().T_BL.linear() = R_BI_given * R_IL_true * error.toRotationMatrix();
}

void time_offset(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const double own_s = situation.sensors.front().values.at("time_offset_s");
  const auto shift_ns = static_cast<std::int64_t>(std::llround((size - own_s) * 1e9));
  for (std::int64_t& time_ns : primary(sensors, truth).time_ns) time_ns += shift_ns;
}

void radius(sim::Sensors& sensors, const sim::Truth&, const sim::Situation&, double size) {
  if (!(sensors.sphere_radius_m > 0.0))
    throw BadInput("the recording states no sphere radius, but this error needs a recording of a sphere");
  if (!(sensors.sphere_radius_m + size > 0.0))
    throw BadInput("radius_error_m makes the radius zero or negative; choose a smaller error");
  sensors.sphere_radius_m += size;
}

/// The stated range of the IMU exceeds every reading, so no reading counts as clipped.
void state_no_rail(sim::ImuRecord& imu) {
  double largest = 0.0;
  for (const Eigen::Vector3d& reading : imu.gyro_rad_s) largest = std::max(largest, reading.lpNorm<Eigen::Infinity>());
  imu.stated_gyro_range_rad_s = std::max(imu.stated_gyro_range_rad_s, 1.1 * largest);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kGyroClipFlags);
}

/// Simulates a rate method with a constant error: replaces each clipped reading by the unclipped reading plus an error,
/// which is constant in each clipping interval.
void rate_error(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  const ClippingTruth clipping(sensors, truth);
  sim::ImuRecord& imu = primary(sensors, truth);
  sim::Stream stream(situation.seed, "given.rate_error");
  std::vector<std::uint8_t> axes(clipping.size());
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = clipping.clipped_axes(i);
  Eigen::Vector3d error_rad_s = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i] == 0) continue;
    if (i == 0 || axes[i - 1] == 0) error_rad_s = size * direction(stream);
    imu.gyro_rad_s[i] = truth.imus.front().gyro_unclipped_rad_s[i] + error_rad_s;
  }
  state_no_rail(imu);
}

void stated_rail(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation, double size) {
  sim::ImuRecord& imu = primary(sensors, truth);
  imu.stated_gyro_range_rad_s = situation.sensors.front().values.at("gyro_rail_rad_s") * (1.0 + size);
  for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kGyroClipFlags);
}

void report_rail(std::span<const sim::Parameter> known, double size, sim::Values& given) {
  for (const sim::Parameter& parameter : known) {
    if (parameter.name != "saturation_point_rad_s") continue;
    given.set(std::string(parameter.name), parameter.default_value * (1.0 + size));
  }
}

}  // namespace

std::span<const GivenError> given_errors() {
  static const std::array kErrors = {
      GivenError{{"lever_arm_error_m", 0.0, 0.0, 1.0, "m",
                  "error of the stated lever arm, in a random direction for each simulated run; 0: exact lever arm"},
                 false,
                 lever_arm},
      GivenError{{"extrinsic_rotation_rad", 0.0, 0.0, 3.14, "rad",
                  "error of the stated rotation between IMU and lidar, about a random axis for each simulated run"},
                 true,
                 extrinsic_rotation},
      GivenError{{"time_offset_s", 0.0, -1.0, 1.0, "s", "delay added to the time stamps of the primary IMU"},
                 false,
                 time_offset},
      GivenError{{"radius_error_m", 0.0, -1.0, 1.0, "m",
                  "error of the stated radius of the sphere; positive: the stated radius is too large"},
                 false,
                 radius},
      GivenError{{"rate_error_rad_s", 0.0, 0.0, 1000.0, "rad/s",
                  "clipped readings are replaced by unclipped readings with an error of this magnitude, which is "
                  "constant over each clipped segment; methods receive these readings as valid"},
                 false,
                 rate_error},
      GivenError{{"stated_rail_error", 0.0, -0.9, 9.0, "1",
                  "error of the stated gyro range, as a share of the true saturation limit; methods do not receive the "
                  "device's clip flags"},
                 false,
                 stated_rail,
                 report_rail},
  };
  return kErrors;
}

const GivenError* find_given_error(const std::string& name) {
  const auto all = given_errors();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const GivenError& e) { return e.parameter.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace tumble::scenarios
