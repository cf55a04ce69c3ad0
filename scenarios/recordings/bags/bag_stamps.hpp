// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"

/// Private to scenarios/recordings/bags.
namespace tumble::scenarios {

/// ns since 1970.
std::int64_t stamp_of(const ros::Header& header);

/// The two stamps of a topic's messages, in their order: the header's, of whoever measured, and the record's, of when
/// the bag took the message.
class BagStamps {
 public:
  explicit BagStamps(StampSource source) : source_(source) {}

  /// The stamp of the chosen source. Throws BadInput beginning with `where`: it does not rise; what the other one does
  /// is said.
  std::int64_t take(std::int64_t header_ns, std::int64_t record_ns, const std::string& where);

  /// The headers say the same time as in the message before, and they are what counts: with the same content it is that
  /// message once more.
  bool repeats(std::int64_t header_ns) const { return source_ == StampSource::header && header_ns_ == header_ns; }

  /// How far the records lag behind the headers, or nothing where that is less than a millisecond throughout. A caution
  /// where a second or more lies between them, where headers are ahead of their records, and where the lag changes.
  std::string remark() const;
  /// Headers are ahead of their records, or a second or more behind.
  bool other_clock() const;

 private:
  StampSource source_;
  std::optional<std::int64_t> header_ns_, record_ns_;  ///< of the message before
  std::int64_t least_lag_ns_ = 0, most_lag_ns_ = 0;
};

}  // namespace tumble::scenarios
