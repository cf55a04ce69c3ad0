// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

/// Occasional faults of drivers, buses and files affect less than 5 % of a sensor's readings. A wrong clock, unit or
/// layout affects more than 5 % of the readings, so the recording is rejected.
inline constexpr double kLeftOutShareMax = 0.05;
/// A sensor with at least five readings may have one faulty reading, even if one reading is more than 5 %.
inline constexpr std::size_t kLeftOutOneOf = 5;

bool may_leave_out(std::size_t count, std::size_t all);

class LeftOut {
 public:
  explicit LeftOut(std::string items) : items_(std::move(items)) {}

  /// `cause` completes the note "the import leaves out 1 of 150 readings: 1 because of ...". `error` contains the
  /// location of the faulty reading.
  void add(const std::string& cause, const std::string& error);
  /// Counts a skipped reading to which the limit kLeftOutShareMax does not apply, for example a reading whose values
  /// are all 0.
  void add_unlimited(const std::string& cause, const std::string& error);
  template <class Read>
  void guard(Read&& read) {
    try {
      read();
    } catch (const BadInput& error) {
      add("faulty data", error.what());
    }
  }

  std::size_t count() const { return faulty_ + unlimited_; }
  void require_few(std::size_t kept) const;
  std::string note(std::size_t kept) const;

 private:
  struct Cause {
    std::string name, first;
    std::size_t count = 0;
  };
  void count_cause(const std::string& cause, const std::string& error);

  std::string items_, first_error_;
  std::vector<Cause> causes_;
  std::size_t faulty_ = 0, unlimited_ = 0;
};

/// Selects time stamps such that the kept stamps increase and the fewest possible stamps are dropped (longest
/// increasing subsequence). With at least ten stamps, a single stamp at either end is also dropped if the gap to the
/// next stamp exceeds the time span of all remaining stamps. Several stamps at one end are dropped only if the gap also
/// exceeds a day, which indicates that the clock was set. The cost for N stamps is O(N log N), or O(N) if all stamps
/// increase.
std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns);

/// Removes the rows of dropped readings. If `rows` and `kept` differ in size, the sensor does not measure the quantity
/// in `rows`, and `rows` stays unchanged.
template <class Row>
void keep_rows(const std::vector<bool>& kept, std::vector<Row>& rows) {
  if (rows.size() != kept.size()) return;
  std::size_t count = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (kept[k]) rows[count++] = rows[k];
  }
  rows.resize(count);
}

}  // namespace tumble::scenarios
