// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenarios/recordings/hdf5_file.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

/// File writer, file reader and digest all visit one list of the fields of a recording, so that no function can omit a
/// field.
///
/// A later version of the file format may add a field. An added field with its default value is neither stored nor
/// hashed, so older files keep their digests. The default value of an added field is empty or zero; the default value
/// of the point times is "measured".
namespace tumble::scenarios {

/// Data are stored as `plain` (without compression) if deflate would save little space (FORMAT.md).
enum class Storage { plain, deflated };

struct StoredLidar {
  sim::LidarRecord sweeps;
  PointStore points;
};
struct StoredLidarView {
  const sim::LidarRecord& sweeps;
  const PointStore& points;
};
inline constexpr const char* kXyz = "x y z";

inline constexpr std::array<const char*, 3> kPointTimes = {"measured", "not_skewed", "unknown"};

template <class Archive, class Imu>
void imu_fields(Archive& archive, Imu& imu) {
  archive.value("name", imu.name);
  archive.value("device", imu.device);
  archive.value("period_ns", imu.period_ns);
  archive.value("stated_gyro_range_rad_s", imu.stated_gyro_range_rad_s);
  archive.value("stated_accel_range_m_s2", imu.stated_accel_range_m_s2);
  archive.value("gyro_noise_rad_s_sqrt_hz", imu.gyro_noise_rad_s_sqrt_hz);
  archive.value("accel_noise_m_s2_sqrt_hz", imu.accel_noise_m_s2_sqrt_hz);
  archive.pose("T_BI", imu.T_BI);
  archive.rows("time_ns", imu.time_ns, "ns", "", Storage::deflated);
  archive.rows("gyro_I_rad_s", imu.gyro_rad_s, "rad/s", kXyz, Storage::deflated);
  archive.rows("accel_I_m_s2", imu.accel_m_s2, "m/s^2", kXyz, Storage::deflated);
  archive.rows("clip_flags", imu.clip_flags, "1", "", Storage::deflated);
  archive.optional_rows("magnetic_field_I_t", imu.magnetic_field_t, "T", kXyz, Storage::deflated);
  archive.optional_point("earth_field_W_t", imu.earth_field_W_t, "T");
}

template <class Archive, class Lidar>
void sweep_fields(Archive& archive, Lidar& lidar) {
  archive.value("name", lidar.name);
  archive.value("device", lidar.device);
  archive.value("sweep_period_ns", lidar.sweep_period_ns);
  archive.point_times("point_times", lidar.point_times);
  archive.pose("T_BL", lidar.T_BL);
  archive.rows("sweep_start_ns", lidar.sweep_start_ns, "ns", "", Storage::deflated);
  archive.rows("sweep_first", lidar.sweep_first, "1", "", Storage::deflated);
}

template <class Archive, class Points>
void point_fields(Archive& archive, Points& points) {
  archive.rows("position_L_m", points.position_L_m, "m", kXyz, Storage::plain);
  archive.rows("range_m", points.range_m, "m", "", Storage::plain);
  archive.rows("intensity", points.intensity, "1", "", Storage::plain);
  archive.rows("offset_ns", points.offset_ns, "ns", "", Storage::deflated);
  archive.rows("ring", points.ring, "1", "", Storage::deflated);
}

template <class Archive, class Lidar>
void lidar_fields(Archive& archive, Lidar& lidar) {
  if constexpr (requires { lidar.sweeps; }) {
    sweep_fields(archive, lidar.sweeps);
    point_fields(archive, lidar.points);
  } else {
    sweep_fields(archive, lidar);
    point_fields(archive, lidar);
  }
}

template <class Archive, class Series>
void series_fields(Archive& archive, Series& series) {
  archive.value("name", series.name);
  archive.value("kind", series.kind);
  archive.value("device", series.device);
  archive.value("period_ns", series.period_ns);
  archive.pose("T_BX", series.T_BX);
  archive.rows("time_ns", series.time_ns, "ns", "", Storage::deflated);
  archive.list("quantities", series.quantities, [](auto& inner, auto& quantity) {
    inner.value("name", quantity.name);
    inner.value("unit", quantity.unit);
    inner.value("noise", quantity.noise);
    inner.rows("values", quantity.values, quantity.unit.c_str(), "", Storage::deflated);
  });
  archive.optional_list("constants", series.constants, [](auto& inner, auto& constant) {
    inner.value("name", constant.name);
    inner.value("value", constant.value);
  });
}

template <class Archive, class Sensors, class Lidars>
void sensors_fields(Archive& archive, Sensors& sensors, Lidars& lidars) {
  archive.value("robot", sensors.robot);
  archive.value("sphere_radius_m", sensors.sphere_radius_m);
  archive.value("gravity_m_s2", sensors.gravity_m_s2);
  archive.list("imus", sensors.imus, [](auto& inner, auto& imu) { imu_fields(inner, imu); });
  archive.list("lidars", lidars, [](auto& inner, auto& lidar) { lidar_fields(inner, lidar); });
  archive.optional_list("series", sensors.series, [](auto& inner, auto& series) { series_fields(inner, series); });
}

template <class Archive, class Sensors>
void sensors_fields(Archive& archive, Sensors& sensors) {
  sensors_fields(archive, sensors, sensors.lidars);
}

/// Visits the points of the lidars, which are in `points` (temporary files) or, if `points` is empty, in `sensors`
/// (memory).
template <class Archive>
void stored_fields(Archive& archive, const sim::Sensors& sensors, const std::vector<PointStore>& points) {
  if (points.empty()) return sensors_fields(archive, sensors);
  std::vector<StoredLidarView> lidars;
  for (std::size_t i = 0; i < sensors.lidars.size(); ++i) lidars.push_back({sensors.lidars[i], points.at(i)});
  sensors_fields(archive, sensors, lidars);
}

}  // namespace tumble::scenarios
