// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "stand_ins/known_motion.hpp"
#include "stand_ins/stand_ins.hpp"
#include "stand_ins/writers.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::test {

namespace {

constexpr double kPeriod_s = 0.011, kPad_s = 779.4, kFlight_s = 22.0;
// 300 m up within 8 s and down within 10. From 10 to 14 s it spins about its axis at up to 38.9 rad/s, which is 2229
// deg/s, as in the real flight (1.875: the steepest slope of a smooth step)
constexpr double kHeight_m = 300.0, kSpin_rad = 38.9 * 4.0 / 1.875;

KnownMotion rocket() {
  return {[](double t) {
            return so3::exp({0.0, 0.05 * smooth_step(t, 6.0, 8.0), kSpin_rad * smooth_step(t, 10.0, 4.0)});
          },
          [](double t) -> Eigen::Vector3d {
            return {0.0, 0.0, kHeight_m * (smooth_step(t, 3.0, 8.0) - smooth_step(t, 11.0, 10.0))};
          }};
}

}  // namespace

void write_airbrakes(const std::filesystem::path& folder) {
  std::ofstream out(folder / kStandInFlight);
  out << "state_letter,set_extension,timestamp_seconds,pressure_pascals,raw_acceleration_x_gs,raw_acceleration_y_gs,"
         "raw_acceleration_z_gs,raw_angular_rate_x_deg_per_s,raw_angular_rate_y_deg_per_s,raw_angular_rate_z_deg_per_s,"
         "magnetic_field_x_microteslas,magnetic_field_y_microteslas,magnetic_field_z_microteslas,predicted_apogee\n";
  const KnownMotion motion = rocket();
  Noise noise(20260702);
  const auto row = [&](double stamp_s, double t) {
    const Eigen::Vector3d f = (specific_force(motion, t) + noise.vector(0.05)) / kStandardGravity_m_s2;
    const Eigen::Vector3d w = (angular_velocity(motion, t) + noise.vector(0.002)) * 180.0 / std::numbers::pi;
    const Eigen::Vector3d m = motion.q_WI(t).conjugate() * Eigen::Vector3d(20.0, 5.0, -40.0);
    char line[300];
    std::snprintf(line, sizeof line, "S,112,%.8f,101052.6,%.8f,%.8f,%.8f,%.8f,%.8f,%.8f,%.5f,%.5f,%.5f,\n", stamp_s,
                  f.x(), f.y(), f.z(), w.x(), w.y(), w.z(), m.x(), m.y(), m.z());
    out << line;
  };
  for (int k = 0; k < 7; ++k) row(10.9 + kPeriod_s * k, 0.0);
  const int count = static_cast<int>(kFlight_s / kPeriod_s);
  for (int k = 0; k < count; ++k) {
    row(kPad_s + kPeriod_s * k, kPeriod_s * k);
    if (k % 200 == 150) row(kPad_s + kPeriod_s * k, kPeriod_s * k);
  }
  if (!out.flush()) throw std::runtime_error("cannot write the flight");
}

}  // namespace tumble::test
