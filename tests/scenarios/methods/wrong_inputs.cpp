// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenarios/methods/wrong_inputs.hpp"

#include "sim/random/stream.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios::testing {

namespace {

constexpr double kDegree = 57.29577951308232, kOneG_m_s2 = 9.80665;

void each_reading(sim::Sensors& sensors, const std::function<void(Vector3d&, Vector3d&)>& change) {
  for (sim::ImuRecord& imu : sensors.imus) {
    for (std::size_t k = 0; k < imu.time_ns.size(); ++k) change(imu.gyro_rad_s[k], imu.accel_m_s2[k]);
  }
}

void shift_lidar(sim::Sensors& sensors, std::int64_t by_ns) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::int64_t& start_ns : lidar.sweep_start_ns) start_ns += by_ns;
  }
}

void freeze(std::vector<Vector3d>& readings) {
  for (std::size_t k = readings.size() / 3; k < readings.size(); ++k) readings[k] = readings[readings.size() / 3];
}

/// Freezes an axis from a fifth of the recording on, which is during the motion.
void freeze_axis(std::vector<Vector3d>& readings, int axis) {
  const std::size_t from = readings.size() / 5;
  for (std::size_t k = from; k < readings.size(); ++k) readings[k][axis] = readings[from][axis];
}

/// Subtracts the mean force over a second, as devices that report "linear acceleration" do.
void take_gravity_out(std::vector<Vector3d>& forces, const std::vector<std::int64_t>& time_ns) {
  constexpr double kMean_s = 1.0;
  Vector3d gravity = forces.empty() ? Eigen::Vector3d::Zero() : forces.front();
  for (std::size_t k = 1; k < forces.size(); ++k) {
    const double share = 1e-9 * static_cast<double>(time_ns[k] - time_ns[k - 1]) / kMean_s;
    gravity += std::min(1.0, share) * (forces[k] - gravity);
    forces[k] -= gravity;
  }
  if (forces.size() > 1) forces.front() = forces[1];
}

/// Returns the sample with the largest change of the first IMU's gyro reading, which an impact causes.
std::size_t hardest_impact(const sim::ImuRecord& imu) {
  std::size_t hardest = 0;
  double change = 0.0;
  for (std::size_t k = 1; k < imu.time_ns.size(); ++k) {
    const double here = (imu.gyro_rad_s[k] - imu.gyro_rad_s[k - 1]).norm();
    if (here > change) hardest = k, change = here;
  }
  return hardest;
}

/// Removes the samples of all IMUs in [from_ns, from_ns + for_ns).
void leave_out(sim::Sensors& sensors, std::int64_t from_ns, std::int64_t for_ns) {
  for (sim::ImuRecord& imu : sensors.imus) {
    const std::vector<std::int64_t> time_ns = imu.time_ns;
    const auto keep = [&](auto& rows) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (time_ns[k] < from_ns || time_ns[k] >= from_ns + for_ns) rows[kept++] = rows[k];
      }
      rows.resize(kept);
    };
    keep(imu.time_ns), keep(imu.gyro_rad_s), keep(imu.accel_m_s2), keep(imu.clip_flags), keep(imu.magnetic_field_t);
  }
}

/// Removes the samples of all IMUs for a time about the hardest impact.
void silence_imus(sim::Sensors& sensors, std::int64_t for_ns) {
  if (sensors.imus.empty() || sensors.imus.front().time_ns.empty()) return;
  leave_out(sensors, sensors.imus.front().time_ns[hardest_impact(sensors.imus.front())] - for_ns / 2, for_ns);
}

