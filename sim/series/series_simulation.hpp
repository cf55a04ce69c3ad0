// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "sim/sensor_type.hpp"

namespace tumble::sim {

/// Numbers that every sensor of a series has: how often it reads, how its readings are stamped and lost.
inline constexpr std::array kSeriesParameters = {
    Parameter{"output_rate_hz", 50.0, 0.1, 2000.0, "Hz",
              "samples per second; must divide the physics rate of 2000 Hz: each is the mean since the one before"},
    Parameter{"time_offset_s", 0.0, -0.1, 0.1, "s", "stamp minus the true end of the window"},
    Parameter{"time_jitter_s", 0.0, 0.0, 0.1, "s",
              "standard deviation of the stamp, within 3 of them; below a sixth of the period; 0: off"},
    Parameter{"dropout_share", 0.0, 0.0, 0.5, "1", "share of samples that never arrive; 0: off"},
    Parameter{"dropout_mean_samples", 1.0, 1.0, 1e4, "1", "mean length of a run of lost samples"},
};

/// How the readings of a quantity differ from its mean over the window; 0: off.
struct ReadingErrors {
  double noise = 0.0;  ///< standard deviation of each reading's white noise
  double bias = 0.0;   ///< standard deviation of an error drawn once for the recording
  double low = -std::numeric_limits<double>::infinity();  ///< where the output stops
  double high = std::numeric_limits<double>::infinity();
  double quantum = 0.0;  ///< step of the output
};

/// A quantity that a sensor reads.
struct Measured {
  std::string name;  ///< ends in its unit: "pressure_pa"
  std::string unit;
  ReadingErrors errors;
  std::function<double(std::size_t k)> exact;  ///< its true value at the truth's physics sample k
};

/// Adds to a recording that holds the body's truth a series of `quantities`: the mean of each over each window, a bias,
/// white noise, the range, the quantum, stamps and losses (imu/time_stamps.hpp) by kSeriesParameters. With every error
/// 0 a reading is the true mean, bit for bit. A lost sample is lost from the truth too. Throws InvalidSituation when
/// the output period is no whole number of physics steps. What it does not model: errors that follow temperature,
/// bandwidth other than the window's, drift.
/// `constants`: numbers of the sensor that whoever reads it is told.
void simulate_series(const SensorContext& context, const std::vector<Measured>& quantities,
                     const std::vector<std::string>& constants, Recording& recording);

}  // namespace tumble::sim
