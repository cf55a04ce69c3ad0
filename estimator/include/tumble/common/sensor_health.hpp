// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// HealthFinding is one suspected fault of a sensor or of the estimate. The odometry classes report findings with
/// health().
struct HealthFinding {
  enum class Kind : std::uint8_t {
    frozen_axis,               ///< one axis of a gyro or an accelerometer repeats one reading
    frozen_sensor,             ///< all axes of a gyro or an accelerometer, or all IMUs, repeat one reading
    imu_frozen,                ///< one of several IMUs repeats one reading, on `axis` or on all axes
    imu_silent,                ///< one of several IMUs delivers no readings
    imu_disagrees,             ///< one of several IMUs differs from the other IMUs
    force_at_rest,             ///< the specific force at rest has another magnitude than gravity, or another unit
    wrong_axes_or_signs,       ///< axes are exchanged or inverted
    inverted_accel_in_flight,  ///< forces in free flight fit inverted axes of the accelerometer
    rotation,                  ///< the direction of gravity, or a body on a pivot, does not rotate as the gyro measures
    gyro_scale,                ///< the forces of several IMUs contradict the scale of the gyros
    lidar_scale,               ///< the lidar's ranges have another scale than the motion
    lidar_calibration,         ///< mounting or clock of the lidar differ from the stated values
    attitude_unknown,          ///< the direction of gravity is unknown; value: duration [s]
    vertical_unknown,          ///< the vertical of the map is uncertain after a start in motion
    tracking_lost,             ///< the pose in the map is uncertain, or sweeps contradict their predicted poses
    not_localised,             ///< the robot is not localised in the prior map
  };
  static constexpr Kind kLast = Kind::not_localised;

  Kind kind = Kind::frozen_axis;
  std::string sensor;                   ///< "imu": all IMUs; "imu_2": second of several IMUs; "lidar"; "": the estimate
  const char* axis = "";                ///< "gyro_x" to "accel_z", if one axis is suspect
  const char* quantity = "";            ///< static string: the tested quantity, with its unit
  double value = 0.0;                   ///< value of the quantity
  double bound = 0.0;                   ///< violated limit
  std::optional<TimeNs> since_ns = {};  ///< start of the fault; empty if the check does not determine the start
  /// true if the fault has ended; health() of a live run reports only current faults
  bool ended = false;

  /// Returns how far the value is beyond its bound, from 0 (at the bound) to 1 (far beyond the bound). The result is
  /// not a probability.
  double confidence() const;
  Status status() const { return {ErrorCode::out_of_range, quantity, value, bound}; }
  /// Returns true if the fault makes the estimate unusable.
  bool invalidates_estimate() const;
};

const char* to_string(HealthFinding::Kind kind);
/// Returns one sentence that names the sensor, the fault, and the tested quantity with value and limit.
std::string to_text(const HealthFinding& finding);

/// Suspected faults, most important first.
struct SensorHealth {
  std::vector<HealthFinding> findings;

  bool ok() const { return findings.empty(); }
  Status worst() const { return ok() ? Status{} : findings.front().status(); }
  operator Status() const { return worst(); }
  std::string message() const { return ok() ? "ok" : to_text(findings.front()); }
  bool invalidates_estimate() const;

  /// Adds a fault unless `status` is ok. If a fault of the same kind, sensor and axis exists, add() only marks this
  /// fault as not ended.
  void add(HealthFinding::Kind kind, const Status& status, std::string sensor, const char* axis = "",
           std::optional<TimeNs> since_ns = {});
  void add(HealthFinding finding);
  void add(const SensorHealth& other);
  /// Adds the faults in `now`, the newest result of health(), and marks all other faults as ended.
  void merge_current_findings(const SensorHealth& now);
};

}  // namespace tumble
