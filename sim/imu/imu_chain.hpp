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

struct TriadReading {
  Eigen::Vector3d delivered;
  Eigen::Vector3d unclipped;  ///< reading with the same errors, but without saturation
  Eigen::Vector3d bias;       ///< at the end of the averaging window
};

/// TriadChain simulates the errors of a gyro or accelerometer in this order:
/// - analogue low-pass filter, scale and misalignment, bias
/// - external additions (g-sensitivity), white noise of the active range
/// - saturation of the sensing elements, compensation of misalignment and offset
/// - quantisation, digital low-pass filter, mean over the averaging window
///
/// The ideal reading is the rotation or velocity increment over the averaging window, divided by the window length. For
/// a rotating IMU, the ideal reading differs from the mean of the signal (coning, sculling). TriadChain therefore adds
/// only the mean sensor error to the ideal reading. If a sensing element was saturated in the window, the reading is
/// instead the mean of the signal after all stages. A second chain with equal stages and noise, but without saturation,
/// computes the unclipped reading.
class TriadChain {
 public:
  /// `prefix` and `unit` select the parameters of the sensor: "gyro" and "rad_s", or "accel" and "m_s2".
  TriadChain(const Values& values, const std::string& prefix, const std::string& unit, double rate_hz, int steps,
             std::uint64_t seed, const std::string& stream_name);

  /// `ideal` is the true mean of the signal over one physics step. `added` (g-sensitivity) is added to the signal
  /// before the noise.
  void step(const Eigen::Vector3d& ideal, const Eigen::Vector3d& added);
  TriadReading take(const Eigen::Vector3d& exact, int first_bit, std::uint8_t& flags);

  const Elements& elements() const { return elements_; }
  /// The caller must call set_elements() before the first step().
  void set_elements(const Elements& elements) { elements_ = elements; }

 private:
  struct Path {
    LowPass low_pass;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), error = Eigen::Vector3d::Zero();
    Eigen::Vector3d add(const Eigen::Vector3d& signal, const Eigen::Vector3d& ideal);
  };

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
