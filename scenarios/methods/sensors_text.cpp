// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/sensors_text.hpp"

#include <nlohmann/json.hpp>

namespace tumble::scenarios {

namespace {

using nlohmann::json;

json mounting(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.rotation());
  const Eigen::Vector3d p = T.translation();
  return {{"translation_m", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

json imu(const sim::ImuRecord& record) {
  return {{"name", record.name},
          {"device", record.device},
          {"period_ns", record.period_ns},
          {"samples", record.time_ns.size()},
          {"stated_gyro_range_rad_s", record.stated_gyro_range_rad_s},
          {"stated_accel_range_m_s2", record.stated_accel_range_m_s2},
          {"gyro_noise_rad_s_sqrt_hz", record.gyro_noise_rad_s_sqrt_hz},
          {"accel_noise_m_s2_sqrt_hz", record.accel_noise_m_s2_sqrt_hz},
          {"T_BI", mounting(record.T_BI)}};
}

json lidar(const sim::LidarRecord& record) {
  return {{"name", record.name},
          {"device", record.device},
          {"sweep_period_ns", record.sweep_period_ns},
          {"sweeps", record.sweep_start_ns.size()},
          {"T_BL", mounting(record.T_BL)}};
}

json series(const sim::SeriesRecord& record) {
  json quantities = json::array();
  for (const sim::Quantity& quantity : record.quantities)
    quantities.push_back({{"name", quantity.name}, {"unit", quantity.unit}, {"noise", quantity.noise}});
  json constants = json::object();
  for (const sim::Constant& constant : record.constants) constants[constant.name] = constant.value;
  return {{"name", record.name},
          {"kind", record.kind},
          {"device", record.device},
          {"period_ns", record.period_ns},
          {"samples", record.time_ns.size()},
          {"quantities", quantities},
          {"constants", constants},
          {"T_BX", mounting(record.T_BX)}};
}

}  // namespace

std::string sensors_text(const sim::Sensors& sensors) {
  json imus = json::array(), lidars = json::array(), others = json::array();
  for (const sim::ImuRecord& record : sensors.imus) imus.push_back(imu(record));
  for (const sim::LidarRecord& record : sensors.lidars) lidars.push_back(lidar(record));
  for (const sim::SeriesRecord& record : sensors.series) others.push_back(series(record));
  const json all = {{"robot", sensors.robot},
                    {"sphere_radius_m", sensors.sphere_radius_m},
                    {"gravity_m_s2", sensors.gravity_m_s2},
                    {"imus", imus},
                    {"lidars", lidars},
                    {"series", others}};
  return all.dump(2) + "\n";
}

}  // namespace tumble::scenarios
