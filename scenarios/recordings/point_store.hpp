// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>

#include "scenarios/recordings/scratch_file.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// PointStore contains the points of one lidar on disk, one file per column; the sim::LidarRecord in memory then has no
/// points.
struct PointStore {
  PointStore() = default;
  explicit PointStore(const std::filesystem::path& folder)
      : position_L_m(folder), range_m(folder), intensity(folder), offset_ns(folder), ring(folder) {}

  std::size_t size() const { return position_L_m.size(); }
  void take(sim::LidarRecord& record);

  ColumnFile<Eigen::Vector3f> position_L_m;
  ColumnFile<float> range_m, intensity;
  ColumnFile<std::uint32_t> offset_ns;
  ColumnFile<std::uint16_t> ring;
};

/// Returns a lidar record with only the sweep `sweep`, whose points come from disk (`aside`), or from `lidar` if
/// `aside` is null.
sim::LidarRecord sweep_alone(const sim::LidarRecord& lidar, const PointStore* aside, std::size_t sweep);

}  // namespace tumble::scenarios
