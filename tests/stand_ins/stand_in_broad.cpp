// SPDX-License-Identifier: BSD-3-Clause
#include <hdf5.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "stand_ins/known_motion.hpp"
#include "stand_ins/stand_ins.hpp"
#include "stand_ins/writers.hpp"
#include "tumble/common/types.hpp"

namespace tumble::test {

namespace {

constexpr double kRate_hz = 1e9 / 3.5e6;  // 285.714 Hz, as the trials
// the noise has the order of magnitude of the trials' sensor
constexpr double kGyroNoise_rad_s = 0.004, kAccelNoise_m_s2 = 0.03, kMagNoise_ut = 0.3;
const Eigen::Vector3d kGyroBias_rad_s(0.004, -0.003, 0.002);
const Eigen::Vector3d kField_W_ut(0.0, 19.0, -45.0);
// the noise is that of the optical reference
constexpr double kMarkerNoise_rad = 2e-4, kMarkerNoise_m = 1e-4;

/// Returns how much the sensor moves: it is still for 8 s at each end and from 46 to 54 s.
double liveliness(double t) {
  return window(t, 8.0, 46.0, 2.0) + window(t, 54.0, 82.0, 2.0);
}

KnownMotion hand() {
  return {[](double t) {
            const double a = liveliness(t);
            return so3::exp({0.0, 0.0, a * (1.9 * std::sin(1.3 * t) + 0.7 * std::sin(3.7 * t))}) *
                   so3::exp({0.0, a * (0.9 * std::sin(2.1 * t + 0.5) + 0.2 * std::sin(5.3 * t)), 0.0}) *
                   so3::exp({a * (1.4 * std::sin(1.7 * t + 1.0) + 0.4 * std::sin(4.1 * t)), 0.0, 0.0});
          },
          [](double t) -> Eigen::Vector3d {
            return liveliness(t) * Eigen::Vector3d(0.15 * std::sin(1.9 * t), 0.12 * std::sin(2.7 * t + 0.7),
                                                   0.08 * std::sin(3.3 * t + 1.9));
          }};
}

/// Returns whether the cameras lose the markers at `t`.
bool occluded(double t) {
  return (t > 20.0 && t < 20.3) || (t > 33.0 && t < 33.2) || (t > 61.0 && t < 61.4);
}

struct Columns {
  std::vector<double> gyr, acc, mag, quat, pos;
  std::vector<std::int8_t> movement;
};

void append(std::vector<double>& column, const Eigen::Vector3d& row) {
  column.insert(column.end(), {row.x(), row.y(), row.z()});
}

Columns readings() {
  const KnownMotion motion = hand();
  Noise noise(20260701);
  Columns out;
  for (std::size_t k = 0; k < kStandInTrialSamples; ++k) {
    const double t = static_cast<double>(k) / kRate_hz;
    const Eigen::Quaterniond q = motion.q_WI(t);
    append(out.gyr, angular_velocity(motion, t) + kGyroBias_rad_s + noise.vector(kGyroNoise_rad_s));
    append(out.acc, specific_force(motion, t) + noise.vector(kAccelNoise_m_s2));
    append(out.mag, q.conjugate() * kField_W_ut + noise.vector(kMagNoise_ut));
    const double gone = occluded(t) ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    const Eigen::Quaterniond seen = q * so3::exp(noise.vector(kMarkerNoise_rad));
    out.quat.insert(out.quat.end(), {seen.w() + gone, seen.x() + gone, seen.y() + gone, seen.z() + gone});
    append(out.pos, motion.p_WI_m(t) + noise.vector(kMarkerNoise_m) + Eigen::Vector3d::Constant(gone));
    out.movement.push_back(liveliness(t) > 0.0 ? 1 : 0);
  }
  return out;
}

void write_table(hid_t file, const char* name, hid_t type, const void* values, hsize_t rows, hsize_t columns) {
  const hsize_t shape[2] = {rows, columns};
  const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, shape, nullptr);
  const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const herr_t done = set < 0 ? -1 : H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  H5Dclose(set);
  H5Sclose(space);
  if (done < 0) throw std::runtime_error(std::string("cannot write ") + name);
}

}  // namespace

void write_broad(const std::filesystem::path& folder) {
  const Columns out = readings();
  const auto path = folder / (std::string(kStandInTrial) + "_stand_in_hand.hdf5");
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error("cannot write " + path.string());
  const hsize_t rows = kStandInTrialSamples;
  write_table(file, "imu_gyr", H5T_NATIVE_DOUBLE, out.gyr.data(), rows, 3);
  write_table(file, "imu_acc", H5T_NATIVE_DOUBLE, out.acc.data(), rows, 3);
  write_table(file, "imu_mag", H5T_NATIVE_DOUBLE, out.mag.data(), rows, 3);
  write_table(file, "opt_quat", H5T_NATIVE_DOUBLE, out.quat.data(), rows, 4);
  write_table(file, "opt_pos", H5T_NATIVE_DOUBLE, out.pos.data(), rows, 3);
  write_table(file, "movement", H5T_NATIVE_INT8, out.movement.data(), rows, 1);
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t rate = H5Acreate2(file, "sampling_rate", H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
  const herr_t done = H5Awrite(rate, H5T_NATIVE_DOUBLE, &kRate_hz);
  H5Aclose(rate);
  H5Sclose(scalar);
  if (H5Fclose(file) < 0 || done < 0) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace tumble::test
