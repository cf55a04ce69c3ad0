// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

std::size_t steps_of_window(const Sampling::Params& params, double rate_hz) {
  if (params.window_s <= 0.0 && params.update_hz <= 0.0) return 0;
  if (params.window_s <= 0.0) return static_cast<std::size_t>(std::max(1.0, std::round(rate_hz / params.update_hz)));
  return static_cast<std::size_t>(std::max(1.0, std::round(params.window_s * rate_hz)));
}

}  // namespace

Sampling::Sampling(const Params& params, double rate_hz, Stream stream)
    : readings_per_step_(params.update_hz / rate_hz), ring_(steps_of_window(params, rate_hz)) {
  if (readings_per_step_ > 0.0) phase_ = stream.uniform();
}

void Sampling::add(const Reading& step) {
  ring_[next_] = step;
  next_ = (next_ + 1) % ring_.size();
  filled_ = std::min(filled_ + 1, ring_.size());
  if (readings_per_step_ <= 0.0) return;
  phase_ += readings_per_step_;
  if (phase_ < 1.0) return;
  phase_ -= std::floor(phase_);
  held_ = mean();
  holding_ = true;
}

Sampling::Reading Sampling::output() const {
  return holding_ ? held_ : mean();
}

Sampling::Reading Sampling::mean() const {
  Reading out;
  for (std::size_t i = 0; i < filled_; ++i) {
    out.delivered += ring_[i].delivered;
    out.unclipped += ring_[i].unclipped;
    out.railed = static_cast<std::uint8_t>(out.railed | ring_[i].railed);
  }
  out.delivered /= static_cast<double>(filled_);
  out.unclipped /= static_cast<double>(filled_);
  return out;
}

}  // namespace tumble::sim
