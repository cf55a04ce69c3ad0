// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

/// The functions in left_out.hpp skip single faulty items of a sensor: IMU readings or point clouds.
namespace tumble::scenarios {

/// kLeftOutShareMax is the largest fraction of a sensor's readings or clouds that may be skipped as faulty. Occasional
/// faults of drivers, buses and files affect a smaller fraction. A wrong clock, unit or layout affects a larger
/// fraction, so the reader rejects the recording.
inline constexpr double kLeftOutShareMax = 0.05;
/// One item may be skipped if the sensor has at least kLeftOutOneOf items, even if this exceeds the fraction
/// kLeftOutShareMax.
inline constexpr std::size_t kLeftOutOneOf = 5;

/// Returns whether `count` of `all` items may be skipped as faulty.
bool may_leave_out(std::size_t count, std::size_t all);

/// LeftOut counts the items of one sensor that a reader skips, by cause. LeftOut stores the location of the first item
/// of each cause.
class LeftOut {
 public:
  /// The text `items` is the plural name of the items in messages.
  explicit LeftOut(std::string items) : items_(std::move(items)) {}

  /// Counts an item as faulty. The text `cause` completes the note "1 of 150 readings is left out: 1 with ...". The
  /// text `error` is the message with the location of the item. If too many items are faulty, require_few() throws
  /// `error`.
  void add(const std::string& cause, const std::string& error);
  /// Counts a skipped item with a cause that may affect any number of items. An example is the empty reading that a
  /// driver publishes in place of a lost reading.
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
  /// Throws BadInput, with the message of the first faulty item, if too many items are faulty. The parameter `kept` is
  /// the number of remaining items.
  void require_few(std::size_t kept) const;
  /// Returns a note for the user about the skipped items, or "" if no item was skipped.
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

/// Returns for each time stamp whether to keep it, so that the kept time stamps increase. The function drops as few
/// time stamps as possible (longest increasing subsequence); of several choices, it keeps early time stamps. If there
/// are at least ten time stamps, the first or last may also be dropped. The first or last time stamp is dropped if its
/// distance from the others exceeds the duration of the others. A few time stamps at either end are dropped if the gap
/// to the others also exceeds a day. Gaps of more than a day occur when a clock is set. The cost is O(N log N), or O(N)
/// if all time stamps increase.
std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns);

/// Removes the elements of `rows` for which `kept` is false. A list of another length is unchanged, because it contains
/// data that the sensor lacks.
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
