// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/status.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "tumble/common/parameters.hpp"

namespace tumble {

namespace {

// Returns the shortest decimal text that converts back to exactly `value`, in any locale.
std::string text_of_number(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), end.ptr);
}

using Kind = HealthFinding::Kind;

struct FaultDescription {
  const char* name;
  bool makes_estimate_unusable;  ///< see HealthFinding::invalidates_estimate()
  const char* text;
};

constexpr std::array kMeanings = {
    FaultDescription{"frozen_axis", false, "the axis repeats one reading; check the sensor"},
    FaultDescription{"frozen_sensor", true, "the sensor repeats one reading; do not use the estimate"},
    FaultDescription{"imu_frozen", false,
                     "the IMU repeats one reading, and its readings are left out; check the sensor"},
    FaultDescription{"imu_silent", false, "the IMU delivers no readings"},
    FaultDescription{"imu_disagrees", false, "the IMU disagrees with the other IMUs, and its readings are left out"},
    FaultDescription{
        "force_at_rest", true,
        "the specific force at rest differs from gravity, probably because of a wrong unit or scale of the "
        "accelerometer; do not use the estimate"},
    FaultDescription{"wrong_axes_or_signs", true,
                     "axes of the IMU seem to be exchanged or inverted; do not use the estimate"},
    FaultDescription{
        "inverted_accel_in_flight", true,
        "the specific force in free flight contradicts the rotation; axes of the accelerometer seem to be inverted; do "
        "not use the estimate"},
    FaultDescription{
        "rotation", true,
        "the gyro contradicts the rotation of the body, probably because of wrong axes, signs or units; do not use the "
        "estimate"},
    FaultDescription{"gyro_scale", true, "the forces of the IMUs contradict the gyros; do not use the estimate"},
    FaultDescription{"lidar_scale", true, "the scale of the lidar's ranges contradicts the motion measured by the IMU"},
    FaultDescription{"lidar_calibration", true, "the stated mounting or clock of the lidar seems to be wrong"},
    FaultDescription{
        "attitude_unknown", true,
        "the direction of gravity is uncertain, for example after a gap of the IMU; the covariance includes this "
        "uncertainty"},
    FaultDescription{"vertical_unknown", true, "the vertical of the map is uncertain after a start in motion"},
    FaultDescription{"tracking_lost", true, "the position in the map is unknown; do not use the estimate"},
    FaultDescription{"not_localised", true,
                     "the robot is not localised in the prior map; the poses are in a local frame"}};

static_assert(kMeanings.size() == static_cast<std::size_t>(HealthFinding::kLast) + 1);

const FaultDescription& fault_description(Kind kind) {
  return kMeanings.at(static_cast<std::size_t>(kind));
}

std::string text_with_six_digits(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return std::string(text.data(), end.ptr);
}

}  // namespace

const char* to_string(ErrorCode error_code) {
  switch (error_code) {
    case ErrorCode::none:
      return "ok";
    case ErrorCode::empty:
      return "empty";
    case ErrorCode::non_finite:
      return "non_finite";
    case ErrorCode::time_order:
      return "time_order";
    case ErrorCode::gap:
      return "gap";
    case ErrorCode::out_of_range:
      return "out_of_range";
    case ErrorCode::insufficient_data:
      return "insufficient_data";
    case ErrorCode::degenerate:
      return "degenerate";
    case ErrorCode::diverged:
      return "diverged";
  }
  return "unknown";
}

std::string Status::message() const {
  if (ok()) return "ok";
  return std::string(to_string(error_code)) + ": " + field + " is " + text_of_number(value) + "; the bound is " +
         text_of_number(bound);
}

InvalidParams::InvalidParams(const std::string& field, double value, const std::string& bound)
    : std::invalid_argument(field + " is " + text_of_number(value) + "; it must be " + bound) {}

void require_in_interval(const char* field, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw InvalidParams(field, value, "within [" + text_of_number(low) + ", " + text_of_number(high) + "]");
}

const char* to_string(Kind kind) {
  return fault_description(kind).name;
}

double HealthFinding::severity() const {
  const double normal = kind == Kind::lidar_scale ? 1.0 : 0.0;  // value without a fault
  const double distance = std::abs(value - normal), limit = std::abs(bound - normal);
  const double larger = std::max(distance, limit);
  return larger > 0.0 && std::isfinite(larger) ? 1.0 - std::min(distance, limit) / larger : 1.0;
}

/// Estimates are correct again after a temporary failure of attitude, vertical or localisation. After a tracking
/// failure, all later poses are wrong.
bool HealthFinding::invalidates_estimate() const {
  // A suspected error of the gyro's scale or of the lidar's calibration is later confirmed or corrected.
  const bool recovers = kind == Kind::attitude_unknown || kind == Kind::vertical_unknown ||
                        kind == Kind::not_localised || kind == Kind::gyro_scale || kind == Kind::lidar_calibration;
  return fault_description(kind).makes_estimate_unusable && !(ended && recovers);
}

std::string to_text(const HealthFinding& finding) {
  std::string out = finding.sensor;
  if (finding.axis[0] != '\0') out += (out.empty() ? "" : " ") + std::string(finding.axis);
  if (!out.empty()) out += ": ";
  out += fault_description(finding.kind).text;
  if (finding.quantity[0] == '\0') return out;
  return out + " (" + finding.quantity + " is " + text_with_six_digits(finding.value) + ", bound " +
         text_with_six_digits(finding.bound) + ")";
}

bool SensorHealth::invalidates_estimate() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const HealthFinding& finding) { return finding.invalidates_estimate(); });
}

void SensorHealth::add(Kind kind, const Status& status, std::string sensor, const char* axis,
                       std::optional<TimeNs> since_ns) {
  if (status.ok()) return;
  add(HealthFinding{kind, std::move(sensor), axis, status.field, status.value, status.bound, since_ns});
}

void SensorHealth::add(HealthFinding finding) {
  const auto known = std::find_if(findings.begin(), findings.end(), [&](const HealthFinding& each) {
    return each.kind == finding.kind && each.sensor == finding.sensor && std::string_view(each.axis) == finding.axis;
  });
  if (known == findings.end())
    findings.push_back(std::move(finding));
  else
    known->ended = known->ended && finding.ended;
}

void SensorHealth::add_current_and_end_others(const SensorHealth& current) {
  for (HealthFinding& known : findings) known.ended = true;
  add(current);
}

void SensorHealth::add(const SensorHealth& other) {
  for (const HealthFinding& finding : other.findings) add(finding);
}

}  // namespace tumble

namespace tumble::detail {

void BoundsChecker::check(double value, const ParameterInfo& field) {
  if (!out_.status.ok() || (value >= field.low && value <= field.high)) return;
  out_.names.at(out_.prefix_count++) = field.name;
  const bool above = value > field.high;
  out_.status = {ErrorCode::out_of_range, field.name, value, above ? field.high : field.low};
  out_.low = field.low;
  out_.high = field.high;
}

void throw_if_out_of_bounds(const OutOfBoundsParameter& found) {
  if (found.status.ok()) return;
  std::string name;
  for (std::size_t k = 0; k < found.prefix_count; ++k) name += found.names.at(k);
  require_in_interval(name.c_str(), found.status.value, found.low, found.high);
}

}  // namespace tumble::detail
