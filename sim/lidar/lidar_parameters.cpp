// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/lidar_parameters.hpp"

#include <array>

namespace tumble::sim {

namespace {

constexpr double kRightAngle_rad = 1.5707963267948966;
constexpr double kDegree_rad = kRightAngle_rad / 90.0;

constexpr Parameter elevation(std::string_view name, double value_rad) {
  return {name,
          value_rad,
          -kRightAngle_rad,
          kRightAngle_rad,
          "rad",
          "elevation of this channel; channels are numbered in firing order"};
}

constexpr Parameter kRangeNoise{
    "range_noise_m", 0.02, 0.0, 10.0, "m", "standard deviation of a range, independent from point to point; 0: off"};
constexpr Parameter kReferenceReflectivity{"detection_reflectivity",
                                           0.2,
                                           0.001,
                                           1.0,
                                           "1",
                                           "diffuse reflectivity of the surface for which detection_range_m is stated"};
constexpr Parameter kSteepness{"detection_steepness",
                               4.0,
                               0.1,
                               100.0,
                               "1",
                               "exponent k of the detection probability s^k / (1 + s^k), with the signal s = "
                               "(reflectivity cos(incidence) / detection_reflectivity) (detection_range_m / range)^2"};
constexpr Parameter kDropout{
    "dropout_share", 0.0, 0.0, 1.0, "1", "share of returns that are lost independently of their signal"};
constexpr Parameter kSweepDropout{"sweep_dropout_share", 0.0, 0.0, 0.9, "1", "share of lost sweeps; 0: off"};
constexpr Parameter kStartDelay{
    "start_delay_s",
    0.0,
    0.0,
    60.0,
    "s",
    "time from the start of the recording to the first sweep; 0: the lidar starts with the recording"};
constexpr Parameter kIntensityQuantum{
    "intensity_quantum", 1.0 / 255.0, 0.0, 1.0, "1", "resolution of the reported intensity; 0: off"};
constexpr Parameter kBeamRays{
    "beam_rays", 1.0, 1.0,
    16.0,        "1", "number of rays that sample the width of a beam; 1: one ray along the axis of the beam"};
constexpr Parameter kEchoLength{"echo_length_m",
                                0.75,
                                0.0,
                                100.0,
                                "m",
                                "with beam_rays above 1: echoes whose ranges differ by less than this value merge into "
                                "one mixed return; 0.75 m corresponds to a pulse of 5 ns (assumed)"};

constexpr Parameter kSpinRate{"spin_rate_hz", 10.0, 1.0, 50.0, "Hz", "rotations per second; one rotation is one sweep"};
constexpr Parameter kClockwise{"clockwise", 1.0, 0.0,
                               1.0,         "1", "1: the lidar rotates from x towards -y; 0: from x towards +y"};

constexpr Parameter range_min(double value_m) {
  return {"range_min_m", value_m, 0.0, 100.0, "m", "minimum range; nearer returns are lost"};
}

constexpr Parameter range_max(double value_m) {
  return {"range_max_m", value_m, 0.1, 10000.0, "m", "maximum range; farther returns are lost"};
}

constexpr Parameter range_quantum(double value_m) {
  return {"range_quantum_m", value_m, 0.0, 1.0, "m", "resolution of the reported range; 0: off"};
}

constexpr Parameter detection_range(double value_m) {
  return {"detection_range_m",
          value_m,
          0.0,
          10000.0,
          "m",
          "range at which half of the returns from a surface of detection_reflectivity at normal incidence are lost; "
          "0: no loss by range"};
}

constexpr Parameter divergence(std::string_view name, double value_rad) {
  return {name, value_rad, 0.0, 0.1, "rad", "full opening angle of the beam in this direction of the lidar axes"};
}

constexpr Parameter kCage{
    "sees_own_cage", 1.0, 0.0, 1.0, "1", "1: the robot's own struts give returns; 0: beams pass through the struts"};

constexpr std::array kSpinning = {
    kSpinRate,
    kClockwise,
    Parameter{"firing_period_s", 3e-6, 1e-7, 1e-3, "s", "time between the firings of two channels of a sequence"},
    Parameter{"sequence_period_s", 50e-6, 2e-6, 1e-2, "s", "time between two sequences of all channels"},
    Parameter{"current_driver_timing", 0.0, 0.0, 1.0, "1",
              "1: use the timing of the vendor's current rs_driver for the RS-16 (channels 2.8 us, sequences 55.5 us) "
              "instead of firing_period_s and sequence_period_s; 0: off"},
    elevation("elevation_01_rad", -0.262371856),
    elevation("elevation_02_rad", -0.227077808),
    elevation("elevation_03_rad", -0.192403351),
    elevation("elevation_04_rad", -0.157254166),
    elevation("elevation_05_rad", -0.122323146),
    elevation("elevation_06_rad", -0.087711522),
    elevation("elevation_07_rad", -0.052888712),
    elevation("elevation_08_rad", -0.017935003),
    elevation("elevation_09_rad", 0.261555042),
    elevation("elevation_10_rad", 0.226840443),
    elevation("elevation_11_rad", 0.191560357),
    elevation("elevation_12_rad", 0.157009820),
    elevation("elevation_13_rad", 0.122077055),
    elevation("elevation_14_rad", 0.086844093),
    elevation("elevation_15_rad", 0.052016048),
    elevation("elevation_16_rad", 0.017060593),
    Parameter{"mirror_radius_m", 0.04638, 0.0, 1.0, "m", "R1: distance of the beams' origin from the rotation axis"},
    Parameter{"mirror_drop_m", 0.010875, -1.0, 1.0, "m",
              "R2: distance of the beams' origin below the origin of the lidar axes"},
    range_min(0.2),
    range_max(150.0),
    kRangeNoise,
    range_quantum(0.005),
    detection_range(150.0),
    kReferenceReflectivity,
    kSteepness,
    kDropout,
    kSweepDropout,
    kStartDelay,
    kIntensityQuantum,
    kBeamRays,
    divergence("divergence_horizontal_rad", 3.0e-3),
    divergence("divergence_vertical_rad", 1.2e-3),
    kEchoLength,
    kCage,
    Parameter{"driver_stamp_fault", 0.0, 0.0, 1.0, "1",
              "1: time stamps have the error of the published rig's driver: within a packet of 24 sequences, time "
              "passes at half the true rate; 0: correct time stamps"},
};

// The default values describe the Ouster OS1 lidar with 64 rings.
constexpr std::array kColumn = {
    kSpinRate,
    kClockwise,
    Parameter{"rings", 64.0, 16.0, 128.0, "1", "number of rings, a multiple of 16"},
    Parameter{"elevation_low_rad", -22.5 * kDegree_rad, -kRightAngle_rad, kRightAngle_rad, "rad",
              "elevation of the lowest ring"},
    Parameter{"elevation_high_rad", 22.5 * kDegree_rad, -kRightAngle_rad, kRightAngle_rad, "rad",
              "elevation of the highest ring"},
    Parameter{"elevation_shift_share", 0.0, 0.0, 1.0, "1",
              "share of the ring spacing by which all elevations rise from sweep to sweep, modulo one spacing; 0: off"},
    Parameter{"column_period_s", 97.65625e-6, 2e-6, 1e-2, "s",
              "time between two columns; banks of 16 rings are distributed evenly over the period"},
    Parameter{"firing_period_s", 0.0, 0.0, 1e-3, "s", "time between two rings of a bank"},
    range_min(0.5),
    range_max(120.0),
    kRangeNoise,
    range_quantum(0.001),
    detection_range(90.0),
    kReferenceReflectivity,
    kSteepness,
    kDropout,
    kSweepDropout,
    kStartDelay,
    kIntensityQuantum,
    kBeamRays,
    divergence("divergence_horizontal_rad", 3.2e-3),
    divergence("divergence_vertical_rad", 3.2e-3),
    kEchoLength,
    kCage,
};

constexpr std::array kRosette = {
    Parameter{"units", 3.0, 1.0, 3.0, "1", "number of scanning units side by side"},
    Parameter{"unit_spacing_rad", 0.5235987755982988, 0.0, 1.6, "rad", "yaw between neighbouring units"},
    Parameter{"point_period_s", 10e-6, 1e-7, 1e-3, "s", "time between two points of a unit"},
    Parameter{"sweep_period_s", 0.1, 1e-3, 10.0, "s", "duration of the sweeps into which points are grouped"},
    Parameter{"prism_1_rate_hz", 7294.0 / 60.0, -1000.0, 1000.0, "Hz", "rotations per second of the first prism"},
    Parameter{"prism_2_rate_hz", -4664.0 / 60.0, -1000.0, 1000.0, "Hz", "rotations per second of the second prism"},
    Parameter{"prism_1_amplitude", 0.1713, 0.0, 1.0, "1",
              "tangent of the angle by which the first prism deflects the beam"},
    Parameter{"prism_2_amplitude", 0.1744, 0.0, 1.0, "1",
              "tangent of the angle by which the second prism deflects the beam"},
    Parameter{"mixed_amplitude", 0.0022, 0.0, 1.0, "1",
              "tangent of the additional deflection at twice the rate of the first prism minus the rate of the second; "
              "0: off"},
    range_min(1.0),
    range_max(260.0),
    kRangeNoise,
    range_quantum(0.001),
    detection_range(130.0),
    kReferenceReflectivity,
    kSteepness,
    kDropout,
    kSweepDropout,
    kStartDelay,
    kIntensityQuantum,
    kBeamRays,
    divergence("divergence_horizontal_rad", 0.03 * kDegree_rad),
    divergence("divergence_vertical_rad", 0.28 * kDegree_rad),
    kEchoLength,
    Parameter{"sees_own_cage", 0.0, 0.0, 1.0, "1",
              "1: the robot's own struts give returns; 0: beams pass through the struts, as through the shell around "
              "the sphere's lidar"},
};

}  // namespace

std::span<const Parameter> spinning_lidar_parameters() {
  return kSpinning;
}

std::span<const Parameter> column_lidar_parameters() {
  return kColumn;
}

std::span<const Parameter> rosette_lidar_parameters() {
  return kRosette;
}

}  // namespace tumble::sim
