// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/waiting_input.hpp"
#include "tumble/mapping/detail/odometer_reading.hpp"

#include <algorithm>

namespace tumble {

namespace {

TimeNs middle_ns(const OdometerReading& reading) {
  const TimeNs from_ns = reading_start_ns(reading);
  return from_ns + (reading_end_ns(reading) - from_ns) / 2;
}

}  // namespace

Status WaitingReadings::add(const OdometerReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most) {
  if (const Status status = check_odometer_reading(reading); !status.ok()) return status;
  const bool motion = std::holds_alternative<RelativePoseReading>(reading);
  const char* const first = motion ? "from_ns" : "time_ns";
  const char* const last = motion ? "to_ns" : "time_ns";
  const TimeNs from_ns = reading_start_ns(reading), to_ns = reading_end_ns(reading),
               earliest_ns = done_ns - kExtrapolation_ns;
  if (from_ns < earliest_ns) return {ErrorCode::time_order, first, double(from_ns), double(earliest_ns)};
  if (to_ns > latest_ns) return {ErrorCode::out_of_range, last, double(to_ns), double(latest_ns)};
  const TimeNs middle = middle_ns(reading);
  if (middle <= done_ns) return {ErrorCode::time_order, last, double(to_ns), double(done_ns)};
  if (waiting_readings_.size() >= most)
    return {ErrorCode::out_of_range, "readings waiting", double(waiting_readings_.size() + 1), double(most)};
  const auto later = [](TimeNs time_ns, const OdometerReading& other) { return time_ns < middle_ns(other); };
  waiting_readings_.insert(std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), middle, later),
                           reading);
  return {};
}

std::optional<OdometerReading> WaitingReadings::find(TimeNs from_ns, TimeNs end_ns) const {
  const auto later = [](TimeNs time_ns, const OdometerReading& other) { return time_ns < middle_ns(other); };
  auto next = std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), end_ns, later);
  while (next != waiting_readings_.begin() && middle_ns(*--next) > from_ns - kExtrapolation_ns) {
    if (reading_start_ns(*next) >= from_ns - kExtrapolation_ns && reading_end_ns(*next) <= end_ns + kExtrapolation_ns)
      return *next;
  }
  return std::nullopt;
}

std::optional<OdometerReading> WaitingReadings::take_readings_in(TimeNs from_ns, TimeNs end_ns) {
  std::optional<OdometerReading> out;
  for (; !waiting_readings_.empty() && middle_ns(waiting_readings_.front()) <= end_ns; waiting_readings_.pop_front()) {
    const OdometerReading& reading = waiting_readings_.front();
    if (reading_start_ns(reading) >= from_ns - kExtrapolation_ns &&
        reading_end_ns(reading) <= end_ns + kExtrapolation_ns)
      out = reading;
  }
  return out;
}

}  // namespace tumble
