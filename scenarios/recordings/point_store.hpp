// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>

#include "scenarios/recordings/scratch_file.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// The points of one lidar on the disk: the columns of a sim::LidarRecord, a file each. The record itself, which has
/// everything else, is then without points.
struct PointStore {
  PointStore() = default;
  explicit PointStore(const std::filesystem::path& folder)
      : position_L_m(folder), range_m(folder), intensity(folder), offset_ns(folder), ring(folder) {}

  std::size_t size() const { return position_L_m.size(); }
  /// Appends the points of `record`, which holds none afterwards. Throws BadInput as ScratchFile does.
  void take(sim::LidarRecord& record);

  ColumnFile<Eigen::Vector3f> position_L_m;
  ColumnFile<float> range_m, intensity;
  ColumnFile<std::uint32_t> offset_ns;
  ColumnFile<std::uint16_t> ring;
};

/// One sweep as a record of that sweep alone: its points are those of `lidar`, or in `aside` where that is given.
sim::LidarRecord sweep_alone(const sim::LidarRecord& lidar, const PointStore* aside, std::size_t sweep);

}  // namespace tumble::scenarios
