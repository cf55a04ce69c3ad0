// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"

/// Used only within scenarios/recordings/bags.
namespace tumble::scenarios {

/// ns since 1970.
std::int64_t stamp_of(const ros::Header& header);

/// Stores the two stamps of a topic's messages, in order: the header's (time of measurement) and the record's (time of
/// recording).
class BagStamps {
 public:
  explicit BagStamps(StampSource source) : source_(source) {}

  /// Returns the stamp from the chosen source. Throws BadInput, with a message that starts with `where`, if the stamps
  /// do not increase; the message also describes the other source of stamps.
  std::int64_t take(std::int64_t header_ns, std::int64_t record_ns, const std::string& where);

  /// Returns true if header stamps are used and the stamp equals the previous header's stamp. A message with the
  /// previous header stamp and equal content is a duplicate.
  bool repeats(std::int64_t header_ns) const { return source_ == StampSource::header && header_ns_ == header_ns; }

  /// Describes how far record stamps are behind header stamps; the text is empty if the lag is always below one
  /// millisecond. Warns if the lag reaches a second, is negative, or changes.
  std::string remark() const;
  /// Returns true if header stamps are ahead of record stamps, or a second or more behind.
  bool other_clock() const;

 private:
  StampSource source_;
  std::optional<std::int64_t> header_ns_, record_ns_;  ///< of the previous message
  std::int64_t least_lag_ns_ = 0, most_lag_ns_ = 0;
};

}  // namespace tumble::scenarios
