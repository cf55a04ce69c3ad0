// SPDX-License-Identifier: BSD-3-Clause
// rail_measures AXIS RAIL FILE...
//
// The program measures a gyro at its saturation level of RAIL rad/s on AXIS (x, y, z), and prints a line per file. The
// columns are the share of rows that repeat the readings before; the share of the gyro's own readings at the saturation
// level; how long they stay there; the true rate there; and the scatter of the readings of one sign within segments,
// before and after the fit of a plane. FILE is a recording with true rates (.h5). The importer of RepoIMU
// removes repeated readings. The program is no test.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace {

using Eigen::Vector3d;
using namespace tumble;

/// Readings contains the gyro's distinct readings with the true rates.
struct Readings {
  std::vector<double> time_s;
  std::vector<Vector3d> gyro, rate;
  double gyro_repeats = 0.0, accel_repeats = 0.0;
};

template <class Row>
double repeated(const std::vector<Row>& rows) {
  std::size_t count = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) count += rows[k] == rows[k - 1];
  return rows.size() < 2 ? 0.0 : static_cast<double>(count) / static_cast<double>(rows.size() - 1);
}

Readings readings_of(const std::string& file) {
  const sim::ImuRecord imu = scenarios::read_sensors(file).imus.at(0);
  const std::vector<Vector3d> rate = scenarios::read_truth(file).imus.at(0).rate_rad_s;
  Readings out;
  out.gyro_repeats = repeated(imu.gyro_rad_s);
  out.accel_repeats = repeated(imu.accel_m_s2);
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    if (k > 0 && imu.gyro_rad_s[k] == imu.gyro_rad_s[k - 1]) continue;
    out.time_s.push_back(1e-9 * static_cast<double>(imu.time_ns[k]));
    out.gyro.push_back(imu.gyro_rad_s[k]);
    out.rate.push_back(rate.at(k));
  }
  return out;
}

/// Plane is the plane of the readings of one sign at the saturation level of `axis`.
struct Plane {
  std::size_t readings = 0;
  double before = std::nan(""), after = std::nan("");  ///< against the next two axes
  double slope_1 = std::nan(""),
         slope_2 = std::nan("");  ///< slopes relative to the next axis, and to the axis after it
};

Plane fit(const std::vector<Vector3d>& readings, int axis) {
  Plane out;
  out.readings = readings.size();
  const auto count = static_cast<Eigen::Index>(readings.size());
  if (count < 8) return out;
  Eigen::Matrix<double, Eigen::Dynamic, 3> design(count, 3);
  Eigen::VectorXd value(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector3d& w = readings[static_cast<std::size_t>(i)];
    value[i] = w[axis];
    design.row(i) << 1.0, w[(axis + 1) % 3], w[(axis + 2) % 3];
  }
  const double n = static_cast<double>(count);
  const Vector3d plane = (design.transpose() * design).ldlt().solve(design.transpose() * value);
  out.before = std::sqrt((value.array() - value.mean()).square().sum() / n);
  out.after = (value - design * plane).norm() / std::sqrt(n);
  out.slope_1 = plane[1];
  out.slope_2 = plane[2];
  return out;
}

