// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensor_type.hpp"

#include <array>

#include "sim/imu/imu_simulation.hpp"
#include "sim/lidar/lidar_parameters.hpp"
#include "sim/lidar/lidar_simulation.hpp"
#include "sim/registry.hpp"
#include "sim/series/series_sensors.hpp"

namespace tumble::sim {

namespace {

void add_imu(const SensorContext& context, Recording& recording) {
  ImuRecord& record = recording.sensors.imus.emplace_back();
  ImuTruth truth;
  simulate_imu(recording.truth, context.sensor, context.T_BX, context.gravity_m_s2, context.seed, record, truth);
  record.T_BI = context.given_T_BX;
  recording.truth.imus.push_back(std::move(truth));
}

void add_lidar(const SensorContext& context, Recording& recording) {
  LidarRecord& record = recording.sensors.lidars.emplace_back();
  LidarTruth truth;
  const MotionTrack motion{recording.truth.period_ns, recording.truth.p_WB_m, recording.truth.q_WB};
  simulate_lidar(context.world, context.sensor, context.T_BX, motion, context.seed, context.threads, record, truth);
  record.T_BL = context.given_T_BX;
  recording.truth.lidars.push_back(std::move(truth));
}

const SensorType& imu_sensor() {
  static const SensorType kType{
      {"imu", "IMU with gyro, accelerometer and optional magnetometer", imu_parameters()}, add_imu, check_imu_values};
  return kType;
}

const SensorType& spinning_lidar_sensor() {
  static const SensorType kType{
      {"spinning_lidar", "lidar with a column of lasers that rotates about an axis", spinning_lidar_parameters()},
      add_lidar};
  return kType;
}

const SensorType& column_lidar_sensor() {
  static const SensorType kType{
      {"column_lidar", "column of up to 128 evenly spaced rings that rotates about an axis", column_lidar_parameters()},
      add_lidar};
  return kType;
}

const SensorType& rosette_lidar_sensor() {
  static const SensorType kType{
      {"rosette_lidar", "lidar with a rosette pattern and one or several scanning units side by side",
       rosette_lidar_parameters()},
      add_lidar};
  return kType;
}

}  // namespace

std::span<const SensorType* const> all_sensor_types() {
  static const std::array<const SensorType*, 5> kTypes = {
      &imu_sensor(), &spinning_lidar_sensor(), &column_lidar_sensor(), &rosette_lidar_sensor(), &barometer_sensor()};
  return kTypes;
}

const SensorType& find_sensor_type(std::string_view kind) {
  return find_entry(all_sensor_types(), kind, "sensors");
}

}  // namespace tumble::sim
