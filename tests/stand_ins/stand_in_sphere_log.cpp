// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenarios/baselines/attitude/autogain.hpp"
#include "stand_ins/known_motion.hpp"
#include "stand_ins/stand_ins.hpp"
#include "stand_ins/writers.hpp"
#include "tumble/common/types.hpp"

namespace tumble::test {

namespace {

constexpr double kLogPeriod_s = 0.008, kRadius_m = 0.145;
constexpr double kSphereGyroNoise_rad_s = 0.002, kSphereAccelNoise_m_s2 = 0.02;

/// Returns the path of the sphere's centre, where the sensor is: 3 m along x between 3 and 28 s, at a changing speed.
double path_length_m(double t) {
  const double u = smooth_step(t, 3.0, 25.0);
  return kStandInSphereNet_m * u + 0.08 * std::sin(2.0 * M_PI * 3.0 * u);
}

KnownMotion rolling() {
  return {[](double t) {
            return so3::exp({0.0, path_length_m(t) / kRadius_m, 0.0}) * so3::exp({0.9, -0.3, 0.5});
          },
          [](double t) -> Eigen::Vector3d {
            return {path_length_m(t), 0.0, kRadius_m};
          }};
}

/// Rounds to nine decimals, as in the log.
Eigen::Vector3d rounded(const Eigen::Vector3d& v) {
  return (v * 1e9).array().round() / 1e9;
}

const char* kNames =
    "__time,/orientation/angular_velocity/x,/orientation/angular_velocity/y,/orientation/angular_velocity/z,"
    "/orientation/header/seq,/orientation/header/stamp,/orientation/linear_acceleration/x,"
    "/orientation/linear_acceleration/y,/orientation/linear_acceleration/z,/orientation/orientation/w,"
    "/orientation/orientation/x,/orientation/orientation/y,/orientation/orientation/z\n";

}  // namespace

void write_sphere_log(const std::filesystem::path& folder) {
  std::ofstream out(folder / kSphereLogFile);
  out << kNames;
  const KnownMotion motion = rolling();
  Noise noise(20260703);
  // the filter has the profile and the roll error of the code that wrote the real log
  const baselines::Autogain filter({.profile = baselines::AutogainProfile::code2021, .roll_error_2021 = true});
  baselines::Autogain::State state;
  for (std::size_t k = 0; k < kStandInSphereSamples; ++k) {
    const double t = kLogPeriod_s * static_cast<double>(k);
    const Eigen::Vector3d w = rounded(angular_velocity(motion, t) + noise.vector(kSphereGyroNoise_rad_s));
    const Eigen::Vector3d f =
        rounded((specific_force(motion, t) + noise.vector(kSphereAccelNoise_m_s2)) / kStandardGravity_m_s2);
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(k) * 8'000'000;
    sample.angular_velocity_rad_s = w;
    sample.specific_force_m_s2 = kStandardGravity_m_s2 * f;
    if (!filter.step(sample, state).ok()) throw std::runtime_error("the filter refuses the sphere's readings");
    const TimeNs stamp_ns = 223'639'727 + sample.time_ns;
    char line[400];
    std::snprintf(line, sizeof line,
                  "1617333%03d.%06d,%.9f,%.9f,%.9f,%zu.000000000,1617333%03d.%09d,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n",
                  static_cast<int>(602 + stamp_ns / 1'000'000'000), static_cast<int>(stamp_ns % 1'000'000'000 / 1000),
                  w.x(), w.y(), w.z(), 13710 + k, static_cast<int>(602 + stamp_ns / 1'000'000'000),
                  static_cast<int>(stamp_ns % 1'000'000'000), f.x(), f.y(), f.z(), state.q_WI.w(), state.q_WI.x(),
                  state.q_WI.y(), state.q_WI.z());
    out << line;
  }
  if (!out.flush()) throw std::runtime_error("cannot write the sphere's log");
}

}  // namespace tumble::test
