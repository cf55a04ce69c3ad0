// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scenarios/certificate/clipped_plane.hpp"
#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/standard_gravity.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

sim::SensorSpec tilted(const DataSheet& sheet, const TiltedRailSetup& setup) {
  sim::SensorSpec sensor = imu_of_sheet(sheet);
  const double gyro_rail = sensor.values.at("gyro_rail_rad_s"), accel_rail = sensor.values.at("accel_rail_m_s2");
  sensor.values.set("output_rate_hz", 500.0);
  sensor.values.set("gyro_element_misalignment", setup.misalignment);
  sensor.values.set("accel_element_misalignment", setup.misalignment);
  sensor.values.set("gyro_element_scale", setup.misalignment / 2.0);
  sensor.values.set("accel_element_scale", setup.misalignment / 2.0);
  sensor.values.set("gyro_element_offset_rad_s", 0.005 * gyro_rail);
  sensor.values.set("accel_element_offset_m_s2", 0.005 * accel_rail);
  return sensor;
}

struct PlaneErrors {
  double slope = 0.0, distance_share = 0.0;
  int samples = 0;
};

void compare_planes(const SensedTriad& triad, int j, double assumed_tilt, PlaneErrors& errors) {
  int samples = 0;
  const ClippedPlane fitted = fit_clipped_plane(triad, j, samples);
  errors.samples = std::min(errors.samples, samples);
  if (samples < kFewestClipped) return;
  Eigen::Matrix3d assumed = triad.axes;
  assumed(j, (j + 1) % 3) += assumed_tilt;
  const ClippedPlane drawn = plane_of(assumed, triad.offset, triad.rail, j);
  for (const double off : {fitted.first_slope - drawn.first_slope, fitted.second_slope - drawn.second_slope})
    errors.slope = larger(errors.slope, std::abs(off));
  for (const double off : {fitted.distance - drawn.distance, fitted.offset - drawn.offset})
    errors.distance_share = larger(errors.distance_share, std::abs(off) / triad.rail);
}

}  // namespace

std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup) {
  const sim::SensorSpec sensor = tilted(load_data_sheet(input.data, "mti30"), setup);
  const double gyro_rail = sensor.values.at("gyro_rail_rad_s"), accel_rail = sensor.values.at("accel_rail_m_s2");
  const sim::Truth motion = beyond_every_rail(gyro_rail, accel_rail);
  constexpr int kMany = 1 << 30;
  PlaneErrors gyro{0.0, 0.0, kMany}, accel{0.0, 0.0, kMany};
  for (int device = 1; device <= setup.devices; ++device) {
    sim::ImuRecord record;
    sim::ImuTruth truth;
    sim::simulate_imu(motion, sensor, Eigen::Isometry3d::Identity(), kStandardGravity_m_s2,
                      static_cast<std::uint64_t>(device), record, truth);
    const SensedTriad rates = sensed_rates(record, truth, gyro_rail);
    const SensedTriad forces = sensed_forces(record, truth, accel_rail);
    for (int j = 0; j < 3; ++j) {
      compare_planes(rates, j, setup.assumed_tilt, gyro);
      compare_planes(forces, j, setup.assumed_tilt, accel);
    }
  }
  std::vector<CertificateEntry> entries;
  for (const auto& [subject, errors] : {std::pair{"mti30 gyro", gyro}, std::pair{"mti30 accel", accel}}) {
    const bool enough = errors.samples >= kFewestClipped && errors.samples < kMany;
    const std::string note = enough ? ""
                                    : "too few samples: at least 10 positive and 10 negative readings must be "
                                      "saturated by this sensing element alone";
    const double none = std::nan("");
    entries.push_back({"tilted_rail_slope", subject,
                       "the plane through the saturated readings of a sensing element is the simulated saturation "
                       "limit; the value is the maximum error of the plane's slopes",
                       "1", enough ? errors.slope : none, 0.0, 1e-9, note});
    entries.push_back({"tilted_rail_distance", subject,
                       "the plane through the saturated readings of a sensing element is the simulated saturation "
                       "limit; the value is the maximum relative error of the plane's distance and offset",
                       "1", enough ? errors.distance_share : none, 0.0, 1e-9, note});
  }
  return entries;
}

}  // namespace tumble::scenarios
