// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/ros_messages.hpp"

/// BagStamps compares the header stamps and record stamps of a topic.
namespace tumble::scenarios {

/// Returns the time stamp of a message header [ns since 1970].
std::int64_t stamp_of(const ros::Header& header);

/// BagStamps stores two time stamps per message of a topic: the header's stamp (time of measurement) and the record's
/// stamp (time of recording).
class BagStamps {
 public:
  explicit BagStamps(StampSource source) : source_(source) {}

  /// Returns the stamp from the source in the constructor. For a record stamp that a header cannot store, throws
  /// BadInput with a message that starts with `where`.
  std::int64_t chosen(std::int64_t header_ns, std::int64_t record_ns, const std::string& where) const;
  /// Stores the two stamps of the next message.
  void add(std::int64_t header_ns, std::int64_t record_ns);
  /// Returns the stored stamps from the source in the constructor.
  const std::vector<std::int64_t>& times_ns() const { return source_ == StampSource::header ? header_ns_ : record_ns_; }
  /// Describes how the stamp of message `k`, which is out of order, differs from the previous stamp. If the stamps of
  /// the other source (header or record) increase, the text recommends that source.
  std::string disorder(std::size_t k) const;

  /// Returns true if the topic uses header stamps and the stamp equals that of the previous message. If also the
  /// contents are equal, the message is a duplicate.
  bool repeats(std::int64_t header_ns) const {
    return source_ == StampSource::header && !header_ns_.empty() && header_ns_.back() == header_ns;
  }

  /// Describes the delay from header stamps to record stamps, over the messages in order; empty if it is always below
  /// one millisecond. The text is a warning if the delay reaches a second, is negative, or changes.
  std::string remark() const;
  /// Returns true if header stamps are later than record stamps, or at least a second earlier. Only messages in order
  /// are compared.
  bool other_clock() const;

 private:
  std::pair<std::int64_t, std::int64_t> lag_ns() const;  ///< smallest and largest delay

  StampSource source_;
  std::vector<std::int64_t> header_ns_, record_ns_;
};

}  // namespace tumble::scenarios
