// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

/// left_out.hpp leaves out single faulty items of a sensor: IMU readings or clouds. Used only within scenarios.
namespace tumble::scenarios {

/// kLeftOutShareMax is the largest fraction of the readings or clouds of one sensor that is left out as faulty. Single
/// faults of drivers, buses and files affect a smaller fraction of the items. A wrong clock, unit or layout affects
/// most items, so the recording is refused.
inline constexpr double kLeftOutShareMax = 0.05;
/// A sensor with at least kLeftOutOneOf items may lose one item, even if one item exceeds kLeftOutShareMax.
inline constexpr std::size_t kLeftOutOneOf = 5;

/// Returns true if `count` of `all` items may be left out.
bool may_leave_out(std::size_t count, std::size_t all);

/// LeftOut counts the items of one sensor that a reader leaves out, by cause. LeftOut stores the location of the first
/// item of each cause.
class LeftOut {
 public:
  /// `items` is the plural name of the items, for messages.
  explicit LeftOut(std::string items) : items_(std::move(items)) {}

  /// Counts an item as faulty. `cause` completes the note "1 of 150 readings is left out: 1 with ...". `error` is the
  /// message with the location of the item. If too many items are faulty, require_few() throws `error`.
  void add(const std::string& cause, const std::string& error);
  /// Counts an item of a kind whose number is unlimited. An example is the empty reading that a driver publishes for a
  /// lost reading.
  void add_unlimited(const std::string& cause, const std::string& error);
  /// Calls `read`, and counts an item with faulty values if `read` throws BadInput.
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
  /// that remain.
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

/// Returns for each stamp whether to keep it, so that the kept stamps increase. The function drops as few stamps as
/// possible (longest increasing subsequence); of several choices, it keeps early stamps. If there are at least ten
/// stamps, a first or last stamp may also be dropped. The first or last stamp is dropped if its distance from the
/// remaining stamps exceeds their duration. A few stamps at either end are dropped if the gap also exceeds a day.
/// Stamps from before a clock was set cause gaps of more than a day. O(N log N), or O(N) for stamps that increase.
std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns);

/// Removes the elements of `rows` for which `kept` is false. A list of another length, for data that the sensor lacks,
/// stays unchanged.
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
