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

/// The two stamps of a topic's messages, in order: the header's (measurement) and the record's (recording).
class BagStamps {
 public:
  explicit BagStamps(StampSource source) : source_(source) {}

  /// Returns the stamp from the chosen source. Throws BadInput, with a message that starts with `where`, if it does not
  /// increase; the message also describes the other source.
  std::int64_t take(std::int64_t header_ns, std::int64_t record_ns, const std::string& where);

  /// Returns true if header stamps are used and the header equals the previous one. With the same content, the message
  /// is a duplicate.
  bool repeats(std::int64_t header_ns) const { return source_ == StampSource::header && header_ns_ == header_ns; }

  /// Describes how far records lag behind headers; empty if always below one millisecond. Warns if the lag reaches a
  /// second, is negative, or changes.
  std::string remark() const;
  /// Returns true if headers are ahead of their records, or a second or more behind.
  bool other_clock() const;

 private:
  StampSource source_;
  std::optional<std::int64_t> header_ns_, record_ns_;  ///< of the previous message
  std::int64_t least_lag_ns_ = 0, most_lag_ns_ = 0;
};

}  // namespace tumble::scenarios
