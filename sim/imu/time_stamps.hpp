// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

/// From the true end of each window to the stamp that the host writes, or to nothing when the sample is lost. Stamps:
/// constant offset and white jitter (normal, cut at three standard deviations, small against the period, so that stamps
/// rise always). Losses: runs whose lengths are geometric (Gilbert's model), independent of the signal.
/// What it does not model: a clock that runs fast or slow, samples that arrive in the wrong order.
class TimeStamps {
 public:
  /// Reads time_offset_s, time_jitter_s, dropout_share and dropout_mean_samples. Throws InvalidSituation, `place`
  /// first, when six jitters are no less than the period.
  TimeStamps(const Values& values, const std::string& place, std::int64_t period_ns, const Stream& stream);
  /// To be called once for each window.
  std::optional<std::int64_t> stamp(std::int64_t window_end_ns);

 private:
  bool lost();

  std::int64_t offset_ns_;
  double jitter_ns_;
  double loss_starts_ = 0.0, loss_ends_ = 1.0;
  bool losing_ = false;
  Stream stream_;
};

}  // namespace tumble::sim
