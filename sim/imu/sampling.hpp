// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// How a device samples that does not integrate from one output to the next: each of its readings is the plain mean of
/// what came through during a window of its own, and it may have a rate of its own, slower than that of the outputs or
/// faster, not in step with them: an output says the last reading once more until there is a new one (sample and hold,
/// as in a log that is faster than its sensor).
/// What it does not model: a clock of its own that drifts or jitters, windows that are weighted.
class Sampling {
 public:
  struct Params {
    double window_s = 0.0;   ///< 0: from reading to reading
    double update_hz = 0.0;  ///< readings per second; 0: one for each output
  };
  struct Reading {
    Eigen::Vector3d delivered = Eigen::Vector3d::Zero(), unclipped = Eigen::Vector3d::Zero();
    std::uint8_t railed = 0;  ///< bits of every step of the window
  };

  /// `rate_hz`: of `add`. Draws the phase of its readings from `stream` when it
  /// has a rate of its own.
  Sampling(const Params& params, double rate_hz, Stream stream);

  /// Off: the device integrates from output to output; nothing may be added or asked.
  bool on() const { return !ring_.empty(); }
  void add(const Reading& step);
  /// What an output says now. O(window) where there is no rate of its own.
  Reading output() const;

 private:
  Reading mean() const;

  double readings_per_step_ = 0.0, phase_ = 0.0;
  std::vector<Reading> ring_;  ///< the last steps; empty: off
  std::size_t next_ = 0, filled_ = 0;
  Reading held_;
  bool holding_ = false;
};

}  // namespace tumble::sim
