// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::ros {

/// Schedule determines from the stamps of the data when a periodic message is due.
class Schedule {
 public:
  explicit Schedule(double period_s) : period_ns_(static_cast<TimeNs>(1e9 * period_s)) {}

  /// Returns true if a period has passed since the message was last due, at the first call, and if the clock steps
  /// back.
  bool is_due(TimeNs now_ns) {
    if (last_ns_ && now_ns >= *last_ns_ && now_ns - *last_ns_ < period_ns_) return false;
    last_ns_ = now_ns;
    return true;
  }

 private:
  TimeNs period_ns_;
  std::optional<TimeNs> last_ns_;
};

/// Rejections counts the messages of a topic and keeps the last error.
struct Rejections {
  std::size_t received = 0, rejected = 0;
  std::string last;  ///< message of the last error

  const Status& count(const Status& status) {
    ++received;
    if (!status.ok()) {
      ++rejected;
      last = status.message();
    }
    return status;
  }
};

}  // namespace tumble::ros
