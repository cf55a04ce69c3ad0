// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Sampling of a device that does not integrate between outputs. Each reading is the plain mean of the signal over the
/// device's own window. The device may have its own update rate, which is slower or faster than the output rate and not
/// synchronous with the outputs. Outputs repeat the last reading until a new reading is available (sample and hold).
/// The model excludes drift and jitter of the device's clock, and weighted windows.
class Sampling {
 public:
  struct Params {
    double window_s = 0.0;   ///< 0: the time between readings
    double update_hz = 0.0;  ///< readings per second; 0: one per output
  };
  struct Reading {
    Eigen::Vector3d delivered = Eigen::Vector3d::Zero(), unclipped = Eigen::Vector3d::Zero();
    std::uint8_t railed = 0;  ///< bits of all steps in the window
  };

  /// `rate_hz` is the rate of calls of `add`. Draws the phase of the readings from `stream` if the device has its own
  /// update rate.
  Sampling(const Params& params, double rate_hz, Stream stream);

  /// Returns false if the device integrates between outputs. If on() is false, no other member may be used.
  bool on() const { return !ring_.empty(); }
  void add(const Reading& step);
  /// Returns the current output. The cost is O(window) for a device without its own update rate.
  Reading output() const;

 private:
  Reading mean() const;

  double readings_per_step_ = 0.0, phase_ = 0.0;
  std::vector<Reading> ring_;  ///< most recent steps; empty: off
  std::size_t next_ = 0, filled_ = 0;
  Reading held_;
  bool holding_ = false;
};

}  // namespace tumble::sim
