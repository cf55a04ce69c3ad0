// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

/// left_out.hpp skips single faulty items of a sensor: IMU readings or point clouds.
namespace tumble::scenarios {

/// Largest fraction of a sensor's items that may be skipped as faulty. Occasional faults of drivers, buses and files
/// affect a smaller fraction. A wrong clock, unit or layout affects a larger fraction; the reader then rejects the
/// recording.
inline constexpr double kLeftOutShareMax = 0.05;
/// One item may always be skipped if the sensor has at least this many items.
inline constexpr std::size_t kLeftOutOneOf = 5;

/// Returns true if `count` of `all` items may be skipped as faulty.
bool may_leave_out(std::size_t count, std::size_t all);

/// LeftOut counts the skipped items of one sensor by cause, and stores the location of the first item of each cause.
class LeftOut {
 public:
  /// `items` is the plural name of the items in messages.
  explicit LeftOut(std::string items) : items_(std::move(items)) {}

  /// Counts an item as faulty. `cause` completes the note "1 of 150 readings is left out: 1 with ...". `error` is the
  /// message with the location of the item, which require_few() throws if too many items are faulty.
  void add(const std::string& cause, const std::string& error);
  /// Counts a skipped item whose cause may affect any number of items. For example, some drivers publish an empty
  /// reading in place of a lost reading.
  void add_unlimited(const std::string& cause, const std::string& error);
  /// Calls `read`. If `read` throws BadInput, counts an item with faulty data.
  template <class Read>
  void guard(Read&& read) {
    try {
      read();
    } catch (const BadInput& error) {
      add("faulty data", error.what());
    }
  }

  std::size_t count() const { return faulty_ + unlimited_; }
  /// If too many items are faulty, throws BadInput with the message of the first one. `kept` is the number of remaining
  /// items.
  void require_few(std::size_t kept) const;
  /// Returns a note for the user about the skipped items; empty if no item was skipped.
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

/// Returns true for each time stamp to keep, so that the kept time stamps increase. As few as possible are dropped
/// (longest increasing subsequence), preferably late ones. With at least ten time stamps, the first or last is also
/// dropped if its distance from the others exceeds their duration. A few time stamps at either end are dropped if the
/// gap to the others also exceeds a day, which occurs when a clock is set. The cost is O(N log N), or O(N) if all time
/// stamps increase.
std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns);

/// Removes the elements of `rows` for which `kept` is false. A list of another length is unchanged: the sensor lacks
/// these data.
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
