// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_parameters.hpp"

#include <array>
#include <sstream>

#include "sim/imu/elements.hpp"

namespace tumble::sim {

namespace {

constexpr std::string_view kClampDoc =
    "rail kind clamp: level at which the output stops, at or above the stated range; 0: no saturation";
constexpr std::string_view kAxisSpreadDoc =
    "rail kind plateau: standard deviation of the level between axes and signs, truncated at 3 of them; 0: off";
constexpr std::string_view kEventSpreadDoc =
    "rail kind plateau: standard deviation of the level between clipping events, truncated at 3 of them; 0: off";
constexpr std::string_view kWrapDoc =
    "rail kind wrap: 1: a reading beyond the level changes its sign, as when a 16-bit word overflows";
constexpr std::string_view kRecoveryDoc =
    "rail kind slow_recovery: time constant of the offset that clipping leaves; 0: off";
constexpr std::string_view kRecoveryShareDoc =
    "rail kind slow_recovery: largest offset that clipping leaves, as a share of the level";
constexpr std::string_view kElementMisalignmentDoc =
    "axes of the sensing elements, along which they clip: standard deviation of each off-diagonal entry of their "
    "matrix, truncated at 3 of them; the device inverts the matrix after saturation; 0: upright";
constexpr std::string_view kElementScaleDoc =
    "scale of the sensing elements: standard deviation of each diagonal entry of their matrix about 1, truncated at 3 "
    "of them";
constexpr std::string_view kElementOffsetDoc =
    "zero offset of the sensing elements, subtracted after saturation, so that the two signs clip at different "
    "readings: standard deviation, truncated at 3 of them";
constexpr std::string_view kInRunDoc =
    "in-run instability: floor of the Allan deviation (a bounded process, flicker over three decades)";
constexpr std::string_view kInRunTimeDoc =
    "longest correlation time of the in-run instability; its Allan deviation is flat from 1/200 to 1/2 of it";
constexpr std::string_view kWalkDoc = "random walk of the bias: standard deviation after one second";
constexpr std::string_view kTurnOnDoc = "standard deviation of the turn-on bias";
constexpr std::string_view kScaleDoc = "standard deviation of each axis's scale error";
constexpr std::string_view kMisalignmentDoc = "standard deviation of each cross-axis angle";
constexpr std::string_view kNoiseDoc = "density of the white noise; a sample at rate f has density * sqrt(f)";
constexpr std::string_view kBandwidthDoc = "-3 dB of the analogue low-pass, second order; 0: off";
constexpr std::string_view kQuantumDoc = "resolution of the converter, before digital low-pass and mean; 0: off";
constexpr std::string_view kWindowDoc =
    "window of the plain mean that forms a reading, rounded to physics steps; 0: the device integrates between outputs "
    "or between readings of its own rate";
constexpr std::string_view kUpdateDoc =
    "sample and hold: the device's own readings per second, not synchronous with the outputs, which repeat the last "
    "reading; 0: one reading per output; else at least 0.1";
constexpr std::string_view kHandoverDoc =
    "range of the precise part of each axis (back below 0.9 of it); the coarse part is used beyond; 0: always coarse";
constexpr std::string_view kPreciseNoiseDoc = "density of the white noise of the precise part";
constexpr std::string_view kStartDelayDoc =
    "time before the first reading, for a device that starts after the recording; 0: off";
constexpr std::string_view kPreciseQuantumDoc = "resolution of the precise part; 0: off";

constexpr std::array kParameters = {
    Parameter{"output_rate_hz", 100.0, 1.0, 8000.0, "Hz",
              "samples per second; must divide the physics rate of 2000 Hz or be a multiple of it; readings within one "
              "physics step then differ only by noise"},
    Parameter{"gyro_range_rad_s", 34.9, 0.1, 1000.0, "rad/s", "range stated by the data sheet"},
    Parameter{"gyro_rail_rad_s", 0.0, 0.0, 1000.0, "rad/s", kClampDoc},
    Parameter{"gyro_plateau_axis_spread_rad_s", 0.0, 0.0, 100.0, "rad/s", kAxisSpreadDoc},
    Parameter{"gyro_plateau_event_spread_rad_s", 0.0, 0.0, 100.0, "rad/s", kEventSpreadDoc},
    Parameter{"gyro_wrap", 0.0, 0.0, 1.0, "1", kWrapDoc},
    Parameter{"gyro_slow_recovery_s", 0.0, 0.0, 100.0, "s", kRecoveryDoc},
    Parameter{"gyro_slow_recovery_share", 0.0, 0.0, 1.0, "1", kRecoveryShareDoc},
    Parameter{"gyro_element_misalignment", 0.0, 0.0, Elements::kMostMisalignment, "1", kElementMisalignmentDoc},
    Parameter{"gyro_element_scale", 0.0, 0.0, Elements::kMostMisalignment, "1", kElementScaleDoc},
    Parameter{"gyro_element_offset_rad_s", 0.0, 0.0, 100.0, "rad/s", kElementOffsetDoc},
    Parameter{"gyro_noise_rad_s_sqrt_hz", 0.0, 0.0, 1.0, "rad/s/sqrt(Hz)", kNoiseDoc},
    Parameter{"gyro_bandwidth_hz", 0.0, 0.0, 900.0, "Hz", kBandwidthDoc},
    Parameter{"gyro_delay_s", 0.0, 0.0, 0.1, "s", "delay of the gyroscope's signal; 0: off"},
    Parameter{"gyro_bias_turn_on_rad_s", 0.0, 0.0, 1.0, "rad/s", kTurnOnDoc},
    Parameter{"gyro_bias_in_run_rad_s", 0.0, 0.0, 1.0, "rad/s", kInRunDoc},
    Parameter{"gyro_bias_in_run_s", 1000.0, 0.1, 1e5, "s", kInRunTimeDoc},
    Parameter{"gyro_bias_walk_rad_s_sqrt_s", 0.0, 0.0, 1.0, "rad/s/sqrt(s)", kWalkDoc},
    Parameter{"gyro_scale_error", 0.0, 0.0, 0.2, "1", kScaleDoc},
    Parameter{"gyro_misalignment_rad", 0.0, 0.0, 0.2, "rad", kMisalignmentDoc},
    Parameter{"gyro_g_sensitivity_s_m", 0.0, 0.0, 0.01, "rad/s/(m/s^2)",
              "false rate per specific force along the same axis"},
    Parameter{
        "gyro_g_sensitivity_spread_s_m", 0.0, 0.0, 0.01, "rad/s/(m/s^2)",
        "standard deviation of each of the nine entries of the additional matrix of false rate per specific force"},
    Parameter{"gyro_window_s", 0.0, 0.0, 0.1, "s", kWindowDoc},
    Parameter{"gyro_update_hz", 0.0, 0.0, 8000.0, "Hz", kUpdateDoc},
    Parameter{"gyro_quantum_rad_s", 0.0, 0.0, 1.0, "rad/s", kQuantumDoc},
    Parameter{"gyro_handover_rad_s", 0.0, 0.0, 1000.0, "rad/s", kHandoverDoc},
    Parameter{"gyro_precise_noise_rad_s_sqrt_hz", 0.0, 0.0, 1.0, "rad/s/sqrt(Hz)", kPreciseNoiseDoc},
    Parameter{"gyro_precise_quantum_rad_s", 0.0, 0.0, 1.0, "rad/s", kPreciseQuantumDoc},
    Parameter{"accel_range_m_s2", 156.9, 1.0, 1e5, "m/s^2", "range stated by the data sheet"},
    Parameter{"accel_rail_m_s2", 0.0, 0.0, 1e5, "m/s^2", kClampDoc},
    Parameter{"accel_plateau_axis_spread_m_s2", 0.0, 0.0, 1000.0, "m/s^2", kAxisSpreadDoc},
    Parameter{"accel_plateau_event_spread_m_s2", 0.0, 0.0, 1000.0, "m/s^2", kEventSpreadDoc},
    Parameter{"accel_wrap", 0.0, 0.0, 1.0, "1", kWrapDoc},
    Parameter{"accel_slow_recovery_s", 0.0, 0.0, 100.0, "s", kRecoveryDoc},
    Parameter{"accel_slow_recovery_share", 0.0, 0.0, 1.0, "1", kRecoveryShareDoc},
    Parameter{"accel_element_misalignment", 0.0, 0.0, Elements::kMostMisalignment, "1", kElementMisalignmentDoc},
    Parameter{"accel_element_scale", 0.0, 0.0, Elements::kMostMisalignment, "1", kElementScaleDoc},
    Parameter{"accel_element_offset_m_s2", 0.0, 0.0, 1000.0, "m/s^2", kElementOffsetDoc},
    Parameter{"accel_noise_m_s2_sqrt_hz", 0.0, 0.0, 1.0, "m/s^2/sqrt(Hz)", kNoiseDoc},
    Parameter{"accel_bandwidth_hz", 0.0, 0.0, 900.0, "Hz", kBandwidthDoc},
    Parameter{"accel_delay_s", 0.0, 0.0, 0.1, "s", "delay of the accelerometer's signal; 0: off"},
    Parameter{"accel_bias_turn_on_m_s2", 0.0, 0.0, 10.0, "m/s^2", kTurnOnDoc},
    Parameter{"accel_bias_in_run_m_s2", 0.0, 0.0, 10.0, "m/s^2", kInRunDoc},
    Parameter{"accel_bias_in_run_s", 1000.0, 0.1, 1e5, "s", kInRunTimeDoc},
    Parameter{"accel_bias_walk_m_s2_sqrt_s", 0.0, 0.0, 10.0, "m/s^2/sqrt(s)", kWalkDoc},
    Parameter{"accel_scale_error", 0.0, 0.0, 0.2, "1", kScaleDoc},
    Parameter{"accel_misalignment_rad", 0.0, 0.0, 0.2, "rad", kMisalignmentDoc},
    Parameter{"accel_window_s", 0.0, 0.0, 0.1, "s", kWindowDoc},
    Parameter{"accel_update_hz", 0.0, 0.0, 8000.0, "Hz", kUpdateDoc},
    Parameter{"accel_quantum_m_s2", 0.0, 0.0, 10.0, "m/s^2", kQuantumDoc},
    Parameter{"accel_handover_m_s2", 0.0, 0.0, 1e5, "m/s^2", kHandoverDoc},
    Parameter{"accel_precise_noise_m_s2_sqrt_hz", 0.0, 0.0, 1.0, "m/s^2/sqrt(Hz)", kPreciseNoiseDoc},
    Parameter{"accel_precise_quantum_m_s2", 0.0, 0.0, 10.0, "m/s^2", kPreciseQuantumDoc},
    Parameter{"digital_bandwidth_hz", 0.0, 0.0, 900.0, "Hz",
              "-3 dB of the low-pass after sampling, second order; 0: only the mean over the output window"},
    Parameter{"clip_after_low_pass", 0.0, 0.0, 1.0, "1",
              "0: saturation acts before digital low-pass and mean; 1: after them"},
    Parameter{"clip_flags", 0.0, 0.0, 1.0, "1", "1: the device flags axes that saturated"},
    Parameter{"time_offset_s", 0.0, -0.1, 0.1, "s", "time stamp minus true end of the window"},
    Parameter{"time_jitter_s", 0.0, 0.0, 0.1, "s",
              "standard deviation of the time stamp, truncated at 3 of them; below a sixth of the period; 0: off"},
    Parameter{"dropout_share", 0.0, 0.0, 0.5, "1", "share of lost samples; 0: off"},
    Parameter{"dropout_mean_samples", 1.0, 1.0, 1e4, "1", "mean length of a run of lost samples"},
    Parameter{"start_delay_s", 0.0, 0.0, 60.0, "s", kStartDelayDoc},
    Parameter{
        "glitch_share", 0.0, 0.0, 0.5, "1",
        "share of samples in which one axis has a wild reading, uniform within 1.5 times the stated range; 0: off"},
    Parameter{"magnetometer", 0.0, 0.0, 1.0, "1", "1: the magnetic field is recorded with every sample"},
    Parameter{"mag_range_t", 1e-3, 1e-6, 1.0, "T", "range stated by the data sheet"},
    Parameter{"mag_rail_t", 0.0, 0.0, 1.0, "T", "level at which the output stops; 0: no saturation"},
    Parameter{"mag_noise_t", 0.0, 0.0, 1e-3, "T", "standard deviation of each sample's white noise"},
    Parameter{"mag_hard_iron_t", 0.0, 0.0, 1e-3, "T", "standard deviation of the constant offset of each axis"},
    Parameter{"mag_scale_error", 0.0, 0.0, 0.5, "1", "soft iron: standard deviation of each axis's scale error"},
    Parameter{"mag_misalignment_rad", 0.0, 0.0, 0.5, "rad", "soft iron: standard deviation of each cross-axis angle"},
    Parameter{"mag_quantum_t", 0.0, 0.0, 1e-3, "T", "resolution of the output; 0: off"},
    Parameter{"earth_field_t", 4.9e-5, 0.0, 1e-3, "T", "strength of the Earth's field at the robot"},
    Parameter{"earth_inclination_rad", 1.14, -1.5708, 1.5708, "rad", "angle of the Earth's field below the horizon"},
    Parameter{"earth_north_rad", 0.0, -3.1416, 3.1416, "rad", "magnetic north, from the world's x axis towards y"},
    Parameter{"magnetic_sources", 0.0, 0.0, 100.0, "1",
              "number of dipoles that disturb the field near the path; 0: none"},
    Parameter{"magnetic_source_moment_a_m2", 5.0, 0.0, 1e4, "A m^2",
              "moment of a dipole, log-uniform within a factor of 3; 5: some kilograms of steel"},
    Parameter{"magnetic_source_nearest_m", 0.4, 0.05, 100.0, "m", "minimum distance of a dipole from the path"},
    Parameter{"magnetic_source_farthest_m", 1.5, 0.05, 100.0, "m",
              "maximum distance of a dipole from its random position of the path"},
};

constexpr double kSlowestUpdate_hz = 0.1;

/// Checks the saturation parameters of one triad.
void check_rail(const Values& values, const std::string& place, const std::string& prefix, const std::string& unit) {
  const std::string rail_name = prefix + "_rail_" + unit;
  const std::string axis_name = prefix + "_plateau_axis_spread_" + unit;
  const std::string event_name = prefix + "_plateau_event_spread_" + unit;
  const double rail = values.at(rail_name), spread = values.at(axis_name) + values.at(event_name);
  for (const std::string& name : {axis_name, event_name, prefix + "_wrap", prefix + "_slow_recovery_s"}) {
    if (rail > 0.0 || values.at(name) == 0.0) continue;
    throw InvalidSituation(place + "." + name + " needs a saturation level: " + rail_name + " is 0");
  }
  if (rail > 0.0 && 3.0 * spread >= rail) {
    std::ostringstream text;
    text << place << "." << axis_name << " and " << event_name << " are " << spread
         << " together, must be below a third of " << rail_name << ", which is " << rail;
    throw InvalidSituation(text.str());
  }
  const std::string offset_name = prefix + "_element_offset_" + unit;
  const double offset = values.at(offset_name);
  if (rail > 0.0 && offset > 0.0 && 3.0 * (spread + offset) >= rail) {
    std::ostringstream text;
    text << place << "." << offset_name << " and the plateau's spreads are " << spread + offset
         << " together, must be below a third of " << rail_name << ", which is " << rail;
    throw InvalidSituation(text.str());
  }
  if (values.at(prefix + "_wrap") > 0.5 && values.at(prefix + "_slow_recovery_s") > 0.0) {
    throw InvalidSituation(place + "." + prefix + "_slow_recovery_s must be 0 with " + prefix +
                           "_wrap: an overflowing word has no slow recovery");
  }
}

/// Checks the update rate. Readings between two updates are buffered, so a very low update rate would exhaust the
/// memory.
void check_update(const Values& values, const std::string& place, const std::string& prefix) {
  const std::string name = prefix + "_update_hz";
  const double update_hz = values.at(name);
  if (update_hz == 0.0 || update_hz >= kSlowestUpdate_hz) return;
  std::ostringstream text;
  text << place << "." << name << " is " << update_hz << " Hz, must be 0 (off) or at least " << kSlowestUpdate_hz;
  throw InvalidSituation(text.str());
}

}  // namespace

std::span<const Parameter> imu_parameters() {
  return kParameters;
}

void check_imu_values(const Values& values, const std::string& place) {
  check_rail(values, place, "gyro", "rad_s");
  check_rail(values, place, "accel", "m_s2");
  check_update(values, place, "gyro");
  check_update(values, place, "accel");
  if (values.at("magnetic_source_farthest_m") < values.at("magnetic_source_nearest_m")) {
    throw InvalidSituation(place + ".magnetic_source_farthest_m must be at least magnetic_source_nearest_m");
  }
}

}  // namespace tumble::sim
