// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/dialects/dialect.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kIntensityScale = 255.0;

SweepLayout layout_with(const PointColumn& times) {
  using enum PointQuantity;
  using enum NumberType;
  return {{{"x", x_m, float32},
           {"y", y_m, float32},
           {"z", z_m, float32},
           {"intensity", intensity, float32, kIntensityScale},
           {"ring", ring, uint16},
           times},
          false,
          true};
}

}  // namespace

SweepLayout velodyne_layout(const SensorFacts&) {
  return layout_with({"time", PointQuantity::time, NumberType::float32, 1e-9});
}

SweepLayout ouster_layout(const SensorFacts&) {
  return layout_with({"t", PointQuantity::time, NumberType::uint32});
}

ReaderNames fast_lio_names(const SensorFacts& facts) {
  if (facts.lidar->livox) return {"/livox/imu", "imu", "/livox/lidar", "lidar", "base_link", ""};
  return {"/imu/data", "imu", "/velodyne_points", "lidar", "base_link", ""};
}

SweepLayout fast_lio_layout(const SensorFacts& facts) {
  return facts.lidar->livox ? livox_sweep_layout() : velodyne_layout(facts);
}

std::span<const Dialect> all_dialects() {
  static const std::vector<Dialect> all = {
      dlio_dialect(),    fast_lio_dialect(), glim_dialect(),      kiss_icp_dialect(),
      lio_sam_dialect(), norlab_dialect(),   point_lio_dialect(), rko_lio_dialect(),
  };
  return all;
}

}  // namespace tumble::scenarios
