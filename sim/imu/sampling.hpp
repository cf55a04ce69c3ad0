// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Sampling models a device that outputs mean values. If Sampling is off, each reading contains the exact increment of
/// the motion between two outputs. If Sampling is on, each reading is the unweighted mean of the signal over the
/// device's averaging window. The device's update rate may be lower or higher than the output rate. The output repeats
/// the last reading until a new reading is available (sample and hold). Sampling does not simulate weighted averaging
/// windows, or drift and jitter of the device's clock.
class Sampling {
 public:
  struct Params {
    double window_s = 0.0;   ///< 0: the time between readings
    double update_hz = 0.0;  ///< 0: one reading per output
  };
  struct Reading {
    Eigen::Vector3d delivered = Eigen::Vector3d::Zero(), unclipped = Eigen::Vector3d::Zero();
    std::uint8_t railed = 0;  ///< bit i: sensing element i is saturated
  };

  Sampling(const Params& params, double rate_hz, Stream stream);

  bool on() const { return !ring_.empty(); }
  void add(const Reading& step);
  Reading output() const;

 private:
  Reading mean() const;

  double readings_per_step_ = 0.0, phase_ = 0.0;
  std::vector<Reading> ring_;  ///< ring buffer; empty if switched off
  std::size_t next_ = 0, filled_ = 0;
  Reading held_;
  bool holding_ = false;
};

}  // namespace tumble::sim