/// Adds a zero offset to the x axis of all gyros, whose recordings start 1.3 s late.
void offset_late_gyros(sim::Sensors& sensors, double offset_deg_s) {
  each_reading(sensors, [&](Vector3d& w, Vector3d&) { w.x() += offset_deg_s / kDegree; });
  leave_out(sensors, 0, 1'300'000'000);
}

/// Removes the sweeps of all lidars for a time about the hardest impact.
void silence_lidars(sim::Sensors& sensors, std::int64_t for_ns) {
  const std::int64_t from_ns = sensors.imus.front().time_ns[hardest_impact(sensors.imus.front())] - for_ns / 2;
  for (sim::LidarRecord& lidar : sensors.lidars) {
    const sim::LidarRecord all = lidar;
    const auto keep = [](const auto& rows, std::size_t first, std::size_t end, auto& kept) {
      if (!rows.empty())
        kept.insert(kept.end(), rows.begin() + std::ptrdiff_t(first), rows.begin() + std::ptrdiff_t(end));
    };
    lidar.sweep_start_ns.clear(), lidar.position_L_m.clear(), lidar.range_m.clear(), lidar.intensity.clear();
    lidar.offset_ns.clear(), lidar.ring.clear(), lidar.sweep_first = {0};
    for (std::size_t k = 0; k < all.sweep_start_ns.size(); ++k) {
      if (all.sweep_start_ns[k] >= from_ns && all.sweep_start_ns[k] < from_ns + for_ns) continue;
      const std::size_t first = all.sweep_first[k], end = all.sweep_first[k + 1];
      lidar.sweep_start_ns.push_back(all.sweep_start_ns[k]);
      keep(all.position_L_m, first, end, lidar.position_L_m), keep(all.range_m, first, end, lidar.range_m);
      keep(all.intensity, first, end, lidar.intensity), keep(all.ring, first, end, lidar.ring);
      keep(all.offset_ns, first, end, lidar.offset_ns);
      lidar.sweep_first.push_back(lidar.offset_ns.size());
    }
  }
}

/// Reverses the order of the point times within each sweep.
void reverse_point_times(sim::Sensors& sensors) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::size_t k = 0; k + 1 < lidar.sweep_first.size(); ++k) {
      const auto first = lidar.offset_ns.begin() + std::ptrdiff_t(lidar.sweep_first[k]);
      const auto end = lidar.offset_ns.begin() + std::ptrdiff_t(lidar.sweep_first[k + 1]);
      if (first == end) continue;
      const std::uint32_t last_ns = *std::max_element(first, end);
      std::for_each(first, end, [&](std::uint32_t& offset_ns) { offset_ns = last_ns - offset_ns; });
    }
  }
}

void scale_ranges(sim::Sensors& sensors, float by) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (Vector3f& position : lidar.position_L_m) position *= by;
    for (float& range : lidar.range_m) range *= by;
  }
}

void rotate_lidar(sim::Sensors& sensors, double rad, double m) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    lidar.T_BL.translate(Eigen::Vector3d::Constant(m));
    for (int axis = 0; axis < 3; ++axis) {
      lidar.T_BL.rotate(Eigen::AngleAxisd(rad, Eigen::Vector3d::Unit(axis)));
    }
  }
}

/// Replaces returns by random ranges along their beams, as dust, rain or grass cause them.
void dust(sim::Sensors& sensors, double share) {
  sim::Stream stream(7, "dust");
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::size_t k = 0; k < lidar.range_m.size(); ++k) {
      if (stream.uniform() >= share) continue;
      const auto to_m = static_cast<float>(0.7 + 15.0 * stream.uniform());
      lidar.position_L_m[k] *= to_m / lidar.range_m[k];
      lidar.range_m[k] = to_m;
    }
  }
}

}  // namespace

