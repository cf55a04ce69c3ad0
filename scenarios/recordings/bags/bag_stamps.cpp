// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/whole_seconds.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kSaid_ns = 1'000'000;
/// A header stamp that is later than its record's stamp by more than this belongs to another clock.
constexpr std::int64_t kAhead_ns = 10'000'000;
/// Largest normal delay between messages; beyond this delay, the clocks drift or stamps are not measurement times.
constexpr std::int64_t kSteady_ns = 500'000'000;

std::string seconds_text(std::int64_t time_ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g s", 1e-9 * static_cast<double>(time_ns));
  return text.data();
}

/// Latest time that a header can store.
constexpr std::int64_t kLast_ns = 4294967295 * kSecond_ns;

/// Returns the difference of two stamps without overflow.
std::int64_t between(std::int64_t from_ns, std::int64_t to_ns) {
  std::int64_t step_ns = 0;
  if (!__builtin_sub_overflow(to_ns, from_ns, &step_ns)) return step_ns;
  return to_ns > from_ns ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

/// Describes the change from the previous stamp.
std::string course(std::int64_t before_ns, std::int64_t now_ns) {
  if (now_ns > before_ns) return "increases by " + seconds_text(between(before_ns, now_ns));
  if (now_ns < before_ns) return "decreases by " + seconds_text(between(now_ns, before_ns));
  return now_ns == 0 ? "is 0, like the previous one" : "does not change";
}

}  // namespace

std::int64_t stamp_of(const ros::Header& header) {
  return std::int64_t{header.sec} * kSecond_ns + header.nanosec;
}

std::int64_t BagStamps::take(std::int64_t header_ns, std::int64_t record_ns, const std::string& where) {
  const bool by_header = source_ == StampSource::header;
  if (!by_header && (record_ns < 0 || record_ns > kLast_ns)) {
    throw BadInput(fmt::format("{}: the record's stamp is {} ns, must be from 0 to {}", where, record_ns, kLast_ns));
  }
  if (header_ns_ && (by_header ? header_ns <= *header_ns_ : record_ns <= *record_ns_)) {
    const std::string header = "the header's " + course(*header_ns_, header_ns),
                      record = "the record's " + course(*record_ns_, record_ns);
    const bool other_rises = by_header ? record_ns > *record_ns_ : header_ns > *header_ns_;
    throw BadInput(
        where + ": the time stamp does not increase: " + (by_header ? header + ", " + record : record + ", " + header) +
        (!other_rises ? ""
         : by_header  ? "; set '--stamps record' to use the record stamps"
                      : "; set '--stamps header' to use the header stamps"));
  }
  const std::int64_t lag_ns = between(header_ns, record_ns);
  least_lag_ns_ = header_ns_ ? std::min(least_lag_ns_, lag_ns) : lag_ns;
  most_lag_ns_ = header_ns_ ? std::max(most_lag_ns_, lag_ns) : lag_ns;
  header_ns_ = header_ns, record_ns_ = record_ns;
  return by_header ? header_ns : record_ns;
}

bool BagStamps::other_clock() const {
  return least_lag_ns_ < -kAhead_ns || most_lag_ns_ >= kSecond_ns;
}

std::string BagStamps::remark() const {
  if (!header_ns_ || (least_lag_ns_ > -kSaid_ns && most_lag_ns_ < kSaid_ns)) return "";
  const bool changes = between(least_lag_ns_, most_lag_ns_) > kSteady_ns;
  const std::string taken = source_ == StampSource::header ? "headers" : "records";
  return fmt::format(
      "{}the bag recorded its messages {} to {} after their header stamps{}; this import uses the stamps of the {}",
      other_clock() || changes ? "caution: " : "", seconds_text(least_lag_ns_), seconds_text(most_lag_ns_),
      other_clock() ? "; the clocks may differ"
      : changes     ? "; one of the clocks may drift"
                    : "",
      taken);
}

}  // namespace tumble::scenarios