/// Fits one plane to both signs: readings within 0.05 rad/s of it whose neighbours are too, iterated until the set is
/// stable; scenarios/certificate/real_rails.cpp uses the result.
void print_both_signs(const std::vector<Vector3d>& gyro, int axis, double rail_rad_s) {
  constexpr double kFirst_rad_s = 0.15, kSlab_rad_s = 0.05, kLeastShare = 0.9;
  const auto row = [&](std::size_t k) {
    const Vector3d& w = gyro[k];
    return Eigen::Vector4d(w[(axis + 1) % 3], w[(axis + 2) % 3], w[axis] > 0.0 ? 1.0 : -1.0, 1.0);
  };
  std::vector<bool> on(gyro.size());
  for (std::size_t k = 0; k < gyro.size(); ++k) on[k] = std::abs(gyro[k][axis]) > rail_rad_s - kFirst_rad_s;
  for (int iteration = 0; iteration < 60; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::vector<std::size_t> inside;
    for (std::size_t k = 1; k + 1 < gyro.size(); ++k) {
      const bool one_sign = gyro[k - 1][axis] * gyro[k][axis] > 0.0 && gyro[k + 1][axis] * gyro[k][axis] > 0.0;
      if (!on[k - 1] || !on[k] || !on[k + 1] || !one_sign) continue;
      inside.push_back(k);
      normal += row(k) * row(k).transpose();
      right += row(k) * gyro[k][axis];
    }
    const Eigen::Vector4d plane = normal.ldlt().solve(right);
    const std::vector<bool> before = on;
    for (std::size_t k = 0; k < gyro.size(); ++k) {
      on[k] = std::abs(gyro[k][axis] - plane.dot(row(k))) < kSlab_rad_s &&
              std::abs(gyro[k][axis]) > kLeastShare * rail_rad_s;
    }
    if (on != before && iteration < 59) continue;
    double squares = 0.0;
    int positive = 0;
    for (const std::size_t k : inside) {
      squares += std::pow(gyro[k][axis] - plane.dot(row(k)), 2);
      positive += gyro[k][axis] > 0.0;
    }
    const double left = std::sqrt(squares / static_cast<double>(inside.size()));
    const Eigen::Vector4d sigma = left * normal.inverse().diagonal().cwiseSqrt();
    std::printf(
        "  both signs: %d, %d readings; slopes %.4f (%.4f), %.4f (%.4f); distance %.4f, offset %.4f (%.4f); "
        "leaves %.4f rad/s\n",
        positive, static_cast<int>(inside.size()) - positive, plane[0], sigma[0], plane[1], sigma[1], plane[2],
        plane[3], sigma[3], left);
    return;
  }
}

void print(const std::string& file, const Readings& readings, int axis, double rail_rad_s) {
  // scale, offset and tilt of the elements move the saturation limit by about this much
  constexpr double kNear_rad_s = 0.3;
  std::vector<double> rates, segments_s;
  std::vector<Vector3d> inside[2];
  std::size_t at_rail = 0, run = 0;
  const std::vector<Vector3d>& gyro = readings.gyro;
  const double step_s = (readings.time_s.back() - readings.time_s.front()) / static_cast<double>(gyro.size() - 1);
  const auto railed = [&](std::size_t k) {
    return k < gyro.size() && std::abs(gyro[k][axis]) > rail_rad_s - kNear_rad_s;
  };
  for (std::size_t k = 0; k <= gyro.size(); ++k) {
    if (railed(k)) {
      ++run, ++at_rail;
      if (readings.rate[k].allFinite()) rates.push_back(readings.rate[k].norm());
      if (k > 0 && railed(k - 1) && railed(k + 1)) inside[gyro[k][axis] > 0.0].push_back(gyro[k]);
    } else if (run > 0) {
      segments_s.push_back(static_cast<double>(run) * step_s);
      run = 0;
    }
  }
  const auto& more = inside[inside[1].size() > inside[0].size()];
  const Plane plane = fit(more, axis);
  const auto quantile = [](const std::vector<double>& v, double q) {
    return v.empty() ? std::nan("") : scenarios::quantile(v, q);
  };
  std::printf("%5.1f %5.1f %6.2f %4zu  %5.2f %5.2f  %5.1f %5.1f %5.1f  %4zu %7.4f %7.4f %7.4f %7.4f  %s\n",
              100.0 * readings.gyro_repeats, 100.0 * readings.accel_repeats,
              100.0 * static_cast<double>(at_rail) / static_cast<double>(gyro.size()), segments_s.size(),
              quantile(segments_s, 0.5), quantile(segments_s, 1.0), quantile(rates, 0.5), quantile(rates, 0.9),
              quantile(rates, 0.99), plane.readings, plane.before, plane.after, plane.slope_1, plane.slope_2,
              file.c_str());
  print_both_signs(gyro, axis, rail_rad_s);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string axes = "xyz";
  if (argc < 4 || std::string(argv[1]).size() != 1 || axes.find(argv[1]) == std::string::npos) {
    std::fprintf(stderr, "usage: rail_measures x|y|z RAIL_RAD_S FILE...\n");
    return 2;
  }
  std::printf(
      "repeats [%%]  at rail      segment [s]  true rate [rad/s]  plane of one sign: scatter [rad/s] and slopes\n"
      " gyro accel    [%%]    n   med.  max.   med.  90 %%  99 %%     n  before   after\n");
  try {
    for (int i = 3; i < argc; ++i) {
      const std::string file = argv[i];
      print(file, readings_of(file), static_cast<int>(axes.find(argv[1])), std::atof(argv[2]));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rail_measures: %s\n", error.what());
    return 2;
  }
  return 0;
}
