// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <initializer_list>
#include <sstream>
#include <string>

#include "tumble/common/status.hpp"
#include "tumble_ros/publisher.hpp"
#include "tumble_ros/schedule.hpp"

/// adapter_values.hpp formats values for the diagnostics and for the calibration file.
namespace tumble::ros {

/// Returns numbers as a YAML list with nine digits: 1 nm at 1 m.
inline std::string list_text(std::initializer_list<double> numbers) {
  std::ostringstream out;
  out.precision(9);
  for (const double number : numbers) out << (out.tellp() > 0 ? ", " : "[") << std::showpoint << number;
  return out.str() + "]";
}

inline std::string pose_text(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return list_text({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

template <class Value>
void add(Diagnostics& out, const char* key, const Value& value) {
  std::ostringstream text;
  text << value;
  out.values.emplace_back(key, text.str());
}

/// Adds each finding, with its kind, sensor and axis as key, for example "frozen_axis imu gyro_x".
inline void add_findings(Diagnostics& out, const SensorHealth& health) {
  for (const HealthFinding& finding : health.findings) {
    std::string key = to_string(finding.kind);
    for (const std::string& part : {finding.sensor, std::string(finding.axis)}) key += part.empty() ? "" : " " + part;
    add(out, key.c_str(), to_text(finding));
  }
}

/// Adds the numbers of accepted and rejected messages of a topic.
inline void add_input(Diagnostics& out, const std::string& topic, const Rejections& input) {
  add(out, (topic + " messages").c_str(), input.received);
  add(out, (topic + " messages rejected").c_str(), input.rejected);
  if (!input.last.empty()) add(out, (topic + " last error").c_str(), input.last);
}

}  // namespace tumble::ros
