// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/time_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tumble::sim {

TimeStamps::TimeStamps(const Values& values, const std::string& place, std::int64_t period_ns, const Stream& stream)
    : offset_ns_(std::llround(values.at("time_offset_s") * 1e9)),
      start_ns_(std::llround(values.at("start_delay_s") * 1e9)),
      jitter_ns_(values.at("time_jitter_s") * 1e9),
      stream_(stream) {
  if (6.0 * jitter_ns_ >= static_cast<double>(period_ns)) {
    std::ostringstream text;
    text << place << ".time_jitter_s is " << values.at("time_jitter_s")
         << " s; it must be below a sixth of the period of " << static_cast<double>(period_ns) * 1e-9 << " s";
    throw InvalidSituation(text.str());
  }
  const double share = values.at("dropout_share");
  if (share <= 0.0) return;
  loss_ends_ = 1.0 / values.at("dropout_mean_samples");
  // A sequence of lost samples starts with the probability loss_starts_ per received sample, and ends with the
  // probability loss_ends_ per lost sample. Equally many sequences start and end, so loss_starts_ (1 - share) =
  // loss_ends_ share.
  loss_starts_ = loss_ends_ * share / (1.0 - share);
  losing_ = stream_.uniform() < share;
}

bool TimeStamps::lost() {
  if (loss_starts_ <= 0.0) return false;
  const bool now = losing_;
  losing_ = stream_.uniform() < (losing_ ? 1.0 - loss_ends_ : loss_starts_);
  return now;
}

std::optional<std::int64_t> TimeStamps::stamp(std::int64_t window_end_ns) {
  const double jitter_ns = jitter_ns_ > 0.0 ? jitter_ns_ * std::clamp(stream_.normal(), -3.0, 3.0) : 0.0;
  if (lost() || window_end_ns <= start_ns_) return std::nullopt;
  return window_end_ns + offset_ns_ + std::llround(jitter_ns);
}

}  // namespace tumble::sim
