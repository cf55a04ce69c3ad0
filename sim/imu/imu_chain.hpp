// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "sim/imu/bias.hpp"
#include "sim/imu/elements.hpp"
#include "sim/imu/rail.hpp"
#include "sim/imu/sampling.hpp"
#include "sim/imu/stages.hpp"
#include "sim/parameters.hpp"

namespace tumble::sim {

/// What a triad makes of one output window.
struct TriadReading {
  Eigen::Vector3d delivered;  ///< as the device says it
  Eigen::Vector3d unclipped;  ///< the same errors, no rail
  Eigen::Vector3d bias;       ///< in force at the window's end
};

/// Error chain of one triad (gyroscope or accelerometer), fed at the rate of the physics, read once per output window:
/// analogue low-pass, scale and misalignment, bias, what is added from outside (g-sensitivity), white noise of the part
/// in range, the sensing elements and their rail, the device's compensation of them, quantum, digital low-pass, mean
/// over the window. With `clip_after_low_pass` elements and rail act on that mean instead.
///
/// The mean of a turning triad's readings is not the increment of its motion (coning, sculling). The window's ideal
/// reading is therefore given from outside, exact, and the mean of the chain's errors is added to it; an element that
/// met its rail in the window reports the plain mean of what came through. With every stage off the reading is the
/// exact one, bit for bit. The unclipped twin goes through the same stages with the same noise.
/// A device with a window or a rate of its own (sampling.hpp) does not integrate: its reading is the plain mean of that
/// window.
class TriadChain {
 public:
  /// `prefix` and `unit` select the numbers: "gyro", "rad_s" or "accel", "m_s2". Streams are named after
  /// `stream_name`; `steps` is the number of physics steps in a window.
  TriadChain(const Values& values, const std::string& prefix, const std::string& unit, double rate_hz, int steps,
             std::uint64_t seed, const std::string& stream_name);

  /// One physics step: the ideal mean over it, and what is added to the signal before its noise.
  void step(const Eigen::Vector3d& ideal, const Eigen::Vector3d& added);
  /// Ends the window, whose exact reading is `exact`; sets bit `first_bit + i` of `flags` for each element i that met
  /// its rail.
  TriadReading take(const Eigen::Vector3d& exact, int first_bit, std::uint8_t& flags);

  const Elements& elements() const { return elements_; }
  /// In place of those drawn, before the first step.
  void set_elements(const Elements& elements) { elements_ = elements; }

 private:
  /// From the signal to the mean of a window, with the rail or without.
  struct Path {
    LowPass low_pass;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), error = Eigen::Vector3d::Zero();
    /// Returns what came through.
    Eigen::Vector3d add(const Eigen::Vector3d& signal, const Eigen::Vector3d& ideal);
  };

  /// The reading of a device that integrates from output to output.
  TriadReading integrated(const Eigen::Vector3d& exact) const;

  double rate_hz_, noise_, precise_noise_, quantum_, precise_quantum_;
  bool rail_after_;
  int bias_steps_;
  Stream noise_stream_;
  DelayLine delay_;
  LowPass low_pass_;
  Bias bias_;
  RangeChoice range_;
  Rail rail_;
  Elements elements_;
  Eigen::Matrix3d axis_errors_;
  Eigen::Vector3d bias_now_ = Eigen::Vector3d::Zero();
  Path delivered_, unclipped_;
  Sampling sampling_;
  std::int64_t count_ = 0;
  int in_window_ = 0;
  std::uint8_t railed_ = 0;
};

}  // namespace tumble::sim