const std::map<std::string, std::function<void(sim::Sensors&)>>& wrong_inputs() {
  using Vector = Vector3d;
  static const std::map<std::string, std::function<void(sim::Sensors&)>> all = {
      {"none", [](sim::Sensors&) {}},
      {"accel_in_g", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f /= kOneG_m_s2; }); }},
      {"gyros_late_offset_5_deg_s", [](sim::Sensors& s) { offset_late_gyros(s, 5.0); }},
      {"gyros_late_offset_8_deg_s", [](sim::Sensors& s) { offset_late_gyros(s, 8.0); }},
      {"accel_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f = -f; }); }},
      {"accel_x_y_swapped",
       [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { std::swap(f.x(), f.y()); }); }},
      {"accel_z_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f.z() = -f.z(); }); }},
      {"gyro_in_degrees", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= kDegree; }); }},
      {"gyro_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w = -w; }); }},
      {"gyro_x_y_swapped",
       [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { std::swap(w.x(), w.y()); }); }},
      {"gyro_x_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w.x() = -w.x(); }); }},
      {"gyro_z_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w.z() = -w.z(); }); }},
      {"gyro_halved", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= 0.5; }); }},
      {"gyro_doubled", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= 2.0; }); }},
      {"accel_halved", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f *= 0.5; }); }},
      {"gyro_scale_5_percent", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= 1.05; }); }},
      {"gyro_zero", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w.setZero(); }); }},
      {"accel_without_gravity",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) take_gravity_out(imu.accel_m_s2, imu.time_ns);
       }},
      {"all_accels_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze(imu.accel_m_s2);
       }},
      {"all_gyros_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze(imu.gyro_rad_s);
       }},
      {"gyro_z_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze_axis(imu.gyro_rad_s, 2);
       }},
      {"accel_x_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze_axis(imu.accel_m_s2, 0);
       }},
      {"first_frozen", [](sim::Sensors& s) { freeze(s.imus.front().accel_m_s2), freeze(s.imus.front().gyro_rad_s); }},
      {"stamps_in_us",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus)
           for (std::int64_t& t : imu.time_ns) t /= 1000;
       }},
      {"imus_silent_120_ms", [](sim::Sensors& s) { silence_imus(s, 120'000'000); }},
      {"imus_silent_300_ms", [](sim::Sensors& s) { silence_imus(s, 300'000'000); }},
      {"imus_silent_1500_ms", [](sim::Sensors& s) { silence_imus(s, 1'500'000'000); }},
      {"lidar_silent_1500_ms", [](sim::Sensors& s) { silence_lidars(s, 1'500'000'000); }},
      {"lidar_and_imus_silent_1500_ms",
       [](sim::Sensors& s) { silence_lidars(s, 1'500'000'000), silence_imus(s, 1'500'000'000); }},
      {"lidar_times_reversed", [](sim::Sensors& s) { reverse_point_times(s); }},
      {"lidar_ranges_in_feet", [](sim::Sensors& s) { scale_ranges(s, 3.28084F); }},
      {"lidar_20_ms", [](sim::Sensors& s) { shift_lidar(s, 20'000'000); }},
      {"lidar_100_ms", [](sim::Sensors& s) { shift_lidar(s, 100'000'000); }},
      {"lidar_ranges_long", [](sim::Sensors& s) { scale_ranges(s, 1.1F); }},
      {"lidar_ranges_short", [](sim::Sensors& s) { scale_ranges(s, 0.9F); }},
      {"mounting_2_deg", [](sim::Sensors& s) { rotate_lidar(s, 0.03, 0.015); }},
      {"mounting_10_deg", [](sim::Sensors& s) { rotate_lidar(s, 0.1, 0.05); }},
      {"mounting_90_deg",
       [](sim::Sensors& s) {
         for (sim::LidarRecord& l : s.lidars) l.T_BL.rotate(Eigen::AngleAxisd(1.5707963, Vector::UnitZ()));
       }},
      {"dust_5_percent", [](sim::Sensors& s) { dust(s, 0.05); }},
      {"radius_2_percent", [](sim::Sensors& s) { s.sphere_radius_m *= 1.02; }},
  };
  return all;
}

bool is_of_kind(const std::string& harm, Kind kind) {
  const bool of_lidar = harm.starts_with("lidar") || harm.starts_with("mounting") || harm.starts_with("dust");
  const bool of_sphere = harm == "first_frozen" || harm == "radius_2_percent";
  return kind == Kind::slam ? !of_sphere : !of_lidar;
}

}  // namespace tumble::scenarios::testing
