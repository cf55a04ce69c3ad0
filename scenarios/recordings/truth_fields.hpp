// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/recordings/hdf5_file.hpp"
#include "scenarios/recordings/recording_fields.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

namespace hdf5 {
template <>
struct RowLayout<sim::ContactLabel> : Layout<Scalar::uint8, 1> {};
}  // namespace hdf5

struct ContactColumns {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> point_W_m, normal_W, slip_velocity_W_m_s;
  std::vector<double> normal_force_n;
  std::vector<std::int32_t> surface_id;
};

template <class Archive, class Contacts>
void contact_fields(Archive& archive, Contacts& contacts) {
  archive.rows("time_ns", contacts.time_ns, "ns", "", Storage::deflated);
  archive.rows("point_W_m", contacts.point_W_m, "m", kXyz, Storage::deflated);
  archive.rows("normal_W", contacts.normal_W, "1", kXyz, Storage::deflated);
  archive.rows("slip_velocity_W_m_s", contacts.slip_velocity_W_m_s, "m/s", kXyz, Storage::deflated);
  archive.rows("normal_force_n", contacts.normal_force_n, "N", "", Storage::deflated);
  archive.rows("surface_id", contacts.surface_id, "1", "", Storage::deflated);
}

template <class Archive, class Imu>
void imu_truth_fields(Archive& archive, Imu& imu) {
  archive.value("name", imu.name);
  archive.pose("T_BI", imu.T_BI);
  archive.rows("rate_I_rad_s", imu.rate_rad_s, "rad/s", kXyz, Storage::deflated);
  archive.rows("specific_force_I_m_s2", imu.specific_force_m_s2, "m/s^2", kXyz, Storage::deflated);
  archive.rows("gyro_unclipped_I_rad_s", imu.gyro_unclipped_rad_s, "rad/s", kXyz, Storage::deflated);
  archive.rows("accel_unclipped_I_m_s2", imu.accel_unclipped_m_s2, "m/s^2", kXyz, Storage::deflated);
  archive.rows("gyro_bias_I_rad_s", imu.gyro_bias_rad_s, "rad/s", kXyz, Storage::deflated);
  archive.rows("accel_bias_I_m_s2", imu.accel_bias_m_s2, "m/s^2", kXyz, Storage::deflated);
  archive.optional_rows("gyro_elements_I", imu.gyro_elements, "1", kXyz, Storage::plain);
  archive.optional_point("gyro_element_offset_rad_s", imu.gyro_element_offset_rad_s, "rad/s");
  archive.optional_rows("accel_elements_I", imu.accel_elements, "1", kXyz, Storage::plain);
  archive.optional_point("accel_element_offset_m_s2", imu.accel_element_offset_m_s2, "m/s^2");
  archive.optional_rows("magnetic_field_I_t", imu.magnetic_field_t, "T", kXyz, Storage::deflated);
}

template <class Archive, class Lidar>
void lidar_truth_fields(Archive& archive, Lidar& lidar) {
  archive.value("name", lidar.name);
  archive.pose("T_BL", lidar.T_BL);
  archive.rows("hit_W_m", lidar.hit_W_m, "m", kXyz, Storage::plain);
  archive.rows("surface_id", lidar.surface_id, "1", "", Storage::deflated);
}

template <class Archive, class Series>
void series_truth_fields(Archive& archive, Series& series) {
  archive.value("name", series.name);
  archive.pose("T_BX", series.T_BX);
  archive.list("quantities", series.quantities, [](auto& inner, auto& quantity) {
    inner.value("name", quantity.name);
    inner.value("unit", quantity.unit);
    inner.rows("values", quantity.values, quantity.unit.c_str(), "", Storage::deflated);
  });
}

template <class Archive, class Truth, class Contacts>
void truth_fields(Archive& archive, Truth& truth, Contacts& contacts) {
  archive.value("period_ns", truth.period_ns);
  archive.rows("p_WB_m", truth.p_WB_m, "m", kXyz, Storage::deflated);
  archive.rows("q_WB", truth.q_WB, "1", "x y z w", Storage::deflated);
  archive.rows("v_WB_m_s", truth.v_WB_m_s, "m/s", kXyz, Storage::deflated);
  archive.rows("w_WB_B_rad_s", truth.w_WB_B_rad_s, "rad/s", kXyz, Storage::deflated);
  archive.rows("f_B_m_s2", truth.f_B_m_s2, "m/s^2", kXyz, Storage::deflated);
  archive.rows("label", truth.label, "1", "", Storage::deflated);
  archive.point("p_BG_m", truth.p_BG_m, "m");
  archive.texts("surfaces", truth.surfaces);
  archive.group("contacts", contacts, [](auto& inner, auto& each) { contact_fields(inner, each); });
  archive.list("imus", truth.imus, [](auto& inner, auto& imu) { imu_truth_fields(inner, imu); });
  archive.list("lidars", truth.lidars, [](auto& inner, auto& lidar) { lidar_truth_fields(inner, lidar); });
  archive.optional_list("series", truth.series, [](auto& inner, auto& series) { series_truth_fields(inner, series); });
}

ContactColumns to_columns(const std::vector<sim::ContactTruth>& contacts);

}  // namespace tumble::scenarios
