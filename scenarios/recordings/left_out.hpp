// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

/// Leaves out single faulty items of a sensor: IMU readings or clouds. Used only within scenarios.
namespace tumble::scenarios {

/// Largest share of the readings or clouds of one sensor that is left out as faulty. Single faults of drivers, buses
/// and files stay below this share. A wrong clock, unit or layout affects most items, so the recording is refused.
inline constexpr double kLeftOutShareMax = 0.05;
/// One item may be left out of at least this many items, whatever its share.
inline constexpr std::size_t kLeftOutOneOf = 5;

/// Returns true if `count` of `all` items may be left out.
bool may_leave_out(std::size_t count, std::size_t all);

/// Counts the items of one sensor that a reader leaves out, by cause, with the first place of each cause.
class LeftOut {
 public:
  /// `items` is the plural name of the items, for messages.
  explicit LeftOut(std::string items) : items_(std::move(items)) {}

  /// Counts a faulty item. `cause` completes "1 of 150 readings is left out: 1 with ...". `error` is the message, with
  /// the place of the item, that require_few() throws if too many items are faulty.
  void add(const std::string& cause, const std::string& error);
  /// Counts an item whose number is not limited, such as a reading without data that a driver publishes for a lost one.
  void add_unlimited(const std::string& cause, const std::string& error);
  /// Calls `read`; counts an item with faulty values if `read` throws BadInput.
  template <class Read>
  void guard(Read&& read) {
    try {
      read();
    } catch (const BadInput& error) {
      add("faulty data", error.what());
    }
  }

  std::size_t count() const { return faulty_ + unlimited_; }
  /// Throws BadInput with the first error if more items are faulty than may be left out. `kept` is the number of items
  /// that were not left out.
  void require_few(std::size_t kept) const;
  /// Returns a note for the user, or "" if no item was left out.
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

/// Returns true for each stamp to keep, such that the kept stamps increase. As few stamps as possible are dropped
/// (longest increasing subsequence), and of several choices early stamps are kept. Of ten or more stamps, a first or
/// last stamp is also dropped if it is separated from the others by more than the duration of the others. A few stamps
/// at either end are dropped if they are also separated by more than a day, as before a clock is set. O(N log N), O(N)
/// for stamps that increase.
std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns);

/// Removes the rows that are not kept. Rows of another length, which a sensor may lack, stay unchanged.
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
