// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "scenarios/recordings/whole_seconds.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kSaid_ns = 1'000'000;
/// A header stamp that is more than 10 ms later than its record stamp comes from another clock.
constexpr std::int64_t kAhead_ns = 10'000'000;
/// If the delay from header to record stamps varies by more than 0.5 s, the clocks drift or the header stamps are not
/// measurement times.
constexpr std::int64_t kSteady_ns = 500'000'000;

std::string seconds_text(std::int64_t time_ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g s", 1e-9 * static_cast<double>(time_ns));
  return text.data();
}

constexpr std::int64_t kLast_ns = 4294967295 * kSecond_ns;

std::int64_t between(std::int64_t from_ns, std::int64_t to_ns) {
  std::int64_t step_ns = 0;
  if (!__builtin_sub_overflow(to_ns, from_ns, &step_ns)) return step_ns;
  return to_ns > from_ns ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

std::string course(const char* which, std::int64_t before_ns, std::int64_t now_ns) {
  if (now_ns > before_ns)
    return fmt::format("the {} stamp increases by {}", which, seconds_text(between(before_ns, now_ns)));
  if (now_ns < before_ns)
    return fmt::format("the {} stamp decreases by {}", which, seconds_text(between(now_ns, before_ns)));
  return now_ns == 0 ? fmt::format("the {} stamp is 0 in this message and the previous message", which)
                     : fmt::format("the {} stamp does not change", which);
}

}  // namespace

std::int64_t stamp_of(const ros::Header& header) {
  return std::int64_t{header.sec} * kSecond_ns + header.nanosec;
}

std::int64_t BagStamps::chosen(std::int64_t header_ns, std::int64_t record_ns, const std::string& where) const {
  if (source_ == StampSource::header) return header_ns;
  if (record_ns < 0 || record_ns > kLast_ns)
    throw BadInput(fmt::format("{}: the record stamp of the message is {} ns; it must be from 0 to {} ns", where,
                               record_ns, kLast_ns));
  return record_ns;
}

void BagStamps::add(std::int64_t header_ns, std::int64_t record_ns) {
  header_ns_.push_back(header_ns);
  record_ns_.push_back(record_ns);
}

std::string BagStamps::disorder(std::size_t k) const {
  if (k == 0) return "the time stamp of this message is far from the time stamps of all other messages";
  const std::string header = course("header", header_ns_[k - 1], header_ns_[k]),
                    record = course("record", record_ns_[k - 1], record_ns_[k]);
  const bool by_header = source_ == StampSource::header;
  const bool header_rises = header_ns_[k] > header_ns_[k - 1], record_rises = record_ns_[k] > record_ns_[k - 1];
  const bool rises = by_header ? header_rises : record_rises, other_rises = by_header ? record_rises : header_rises;
  return std::string(rises ? "the time stamp is out of order: " : "the time stamp does not increase: ") +
         (by_header ? header + ", " + record : record + ", " + header) +
         (rises || !other_rises ? ""
          : by_header           ? " (set '--stamps record')"
                                : " (set '--stamps header')");
}

std::pair<std::int64_t, std::int64_t> BagStamps::lag_ns() const {
  std::pair<std::int64_t, std::int64_t> out{};
  const std::vector<bool> in_order = stamps_in_order(times_ns());
  bool first = true;
  for (std::size_t k = 0; k < in_order.size(); ++k) {
    if (!in_order[k]) continue;
    const std::int64_t lag = between(header_ns_[k], record_ns_[k]);
    out = first ? std::pair(lag, lag) : std::pair(std::min(out.first, lag), std::max(out.second, lag));
    first = false;
  }
  return out;
}

bool BagStamps::other_clock() const {
  const auto [least_ns, most_ns] = lag_ns();
  return least_ns < -kAhead_ns || most_ns >= kSecond_ns;
}

std::string BagStamps::remark() const {
  const auto [least_ns, most_ns] = lag_ns();
  if (least_ns > -kSaid_ns && most_ns < kSaid_ns) return "";
  const bool changes = between(least_ns, most_ns) > kSteady_ns;
  const std::string taken = source_ == StampSource::header ? "headers" : "records";
  return fmt::format(
      "{}the record stamps of the messages are {} to {} later than the header stamps{}; this import uses the stamps of "
      "the {}",
      other_clock() || changes ? "caution: " : "", seconds_text(least_ns), seconds_text(most_ns),
      other_clock() ? "; the clocks may differ"
      : changes     ? "; one of the clocks may drift"
                    : "",
      taken);
}

}  // namespace tumble::scenarios
