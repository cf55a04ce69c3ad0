// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/complication.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <string_view>

#include "scenarios/draw/fixed_scenario.hpp"

namespace tumble::scenarios {

namespace {

struct Ideal {
  std::string_view number;
  double value = 0.0;
};

enum class Sort { several, size, count };

struct ComplicationLine {
  std::string_view what;
  std::vector<Ideal> numbers;
  Sort sort = Sort::several;
};

std::span<const ComplicationLine> of_world() {
  static const std::vector<ComplicationLine> kLines = {
      {"rocks", {{"rock_count"}}, Sort::count},
      {"trunks", {{"trunk_count"}}, Sort::count},
      {"pillars", {{"pillar_count"}}, Sort::count},
      {"boxes", {{"box_count"}}, Sort::count},
      {"shelves", {{"shelf_count"}}, Sort::count},
      {"beams", {{"beam_count"}}, Sort::count},
      {"all vertical drops except the first", {{"drop_count", 1.0}}, Sort::count},
      {"all stair steps except the first", {{"step_count", 1.0}}, Sort::count},
      {"relief", {{"relief_m"}}, Sort::size},
      {"bumps", {{"bump_height_m"}}, Sort::size},
      {"roughness of the ground", {{"roughness_m"}}, Sort::size},
      {"roughness of the walls", {{"wall_roughness_m"}}, Sort::size},
      {"bends", {{"bend_m"}}, Sort::size},
      {"slope of the ledges", {{"ledge_slope_rad"}}, Sort::size},
      {"buildings", {{"buildings"}}},
      {"patch 1", {{"patch_1_half_x_m"}, {"patch_1_half_y_m"}}},
      {"patch 2", {{"patch_2_half_x_m"}, {"patch_2_half_y_m"}}},
      {"patch 3", {{"patch_3_half_x_m"}, {"patch_3_half_y_m"}}},
      {"obstacle 1", {{"obstacle_1_kind"}}},
      {"obstacle 2", {{"obstacle_2_kind"}}},
      {"obstacle 3", {{"obstacle_3_kind"}}},
  };
  return kLines;
}

std::span<const ComplicationLine> of_robot() {
  static const std::vector<ComplicationLine> kLines = {
      {"offset of the centre of mass", {{"com_x_m"}, {"com_y_m"}, {"com_z_m"}}},
      {"offset of the internal mass", {{"inner_x_m"}, {"inner_y_m"}, {"inner_z_m"}}},
      {"differences between struts",
       {{"lower_contact_ratio", 1.0}, {"upper_contact_ratio", 1.0}, {"upright_contact_ratio", 1.0}}},
      {"unequal moments of inertia", {{"inertia_ratio_y", 1.0}, {"inertia_ratio_z", 1.0}, {"inertia_yaw_rad"}}},
      {"friction of the hinges", {{"hinge_damping_nm_s"}, {"hinge_friction_nm"}}},
  };
  return kLines;
}

std::span<const ComplicationLine> of_motion() {
  static const std::vector<ComplicationLine> kLines = {
      {"forward spin", {{"spin_forward_rad_s"}}, Sort::size},
      {"sideways spin", {{"spin_side_rad_s"}}, Sort::size},
      {"spin about the vertical axis", {{"spin_up_rad_s"}}, Sort::size},
      {"heading and travel direction", {{"yaw_rad"}, {"direction_rad"}, {"heading_rad"}}},
      {"grip of the hand", {{"roll_rad"}, {"pitch_rad"}}},
      {"sway", {{"sway_m"}, {"sway_rad"}, {"twist_rad"}}},
      {"tremor of the hand", {{"tremor_n"}, {"tremor_nm"}}},
      {"second leg of the path", {{"leg_2_m"}}, Sort::size},
      {"strokes of the hand", {{"stroke_share"}}, Sort::size},
      {"bursts of spin",
       {{"patch_1_spin_ratio", 1.0},
        {"patch_2_spin_ratio", 1.0},
        {"patch_3_spin_ratio", 1.0},
        {"patch_1_push_ratio", 1.0},
        {"patch_2_push_ratio", 1.0},
        {"patch_3_push_ratio", 1.0}}},
  };
  return kLines;
}

constexpr double kBeyondRates_rad_s = 100.0, kBeyondForces_m_s2 = 1000.0;

std::span<const ComplicationLine> of_imu() {
  static const std::vector<ComplicationLine> kLines = {
      {"rail of the gyro", {{"gyro_rail_rad_s"}, {"gyro_range_rad_s", kBeyondRates_rad_s}}},
      {"rail of the accelerometer", {{"accel_rail_m_s2"}, {"accel_range_m_s2", kBeyondForces_m_s2}}},
      {"misalignment, scale and offset of the sensing elements",
       {{"gyro_element_misalignment"},
        {"gyro_element_scale"},
        {"gyro_element_offset_rad_s"},
        {"accel_element_misalignment"},
        {"accel_element_scale"},
        {"accel_element_offset_m_s2"}}},
      {"unequal rails",
       {{"gyro_plateau_axis_spread_rad_s"},
        {"gyro_plateau_event_spread_rad_s"},
        {"gyro_wrap"},
        {"gyro_slow_recovery_s"},
        {"gyro_slow_recovery_share"},
        {"accel_plateau_axis_spread_m_s2"},
        {"accel_plateau_event_spread_m_s2"},
        {"accel_wrap"},
        {"accel_slow_recovery_s"},
        {"accel_slow_recovery_share"}}},
      {"white noise",
       {{"gyro_noise_rad_s_sqrt_hz"},
        {"accel_noise_m_s2_sqrt_hz"},
        {"gyro_precise_noise_rad_s_sqrt_hz"},
        {"accel_precise_noise_m_s2_sqrt_hz"}}},
      {"bias",
       {{"gyro_bias_turn_on_rad_s"},
        {"gyro_bias_in_run_rad_s"},
        {"gyro_bias_walk_rad_s_sqrt_s"},
        {"accel_bias_turn_on_m_s2"},
        {"accel_bias_in_run_m_s2"},
        {"accel_bias_walk_m_s2_sqrt_s"}}},
      {"scale and misalignment",
       {{"gyro_scale_error"}, {"gyro_misalignment_rad"}, {"accel_scale_error"}, {"accel_misalignment_rad"}}},
      {"g-sensitivity", {{"gyro_g_sensitivity_s_m"}, {"gyro_g_sensitivity_spread_s_m"}}},
      {"low-pass", {{"gyro_bandwidth_hz"}, {"accel_bandwidth_hz"}, {"digital_bandwidth_hz"}}},
      {"averaging, sample-and-hold and quantisation of the readings",
       {{"gyro_window_s"},
        {"accel_window_s"},
        {"gyro_update_hz"},
        {"accel_update_hz"},
        {"gyro_quantum_rad_s"},
        {"accel_quantum_m_s2"},
        {"gyro_precise_quantum_rad_s"},
        {"accel_precise_quantum_m_s2"},
        {"gyro_handover_rad_s"},
        {"accel_handover_m_s2"}}},
      {"delay and clock error", {{"gyro_delay_s"}, {"accel_delay_s"}, {"time_offset_s"}, {"time_jitter_s"}}},
      {"dropouts", {{"dropout_share"}}, Sort::size},
      {"wild readings", {{"glitch_share"}}, Sort::size},
      {"late start", {{"start_delay_s"}}, Sort::size},
      {"magnetic errors",
       {{"mag_noise_t"},
        {"mag_hard_iron_t"},
        {"mag_scale_error"},
        {"mag_misalignment_rad"},
        {"mag_quantum_t"},
        {"magnetic_sources"}}},
  };
  return kLines;
}

std::span<const ComplicationLine> of_lidar() {
  static const std::vector<ComplicationLine> kLines = {
      {"range noise", {{"range_noise_m"}}, Sort::size},
      {"quanta", {{"range_quantum_m"}, {"intensity_quantum"}}},
      {"lost returns", {{"detection_range_m"}, {"dropout_share"}}},
      {"lost sweeps", {{"sweep_dropout_share"}}, Sort::size},
      {"late start", {{"start_delay_s"}}, Sort::size},
      {"beam width", {{"beam_rays", 1.0}}},
      {"lidar returns from the robot's own cage", {{"sees_own_cage"}}},
      {"faulty time stamps", {{"driver_stamp_fault"}}},
  };
  return kLines;
}

std::span<const ComplicationLine> of_mounting() {
  static const std::vector<ComplicationLine> kLines = {
      {"mounting errors", {{"x_m"}, {"y_m"}, {"z_m"}, {"roll_rad"}, {"pitch_rad"}, {"yaw_rad"}}}};
  return kLines;
}

using Numbers = std::map<std::string, Distribution>;

void add(const std::string& part, const std::string& place, std::span<const ComplicationLine> lines,
         const Numbers& numbers, std::vector<Complication>& out) {
  for (const ComplicationLine& line : lines) {
    Complication found{part + ": " + std::string(line.what), {}, {}, line.sort == Sort::count};
    double value = 0.0;
    for (const Ideal& ideal : line.numbers) {
      const auto number = numbers.find(std::string(ideal.number));
      if (number == numbers.end() || number->second.numbers.front() == ideal.value) continue;
      value = number->second.numbers.front();
      found.without.emplace_back(place + "." + number->first, ideal.value);
    }
    if (found.without.empty()) continue;
    if (line.sort != Sort::several) found.amount = value;
    out.push_back(std::move(found));
  }
}

Complication joined(const std::string& name, const std::vector<Complication>& parts) {
  Complication whole{name, {}, {}, false};
  for (const Complication& part : parts)
    whole.without.insert(whole.without.end(), part.without.begin(), part.without.end());
  return whole;
}

}  // namespace

std::vector<Complication> complications(const Scenario& scenario) {
  std::vector<Complication> out;
  add("world", "world", of_world(), scenario.world.numbers, out);
  add("robot", "robot", of_robot(), scenario.robot.numbers, out);
  add("motion", "motion", of_motion(), scenario.motion.numbers, out);
  bool primary = true;
  for (const Scenario::Sensor& sensor : scenario.sensors) {
    const std::string place = "sensors." + sensor.name;
    const bool is_imu = sensor.kind == "imu";
    std::vector<Complication> own;
    add(place, place, is_imu ? of_imu() : of_lidar(), sensor.numbers, own);
    add(place, place + ".mount_error", of_mounting(), sensor.mount_error, own);
    if (is_imu && !primary && !own.empty()) own = {joined(fmt::format("{}: all errors of this sensor", place), own)};
    out.insert(out.end(), own.begin(), own.end());
    primary = primary && !is_imu;
  }
  return out;
}

void take_away(const Complication& complication, Scenario& scenario) {
  for (const auto& [place, value] : complication.without) fix_number(scenario, place, value);
}

}  // namespace tumble::scenarios
