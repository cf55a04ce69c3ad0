// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "sim/imu/imu_simulation.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kParameters = {
    Parameter{"output_rate_hz", 100.0, 1.0, 2000.0, "Hz",
              "samples per second; must divide the physics rate of 2000 Hz"},
    Parameter{"gyro_range_rad_s", 34.9, 0.1, 1000.0, "rad/s", "range that the data sheet states"},
    Parameter{"gyro_rail_rad_s", 0.0, 0.0, 1000.0, "rad/s", "where the output really stops; 0: nowhere"},
    Parameter{"gyro_noise_rad_s_sqrt_hz", 0.0, 0.0, 1.0, "rad/s/sqrt(Hz)",
              "density of the white noise; a sample at rate f has density * sqrt(f)"},
    Parameter{"gyro_bandwidth_hz", 0.0, 0.0, 900.0, "Hz", "-3 dB of the analogue low-pass, second order; 0: off"},
    Parameter{"gyro_bias_turn_on_rad_s", 0.0, 0.0, 1.0, "rad/s",
              "standard deviation of the bias from switch-on to switch-on"},
    Parameter{"gyro_bias_in_run_rad_s", 0.0, 0.0, 1.0, "rad/s",
              "standard deviation of the in-run instability (Gauss-Markov)"},
    Parameter{"gyro_bias_in_run_s", 100.0, 0.1, 1e5, "s", "correlation time of the in-run instability"},
    Parameter{"gyro_bias_walk_rad_s_sqrt_s", 0.0, 0.0, 1.0, "rad/s/sqrt(s)",
              "random walk of the bias: standard deviation after one second"},
    Parameter{"gyro_scale_error", 0.0, 0.0, 0.2, "1", "standard deviation of each axis's scale error"},
    Parameter{"gyro_misalignment_rad", 0.0, 0.0, 0.2, "rad", "standard deviation of each cross-axis angle"},
    Parameter{"gyro_g_sensitivity_s_m", 0.0, 0.0, 0.01, "rad/s/(m/s^2)",
              "rate per specific force, each axis on itself"},
    Parameter{"gyro_quantum_rad_s", 0.0, 0.0, 1.0, "rad/s", "step of the output; 0: off"},
    Parameter{"accel_range_m_s2", 156.9, 1.0, 1e5, "m/s^2", "range that the data sheet states"},
    Parameter{"accel_rail_m_s2", 0.0, 0.0, 1e5, "m/s^2", "where the output really stops; 0: nowhere"},
    Parameter{"accel_noise_m_s2_sqrt_hz", 0.0, 0.0, 1.0, "m/s^2/sqrt(Hz)", "density of the white noise"},
    Parameter{"accel_bandwidth_hz", 0.0, 0.0, 900.0, "Hz", "-3 dB of the analogue low-pass, second order; 0: off"},
    Parameter{"accel_bias_turn_on_m_s2", 0.0, 0.0, 10.0, "m/s^2",
              "standard deviation of the bias from switch-on to switch-on"},
    Parameter{"accel_bias_in_run_m_s2", 0.0, 0.0, 10.0, "m/s^2",
              "standard deviation of the in-run instability (Gauss-Markov)"},
    Parameter{"accel_bias_in_run_s", 100.0, 0.1, 1e5, "s", "correlation time of the in-run instability"},
    Parameter{"accel_bias_walk_m_s2_sqrt_s", 0.0, 0.0, 10.0, "m/s^2/sqrt(s)",
              "random walk of the bias: standard deviation after one second"},
    Parameter{"accel_scale_error", 0.0, 0.0, 0.2, "1", "standard deviation of each axis's scale error"},
    Parameter{"accel_misalignment_rad", 0.0, 0.0, 0.2, "rad", "standard deviation of each cross-axis angle"},
    Parameter{"accel_quantum_m_s2", 0.0, 0.0, 10.0, "m/s^2", "step of the output; 0: off"},
    Parameter{"digital_bandwidth_hz", 0.0, 0.0, 900.0, "Hz",
              "-3 dB of the low-pass after sampling, second order; 0: the mean over the output window alone"},
    Parameter{"clip_after_low_pass", 0.0, 0.0, 1.0, "1",
              "0: the rail meets the signal before digital low-pass and mean; 1: after them"},
    Parameter{"clip_flags", 0.0, 0.0, 1.0, "1", "1: the device flags axes that met their rail"},
    Parameter{"time_offset_s", 0.0, -0.1, 0.1, "s", "stamp minus the true end of the window"},
};

}  // namespace

std::span<const Parameter> imu_parameters() {
  return kParameters;
}

}  // namespace tumble::sim
