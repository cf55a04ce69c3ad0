// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// TimeStamps converts the true end of each averaging window to the time stamp that the host computer assigns, or to no
/// time stamp if the sample is lost. The time stamps have a constant offset and white jitter, clamped to three standard
/// deviations. Lost samples occur in sequences with geometrically distributed lengths (Gilbert's model), independent of
/// the signal. The simulation does not include rate errors of the clock, or samples in the wrong order.
class TimeStamps {
 public:
  TimeStamps(const Values& values, const std::string& place, std::int64_t period_ns, const Stream& stream);
  /// The caller must call stamp() once for each averaging window.
  std::optional<std::int64_t> stamp(std::int64_t window_end_ns);

 private:
  bool lost();

  std::int64_t offset_ns_, start_ns_;
  double jitter_ns_;
  double loss_starts_ = 0.0, loss_ends_ = 1.0;
  bool losing_ = false;
  Stream stream_;
};

}  // namespace tumble::sim
