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

inline constexpr std::array kSeriesParameters = {
    Parameter{"output_rate_hz", 50.0, 0.1, 2000.0, "Hz",
              "samples per second; must divide the physics rate of 2000 Hz; each sample is the mean since the previous "
              "sample"},
    Parameter{"time_offset_s", 0.0, -0.1, 0.1, "s", "time stamp minus true end of the averaging window"},
    Parameter{"time_jitter_s", 0.0, 0.0, 0.1, "s",
              "standard deviation of the time stamp, truncated at 3 sigma; must be below a sixth of the sample period; "
              "0: off"},
    Parameter{"dropout_share", 0.0, 0.0, 0.5, "1", "share of lost samples; 0: off"},
    Parameter{"dropout_mean_samples", 1.0, 1.0, 1e4, "1", "mean number of samples that are lost in a row"},
    Parameter{"start_delay_s", 0.0, 0.0, 60.0, "s",
              "time from the start of the recording to the first reading of the device; 0: the device starts with the "
              "recording"},
};

/// ReadingErrors contains the sizes of the errors of a reading. The errors are relative to the true mean over the
/// averaging window. A size of 0 switches an error off.
struct ReadingErrors {
  double noise = 0.0;
  /// standard deviation of an error that is constant over a recording
  double bias = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double quantum = 0.0;
};

struct Measured {
  std::string name;  ///< ends in its unit: "pressure_pa"
  std::string unit;
  ReadingErrors errors;
  std::function<double(std::size_t k)> exact;  ///< true value at physics sample k
};

/// Simulates a sensor with scalar readings. The simulation includes the mean over an averaging window, bias, white
/// noise, range limits, quantisation, time stamps and lost samples. A lost sample is also missing in the truth. Throws
/// InvalidSituation if the output period is not a whole number of physics steps. The simulation does not include
/// temperature errors, drift, or other low-pass filters.
void simulate_series(const SensorContext& context, const std::vector<Measured>& quantities,
                     const std::vector<std::string>& constants, Recording& recording);

}  // namespace tumble::sim
