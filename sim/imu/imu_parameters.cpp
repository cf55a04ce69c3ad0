// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/imu_parameters.hpp"

#include <array>
#include <sstream>

#include "sim/imu/elements.hpp"

namespace tumble::sim {

namespace {

constexpr std::string_view kClampDoc =
    "saturation level: the output stops at this value, which is at or above the stated range; 0: no saturation";
constexpr std::string_view kAxisSpreadDoc =
    "standard deviation of the saturation level between axes and signs, truncated at 3 sigma; 0: equal levels";
constexpr std::string_view kEventSpreadDoc =
    "standard deviation of the saturation level between clipping events, truncated at 3 sigma; 0: constant level";
constexpr std::string_view kWrapDoc =
    "1: a reading beyond the saturation level changes its sign, as when a 16-bit word overflows; 0: off";
constexpr std::string_view kRecoveryDoc =
    "time constant with which the offset after clipping decays (slow recovery); 0: off";
constexpr std::string_view kRecoveryShareDoc =
    "maximum offset after clipping (slow recovery), as a share of the saturation level";
constexpr std::string_view kElementMisalignmentDoc =
    "misalignment of the sensing elements before compensation: standard deviation of each off-diagonal entry of their "
    "matrix, truncated at 3 sigma; 0: upright saturation limits";
constexpr std::string_view kElementScaleDoc =
    "scale error of the sensing elements before compensation: standard deviation of each diagonal entry of their "
    "matrix, truncated at 3 sigma";
constexpr std::string_view kElementOffsetDoc =
    "standard deviation of the zero offset of the sensing elements, truncated at 3 sigma; the device subtracts the "
    "offset after saturation, so positive and negative readings clip at different values";
constexpr std::string_view kInRunDoc =
    "in-run instability of the bias: flat part of the Allan deviation (flicker noise over three decades)";
constexpr std::string_view kInRunTimeDoc =
    "longest correlation time of the in-run instability; the Allan deviation is flat from 1/200 to 1/2 of this time";
constexpr std::string_view kWalkDoc = "random walk of the bias: standard deviation after one second";
constexpr std::string_view kTurnOnDoc = "standard deviation of the turn-on bias";
constexpr std::string_view kScaleDoc = "standard deviation of each axis's scale error";
constexpr std::string_view kMisalignmentDoc = "standard deviation of each cross-axis angle";
constexpr std::string_view kNoiseDoc =
    "density of the white noise; at sample rate f, the standard deviation of a sample is density * sqrt(f)";
constexpr std::string_view kBandwidthDoc = "cut-off frequency (-3 dB) of the analogue second-order low-pass; 0: off";
constexpr std::string_view kQuantumDoc =
    "resolution of the analogue-to-digital converter, which acts before digital low-pass and averaging; 0: off";
constexpr std::string_view kWindowDoc =
    "averaging window of a reading, rounded to physics steps; 0: the window is the time between two readings";
constexpr std::string_view kUpdateDoc =
    "sample and hold: the device takes this many readings per second, and each output repeats the last reading; 0: one "
    "reading per output; otherwise at least 0.1";
constexpr std::string_view kHandoverDoc =
    "value above which an axis switches from its precise sensor to its coarse sensor; the axis switches back below 0.9 "
    "of this value; 0: always coarse";
constexpr std::string_view kPreciseNoiseDoc = "density of the white noise of the precise sensor";
constexpr std::string_view kStartDelayDoc =
    "time from the start of the recording to the first reading of the device; 0: the device starts with the recording";
constexpr std::string_view kPreciseQuantumDoc = "resolution of the precise sensor; 0: off";

constexpr std::array kParameters = {
    Parameter{"output_rate_hz", 100.0, 1.0, 8000.0, "Hz",
              "samples per second; must divide the physics rate of 2000 Hz or be a multiple of it; above 2000 Hz, "
              "readings within one physics step differ only by noise"},
    Parameter{"gyro_range_rad_s", 34.9, 0.1, 1000.0, "rad/s", "range stated by the data sheet"},
    Parameter{"gyro_rail_rad_s", 0.0, 0.0, 1000.0, "rad/s", kClampDoc},
    Parameter{"gyro_plateau_axis_spread_rad_s", 0.0, 0.0, 100.0, "rad/s", kAxisSpreadDoc},
    Parameter{"gyro_plateau_event_spread_rad_s", 0.0, 0.0, 100.0, "rad/s", kEventSpreadDoc},
    Parameter{"gyro_wrap", 0.0, 0.0, 1.0, "1", kWrapDoc},
    Parameter{"gyro_slow_recovery_s", 0.0, 0.0, 100.0, "s", kRecoveryDoc},
    Parameter{"gyro_slow_recovery_share", 0.0, 0.0, 1.0, "1", kRecoveryShareDoc},
    Parameter{"gyro_element_misalignment", 0.0, 0.0, Elements::kMisalignmentMax, "1", kElementMisalignmentDoc},
    Parameter{"gyro_element_scale", 0.0, 0.0, Elements::kMisalignmentMax, "1", kElementScaleDoc},
    Parameter{"gyro_element_offset_rad_s", 0.0, 0.0, 100.0, "rad/s", kElementOffsetDoc},
    Parameter{"gyro_noise_rad_s_sqrt_hz", 0.0, 0.0, 1.0, "rad/s/sqrt(Hz)", kNoiseDoc},
    Parameter{"gyro_bandwidth_hz", 0.0, 0.0, 900.0, "Hz", kBandwidthDoc},
    Parameter{"gyro_delay_s", 0.0, 0.0, 0.1, "s", "delay of the gyro's signal; 0: off"},
    Parameter{"gyro_bias_turn_on_rad_s", 0.0, 0.0, 1.0, "rad/s", kTurnOnDoc},
    Parameter{"gyro_bias_in_run_rad_s", 0.0, 0.0, 1.0, "rad/s", kInRunDoc},
    Parameter{"gyro_bias_in_run_s", 1000.0, 0.1, 1e5, "s", kInRunTimeDoc},
    Parameter{"gyro_bias_walk_rad_s_sqrt_s", 0.0, 0.0, 1.0, "rad/s/sqrt(s)", kWalkDoc},
    Parameter{"gyro_scale_error", 0.0, 0.0, 0.2, "1", kScaleDoc},
    Parameter{"gyro_misalignment_rad", 0.0, 0.0, 0.2, "rad", kMisalignmentDoc},
    Parameter{"gyro_g_sensitivity_s_m", 0.0, 0.0, 0.01, "rad/s/(m/s^2)",
              "g-sensitivity: rate error per specific force along the same axis"},
    Parameter{"gyro_g_sensitivity_spread_s_m", 0.0, 0.0, 0.01, "rad/s/(m/s^2)",
              "standard deviation of each of the nine entries of the additional g-sensitivity matrix (rate error per "
              "specific force)"},
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
    Parameter{"accel_element_misalignment", 0.0, 0.0, Elements::kMisalignmentMax, "1", kElementMisalignmentDoc},
    Parameter{"accel_element_scale", 0.0, 0.0, Elements::kMisalignmentMax, "1", kElementScaleDoc},
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
    Parameter{
        "digital_bandwidth_hz", 0.0, 0.0, 900.0, "Hz",
        "cut-off frequency (-3 dB) of the digital second-order low-pass; 0: only the mean over the averaging window"},
    Parameter{"clip_after_low_pass", 0.0, 0.0, 1.0, "1",
              "0: saturation acts before digital low-pass and averaging; 1: saturation acts after them"},
    Parameter{"clip_flags", 0.0, 0.0, 1.0, "1", "1: the device sets a flag for each saturated axis"},
    Parameter{"time_offset_s", 0.0, -0.1, 0.1, "s", "time stamp minus true end of the averaging window"},
    Parameter{"time_jitter_s", 0.0, 0.0, 0.1, "s",
              "standard deviation of the time stamp, truncated at 3 sigma; must be below a sixth of the sample period; "
              "0: off"},
    Parameter{"dropout_share", 0.0, 0.0, 0.5, "1", "share of lost samples; 0: off"},
    Parameter{"dropout_mean_samples", 1.0, 1.0, 1e4, "1", "mean number of samples that are lost in a row"},
    Parameter{"start_delay_s", 0.0, 0.0, 60.0, "s", kStartDelayDoc},
    Parameter{"glitch_share", 0.0, 0.0, 0.5, "1",
              "share of samples in which one axis has a wrong reading, drawn uniformly within 1.5 times the stated "
              "range; 0: off"},
    Parameter{"magnetometer", 0.0, 0.0, 1.0, "1", "1: each sample contains the magnetic field; 0: no magnetometer"},
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
              "number of magnetic dipoles that disturb the field near the path; 0: none"},
    Parameter{"magnetic_source_moment_a_m2", 5.0, 0.0, 1e4, "A m^2",
              "magnetic moment of a dipole, drawn log-uniformly within a factor of 3; 5 corresponds to some kilograms "
              "of steel"},
    Parameter{"magnetic_source_nearest_m", 0.4, 0.05, 100.0, "m", "minimum distance of a dipole from the path"},
    Parameter{"magnetic_source_farthest_m", 1.5, 0.05, 100.0, "m",
              "maximum distance of a dipole from its random point on the path"},
};

constexpr double kSlowestUpdate_hz = 0.1;

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
         << " together; they must be below a third of " << rail_name << ", which is " << rail;
    throw InvalidSituation(text.str());
  }
  const std::string offset_name = prefix + "_element_offset_" + unit;
  const double offset = values.at(offset_name);
  if (rail > 0.0 && offset > 0.0 && 3.0 * (spread + offset) >= rail) {
    std::ostringstream text;
    text << place << "." << offset_name << " and the spreads of the saturation level are " << spread + offset
         << " together; they must be below a third of " << rail_name << ", which is " << rail;
    throw InvalidSituation(text.str());
  }
  if (values.at(prefix + "_wrap") > 0.5 && values.at(prefix + "_slow_recovery_s") > 0.0) {
    throw InvalidSituation(place + "." + prefix + "_slow_recovery_s must be 0 with " + prefix +
                           "_wrap, because a word that overflows has no slow recovery");
  }
}

/// Limits the update rate of a sensor from below, because the simulation stores all physics steps between two updates
/// in memory.
void check_update(const Values& values, const std::string& place, const std::string& prefix) {
  const std::string name = prefix + "_update_hz";
  const double update_hz = values.at(name);
  if (update_hz == 0.0 || update_hz >= kSlowestUpdate_hz) return;
  std::ostringstream text;
  text << place << "." << name << " is " << update_hz << " Hz; it must be 0 (off) or at least " << kSlowestUpdate_hz;
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
