// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace tumble {

/// Integer nanoseconds in the clock of the time stamps, with an arbitrary zero.
using TimeNs = std::int64_t;

enum class ErrorCode : std::uint8_t {
  none,
  empty,              ///< a required input is missing
  non_finite,         ///< NaN or infinity
  time_order,         ///< a time stamp is not later than the previous time stamp
  gap,                ///< a time stamp is too long after the previous time stamp
  out_of_range,       ///< a value is outside its stated bounds
  insufficient_data,  ///< fewer samples, points or matches than the computation needs
  degenerate,         ///< the data do not determine the result in every direction
  diverged,           ///< an iteration left its trust region
};

const char* to_string(ErrorCode error_code);

/// Estimators report input errors as a Status and print nothing. Only constructors of estimators throw exceptions.
struct Status {
  ErrorCode error_code = ErrorCode::none;
  const char* field = "";  ///< name of the input field (static string)
  double value = 0.0;      ///< value of the input field, in the field's unit
  double bound = 0.0;      ///< violated limit, in the field's unit

  bool ok() const { return error_code == ErrorCode::none; }
  /// message() returns for example "time_order: time_ns is 5; the bound is 7", or "ok".
  std::string message() const;
};

/// Constructors throw InvalidParams if a parameter is out of its documented bounds.
class InvalidParams : public std::invalid_argument {
 public:
  InvalidParams(const std::string& field, double value, const std::string& bound);
};

/// Throws InvalidParams if `value` is NaN or outside of [low, high].
void require_in_interval(const char* field, double value, double low, double high);

/// One suspected fault of a sensor or of the estimate, as reported by health() of the odometry classes.
struct HealthFinding {
  enum class Kind : std::uint8_t {
    frozen_axis,                    ///< one axis of a gyro or an accelerometer repeats one reading
    frozen_sensor,                  ///< all axes of a gyro or an accelerometer, or all IMUs, repeat one reading
    imu_frozen,                     ///< one of several IMUs repeats one reading, on `axis` or on all axes
    imu_silent,                     ///< one of several IMUs delivers no readings
    imu_contradicts_other_imus,     ///< rate or specific force of one of several IMUs contradicts the other IMUs
    wrong_force_magnitude_at_rest,  ///< the specific force at rest has another magnitude than gravity, or another unit
    wrong_axes_or_signs,            ///< axes are exchanged or inverted
    inverted_accel_in_flight,       ///< the specific force in free flight fits an accelerometer with inverted axes
    inconsistent_rotation,  ///< measured gravity, or motion about a pivot, contradicts the rotation that the gyro
                            ///< measures
    gyro_scale,             ///< accelerometer differences between several IMUs contradict the scale of the gyros
    lidar_scale,            ///< motion measured by the lidar has another scale than motion measured by the IMU
    lidar_calibration,      ///< pose or time offset of the lidar relative to the IMU differ from the stated values
    attitude_unknown,       ///< the direction of gravity is unknown; value: duration [s]
    vertical_unknown,       ///< the direction of gravity in the map is uncertain after a start in motion
    tracking_lost,  ///< the pose in the map is uncertain, or registered poses contradict the inertial prediction
    not_localised,  ///< the robot is not localised in the prior map
  };
  static constexpr Kind kLast = Kind::not_localised;

  Kind kind = Kind::frozen_axis;
  std::string sensor;                   ///< "imu": all IMUs; "imu_2": second of several IMUs; "lidar"; "": the estimate
  const char* axis = "";                ///< "gyro_x" to "accel_z", if one axis is suspect
  const char* quantity = "";            ///< static string: the tested quantity, with its unit
  double value = 0.0;                   ///< measured value of the tested quantity
  double bound = 0.0;                   ///< violated limit of the tested quantity
  std::optional<TimeNs> since_ns = {};  ///< start of the fault; empty if unknown
  /// `ended` is true if the fault has ended. During a run, `ended` is false in every finding of
  /// TumblingOdometry::health().
  bool ended = false;

  /// Returns how far `value` is beyond `bound`, from 0 (at the bound) to 1 (far beyond the bound). The severity is not
  /// a probability.
  double severity() const;
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
  /// Returns the status of the most important finding, or `ok` without a finding.
  Status worst_status() const { return ok() ? Status{} : findings.front().status(); }
  operator Status() const { return worst_status(); }
  /// Returns the text of the most important finding, or "ok" without a finding.
  std::string worst_message() const { return ok() ? "ok" : to_text(findings.front()); }
  bool invalidates_estimate() const;

  /// Adds a finding unless `status` is ok. If a finding of the same kind, sensor and axis exists, add() only marks the
  /// existing finding as not ended.
  void add(HealthFinding::Kind kind, const Status& status, std::string sensor, const char* axis = "",
           std::optional<TimeNs> since_ns = {});
  void add(HealthFinding finding);
  void add(const SensorHealth& other);
  /// Adds the findings of `current`, the newest result of health(), and marks all other findings as ended.
  void add_current_and_end_others(const SensorHealth& current);
};

}  // namespace tumble
