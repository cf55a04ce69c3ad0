// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/recordings/scratch_file.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct StoredContacts {
  ColumnFile<std::int64_t> time_ns;
  ColumnFile<Eigen::Vector3d> point_W_m, normal_W, slip_velocity_W_m_s;
  ColumnFile<double> normal_force_n;
  ColumnFile<std::int32_t> surface_id;
};

struct StoredImuTruth {
  std::string name;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  ColumnFile<Eigen::Vector3d> rate_rad_s, specific_force_m_s2;
  ColumnFile<Eigen::Vector3d> gyro_unclipped_rad_s, accel_unclipped_m_s2;
  ColumnFile<Eigen::Vector3d> gyro_bias_rad_s, accel_bias_m_s2;
  std::vector<Eigen::Vector3d> gyro_elements, accel_elements;
  Eigen::Vector3d gyro_element_offset_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_element_offset_m_s2 = Eigen::Vector3d::Zero();
  ColumnFile<Eigen::Vector3d> magnetic_field_t;
};

struct StoredLidarTruth {
  std::string name;
  Eigen::Isometry3d T_BL = Eigen::Isometry3d::Identity();
  ColumnFile<Eigen::Vector3f> hit_W_m;
  ColumnFile<std::int32_t> surface_id;
};

struct StoredTruth {
  sim::Truth states(std::size_t first, std::size_t last) const;
  std::size_t size() const { return p_WB_m.size(); }

  std::int64_t period_ns = 500000;
  ColumnFile<Eigen::Vector3d> p_WB_m;
  ColumnFile<Eigen::Quaterniond> q_WB;
  ColumnFile<Eigen::Vector3d> v_WB_m_s, w_WB_B_rad_s, f_B_m_s2;
  ColumnFile<sim::ContactLabel> label;
  StoredContacts contacts;
  Eigen::Vector3d p_BG_m = Eigen::Vector3d::Zero();
  std::vector<std::string> surfaces;
  std::vector<StoredImuTruth> imus;
  std::vector<StoredLidarTruth> lidars;
  std::vector<sim::SeriesTruth> series;  ///< few numbers per second
};

/// PointStore contains the points of one lidar on disk, one file per column. The sim::LidarRecord of a lidar with a
/// PointStore contains no points.
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

/// Returns a lidar record that contains only the sweep number `sweep`. The points come from disk (`aside`), or from
/// `lidar` if `aside` is null.
sim::LidarRecord sweep_alone(const sim::LidarRecord& lidar, const PointStore* aside, std::size_t sweep);

}  // namespace tumble::scenarios
