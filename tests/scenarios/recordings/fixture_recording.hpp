// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/recordings/recording_file.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios::fixture {

/// Numbers gives numbers without a pattern, so that a wrong order or a wrong type is visible.
class Numbers {
 public:
  double next() { return std::sin(static_cast<double>(++count_) * 12.9898) * 43.758; }
  Vector3d vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Quaterniond quaternion() {
    const double x = next(), y = next(), z = next(), w = next();
    return Quaterniond(w, x, y, z).normalized();
  }
  Isometry3d pose() {
    Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = quaternion().toRotationMatrix();
    out.translation() = vector();
    return out;
  }

 private:
  int count_ = 0;
};

inline sim::ImuRecord imu_record(Numbers& numbers, const std::string& name, int samples) {
  sim::ImuRecord imu{name, "mti30", 2500000, 7.854, 49.0, 5e-4, 6e-4, numbers.pose(), {}, {}, {}, {}, {}, {}};
  imu.earth_field_W_t = 1e-5 * numbers.vector();
  for (int i = 0; i < samples; ++i) {
    imu.time_ns.push_back(2500000 * (i + 1));
    imu.gyro_rad_s.push_back(numbers.vector());
    imu.accel_m_s2.push_back(numbers.vector());
    imu.clip_flags.push_back(static_cast<std::uint8_t>(i % 64));
    imu.magnetic_field_t.push_back(1e-5 * numbers.vector());
  }
  return imu;
}

inline sim::ImuTruth imu_truth(Numbers& numbers, const std::string& name, int samples) {
  sim::ImuTruth truth;
  truth.name = name;
  truth.T_BI = numbers.pose();
  for (auto* rows :
       {&truth.rate_rad_s, &truth.specific_force_m_s2, &truth.gyro_unclipped_rad_s, &truth.accel_unclipped_m_s2,
        &truth.gyro_bias_rad_s, &truth.accel_bias_m_s2, &truth.magnetic_field_t}) {
    for (int i = 0; i < samples; ++i) rows->push_back(numbers.vector());
  }
  return truth;
}

inline void add_lidar(Numbers& numbers, sim::Recording& recording, const std::string& name, int sweeps,
                      int points_per_sweep) {
  sim::LidarRecord lidar;
  sim::LidarTruth truth;
  lidar.name = truth.name = name;
  lidar.device = "rs16";
  lidar.T_BL = numbers.pose();
  truth.T_BL = numbers.pose();
  lidar.sweep_period_ns = 100000000;
  lidar.sweep_first.push_back(0);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    lidar.sweep_start_ns.push_back(100000000 * static_cast<std::int64_t>(sweep));
    for (int i = 0; i < points_per_sweep; ++i) {
      lidar.position_L_m.push_back(numbers.vector().cast<float>());
      lidar.range_m.push_back(lidar.position_L_m.back().norm());
      lidar.intensity.push_back(static_cast<float>(i % 256) / 255.0f);
      lidar.offset_ns.push_back(static_cast<std::uint32_t>(i) * 3125u);
      lidar.ring.push_back(static_cast<std::uint16_t>(i % 16));
      truth.hit_W_m.push_back(numbers.vector().cast<float>());
      truth.surface_id.push_back(i % 3 - 1);
    }
    lidar.sweep_first.push_back(lidar.position_L_m.size());
  }
  recording.sensors.lidars.push_back(lidar);
  recording.truth.lidars.push_back(truth);
}

inline void add_series(Numbers& numbers, sim::Recording& recording, const std::string& name, int samples) {
  sim::SeriesRecord series{name,           "barometer", "bmp388", 20000000,
                           numbers.pose(), {},          {},       {{"ground_pressure_pa", 101325.0}}};
  sim::SeriesTruth truth{name, numbers.pose(), {}};
  for (int i = 0; i < samples; ++i) series.time_ns.push_back(20000000 * (static_cast<std::int64_t>(i) + 1));
  for (const auto& [quantity, unit] : {std::pair{"pressure_pa", "Pa"}, std::pair{"temperature_k", "K"}}) {
    series.quantities.push_back({quantity, unit, 1.5, {}});
    truth.quantities.push_back({quantity, unit, {}});
    for (int i = 0; i < samples; ++i) {
      series.quantities.back().values.push_back(1e5 + numbers.next());
      truth.quantities.back().values.push_back(1e5 + numbers.next());
    }
  }
  recording.sensors.series.push_back(series);
  recording.truth.series.push_back(truth);
}

/// Returns a recording with two IMUs, a lidar, a series and contacts, with every field different from its default.
inline sim::Recording recording() {
  Numbers numbers;
  sim::Recording out;
  out.sensors.robot = "sphere";
  out.sensors.sphere_radius_m = 0.145;
  out.sensors.gravity_m_s2 = 9.81;
  sim::Truth& truth = out.truth;
  truth.period_ns = 1000000;
  truth.p_BG_m = numbers.vector();
  truth.surfaces = {"terrain", "rock \xc3\xa9"};
  for (const char* name : {"imu", "imu_reference"}) {
    out.sensors.imus.push_back(imu_record(numbers, name, 70));
    truth.imus.push_back(imu_truth(numbers, name, 70));
  }
  add_lidar(numbers, out, "lidar", 3, 50);
  for (int i = 0; i < 40; ++i) {
    truth.p_WB_m.push_back(numbers.vector());
    truth.q_WB.push_back(numbers.quaternion());
    truth.v_WB_m_s.push_back(numbers.vector());
    truth.w_WB_B_rad_s.push_back(numbers.vector());
    truth.f_B_m_s2.push_back(numbers.vector());
    truth.label.push_back(static_cast<sim::ContactLabel>(i % 4));
    if (i % 3 == 0) {
      truth.contacts.push_back({i * 1000000, numbers.vector(), numbers.vector().normalized(), numbers.vector(),
                                std::abs(numbers.next()), i % 2});
    }
  }
  add_series(numbers, out, "barometer", 5);
  return out;
}

inline RecordingInfo info() {
  RecordingInfo out;
  out.scenario = "roll";
  out.seed = 0xffffffffffffffffu;
  out.situation_yaml = "scenario: roll\nseed: 1\n";
  out.tumble_version = "0.1.0";
  out.engine_version = "3.17.0";
  out.attribution = "nobody, CC BY 4.0";
  return out;
}

inline void put(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// Returns the sensors of a short recording: three samples of one IMU.
inline sim::Sensors small_sensors() {
  sim::Sensors sensors = recording().sensors;
  for (std::uint32_t& offset : sensors.lidars[0].offset_ns) offset *= 600;
  sensors.imus.resize(1);
  sim::ImuRecord& imu = sensors.imus[0];
  imu.time_ns.resize(3);
  for (auto* rows : {&imu.gyro_rad_s, &imu.accel_m_s2}) rows->assign(3, Vector3d(0, 0, 9.8));
  return sensors;
}

/// Returns the truth of `recording` as it is read back from a file in `folder`.
inline StoredTruth stored_truth(const sim::Recording& recording, const fs::path& folder) {
  const fs::path file = folder / "with_truth.h5";
  write_recording(file, {}, recording.sensors, &recording.truth);
  StoredTruth truth = read_truth(file, folder);
  fs::remove(file);
  return truth;
}

}  // namespace tumble::scenarios::fixture
