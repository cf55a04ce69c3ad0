// SPDX-License-Identifier: BSD-3-Clause
// The saturation limits of two real gyros are the reference for the simulated saturation. The program
// tests/bench/rail_measures fits planes to the saturated readings of the data set RepoIMU (Szczesna et al., ICCVG
// 2016).
//
// For the gyro's x axis of the hand-held wand (limit 7.3 rad/s), the saturation plane is fitted to the RepoIMU
// recordings Test05 and Test10, trials 1 to 3.
//
// For the gyro's y axis of the hand-held wand (limit 7.2 rad/s), the saturation plane is fitted to the RepoIMU
// recording Test06, trial 1. The simulated saturation plane must agree with the fitted plane of the wand's y axis
// within three standard errors of the fit.
//
// For the gyro's z axis of the pendulum (limit 10.29 rad/s), the saturation plane is fitted to the RepoIMU recordings
// Test02a and Test07, trial 3.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scenarios/certificate/clipped_plane.hpp"
#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/standard_gravity.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

struct MeasuredRange {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
  double farthest() const { return std::max(std::abs(low), std::abs(high)); }
};

struct MeasuredPlane {
  const char* name;
  int element;
  MeasuredRange first_slope, second_slope;  // cross-axis sensitivity to the next axes, cyclically [1]
  MeasuredRange distance_rad_s, offset_rad_s;
};

constexpr std::array kMeasured = {
    MeasuredPlane{"wand x", 0, {-0.007, 0.006}, {-0.0209, -0.0172}, {7.2987, 7.3047}, {-0.058, -0.043}},
    MeasuredPlane{"wand y", 1, {0.0145, 0.0175}, {-0.0005, 0.005}, {7.2495, 7.2530}, {0.136, 0.1405}},
    MeasuredPlane{"pendulum z", 2, {0.050, 0.052}, {-0.004, -0.002}, {10.291, 10.294}, {-0.0004, 0.0008}}};

const char* axis_name(int axis) {
  constexpr std::array kNames = {"x", "y", "z"};
  return kNames[static_cast<std::size_t>(axis % 3)];
}

sim::Elements elements_of(const MeasuredPlane& plane, const RealRailsSetup& setup) {
  const int j = plane.element;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  axes(j, (j + 1) % 3) = -(setup.tilt_factor * plane.first_slope.middle() + setup.added_tilt);
  axes(j, (j + 2) % 3) = -(setup.tilt_factor * plane.second_slope.middle() + setup.added_tilt);
  offset[j] = -(plane.offset_rad_s.middle() + setup.added_offset_rad_s);
  return {axes, offset};
}

void show_plane(const DataSheet& sheet, const MeasuredPlane& plane, const RealRailsSetup& setup,
                std::vector<CertificateEntry>& entries) {
  sim::SensorSpec sensor = imu_of_sheet(sheet);
  const double rail = setup.rail_factor * plane.distance_rad_s.middle();
  sensor.values.set("gyro_rail_rad_s", rail);
  sensor.values.set("gyro_range_rad_s", rail);
  sensor.values.set("output_rate_hz", 500.0);
  sim::ImuRecord record;
  sim::ImuTruth truth;
  sim::simulate_imu(beyond_every_rail(rail, sensor.values.at("accel_rail_m_s2")), sensor, Eigen::Isometry3d::Identity(),
                    kStandardGravity_m_s2, 1, record, truth, {elements_of(plane, setup), std::nullopt});
  int samples = 0;
  const ClippedPlane fitted = fit_clipped_plane(sensed_rates(record, truth, rail), plane.element, samples);
  const std::string name = plane.name, note = samples < kFewestClipped ? "too few clipped samples" : "";
  const auto add = [&](const char* row, const std::string& subject, const char* law, const char* unit, double value,
                       const MeasuredRange& measured) {
    entries.push_back({row, subject, law, unit, value, measured.low, measured.high, note});
  };
  const char* slope =
      "the saturation limit of a simulated gyro depends on the output of another axis with the same slope as the limit "
      "of a real gyro";
  add("real_rail_slope", name + ", " + axis_name(plane.element + 1), slope, "1", fitted.first_slope, plane.first_slope);
  add("real_rail_slope", name + ", " + axis_name(plane.element + 2), slope, "1", fitted.second_slope,
      plane.second_slope);
  add("real_rail_distance", name,
      "the saturation limit of a simulated gyro has the same distance from zero as the limit of a real gyro", "rad/s",
      fitted.distance, plane.distance_rad_s);
  add("real_rail_offset", name,
      "the midpoint between upper and lower saturation limit of a simulated gyro equals the midpoint of a real gyro",
      "rad/s", fitted.offset, plane.offset_rad_s);
}

struct DrawnPlanes {
  double slope = 0.0, offset_rad_s = 0.0;
};

DrawnPlanes drawn_planes(const DataSheet& sheet, const RealRailsSetup& setup) {
  sim::SensorSpec sensor = imu_of_sheet(sheet);
  for (const char* name : {"gyro_element_misalignment", "gyro_element_scale", "gyro_element_offset_rad_s"})
    sensor.values.set(name, setup.spread_factor * sensor.values.at(name));
  constexpr double kBrief_s = 0.05, kChain_hz = 2000.0;
  double slopes = 0.0, offsets = 0.0;
  for (int seed = 1; seed <= setup.devices; ++seed) {
    sim::ImuRecord record;
    sim::ImuTruth truth;
    sim::simulate_imu_at_rest(sensor, kBrief_s, kChain_hz, kStandardGravity_m_s2, static_cast<std::uint64_t>(seed),
                              record, truth);
    const SensedTriad rates = sensed_rates(record, truth, 1.0);
    for (int j = 0; j < 3; ++j) {
      const ClippedPlane plane = plane_of(rates.axes, rates.offset, rates.rail, j);
      slopes += plane.first_slope * plane.first_slope + plane.second_slope * plane.second_slope;
      offsets += plane.offset * plane.offset;
    }
  }
  return {std::sqrt(slopes / (6.0 * setup.devices)), std::sqrt(offsets / (3.0 * setup.devices))};
}

}  // namespace

std::vector<CertificateEntry> certify_real_rails(const CertificateInput& input, const RealRailsSetup& setup) {
  std::vector<CertificateEntry> entries;
  const DataSheet shown_by = load_data_sheet(input.data, "mti30");
  double slope = 0.0, offset_rad_s = 0.0;
  for (const MeasuredPlane& plane : kMeasured) {
    show_plane(shown_by, plane, setup, entries);
    slope = std::max({slope, plane.first_slope.farthest(), plane.second_slope.farthest()});
    offset_rad_s = std::max(offset_rad_s, plane.offset_rad_s.farthest());
  }
  constexpr double kCut = 3.0;  // truncation of sim::Elements
  for (const std::string& name : device_names(input.data)) {
    const DataSheet sheet = load_data_sheet(input.data, name);
    if (sheet.sensor_kind != "imu") continue;
    const DrawnPlanes drawn = drawn_planes(sheet, setup);
    entries.push_back(
        {"real_rail_slope_drawn", name + " gyro",
         "ratio of the largest slope of a real gyro's saturation limits to the standard deviation of simulated slopes",
         "1", slope / drawn.slope, 0.0, kCut, ""});
    entries.push_back({"real_rail_offset_drawn", name + " gyro",
                       "ratio of the largest midpoint of a real gyro's two saturation limits to the standard deviation "
                       "of simulated midpoints",
                       "1", offset_rad_s / drawn.offset_rad_s, 0.0, kCut, ""});
  }
  return entries;
}

}  // namespace tumble::scenarios
