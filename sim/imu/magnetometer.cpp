// SPDX-License-Identifier: BSD-3-Clause
#include "sim/imu/magnetometer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/imu/stages.hpp"

namespace tumble::sim {

namespace {

constexpr double kMu0Over4Pi = 1e-7;  // T m / A
constexpr int kTries = 200;
constexpr std::size_t kPositions = 500;  // checked positions on the path

Eigen::Vector3d random_direction(Stream& stream) {
  const double z = stream.uniform(-1.0, 1.0), turn = stream.uniform(0.0, 2.0 * std::numbers::pi);
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(turn), radius * std::sin(turn), z};
}

double distance_to_path(std::span<const Eigen::Vector3d> path, const Eigen::Vector3d& position) {
  const std::size_t stride = std::max<std::size_t>(1, path.size() / kPositions);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < path.size(); k += stride) nearest = std::min(nearest, (path[k] - position).norm());
  return nearest;
}

Eigen::Vector3d draw_position(std::span<const Eigen::Vector3d> path, double nearest_m, double farthest_m,
                              Stream& stream) {
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double best_m = -1.0;
  for (int i = 0; i < kTries && best_m < nearest_m; ++i) {
    const auto k = static_cast<std::size_t>(stream.uniform() * static_cast<double>(path.size()));
    const Eigen::Vector3d direction = random_direction(stream);
    const Eigen::Vector3d position = path[k] + stream.uniform(nearest_m, farthest_m) * direction;
    const double distance_m = distance_to_path(path, position);
    if (distance_m <= best_m) continue;
    best = position;
    best_m = distance_m;
  }
  return best;
}

}  // namespace

Eigen::Vector3d MagneticField::at(const Eigen::Vector3d& p_W_m) const {
  Eigen::Vector3d field = earth_W_t;
  for (const MagneticDipole& dipole : dipoles) {
    const Eigen::Vector3d r = p_W_m - dipole.p_W_m;
    const double r2 = r.squaredNorm();
    field +=
        kMu0Over4Pi * (3.0 * dipole.moment_W_a_m2.dot(r) * r - r2 * dipole.moment_W_a_m2) / (r2 * r2 * std::sqrt(r2));
  }
  return field;
}

MagneticField draw_magnetic_field(const Values& values, std::span<const Eigen::Vector3d> p_W_m, std::uint64_t seed) {
  const double dip = values.at("earth_inclination_rad"), north = values.at("earth_north_rad");
  MagneticField field;
  field.earth_W_t = values.at("earth_field_t") *
                    Eigen::Vector3d(std::cos(dip) * std::cos(north), std::cos(dip) * std::sin(north), -std::sin(dip));
  Stream stream(seed, "magnetic.sources");
  const int count = static_cast<int>(std::lround(values.at("magnetic_sources")));
  for (int i = 0; i < count && !p_W_m.empty(); ++i) {
    const Eigen::Vector3d position =
        draw_position(p_W_m, values.at("magnetic_source_nearest_m"), values.at("magnetic_source_farthest_m"), stream);
    const double moment = values.at("magnetic_source_moment_a_m2") * std::pow(3.0, stream.uniform(-1.0, 1.0));
    field.dipoles.push_back({position, moment * random_direction(stream)});
  }
  return field;
}

Magnetometer::Magnetometer(const Values& values, std::uint64_t seed, const std::string& stream_name)
    : stream_(seed, stream_name + ".noise"),
      noise_t_(values.at("mag_noise_t")),
      rail_t_(values.at("mag_rail_t")),
      quantum_t_(values.at("mag_quantum_t")) {
  Stream constant(seed, stream_name + ".iron");
  soft_iron_ = draw_axis_errors(constant, values.at("mag_scale_error"), values.at("mag_misalignment_rad"));
  hard_iron_t_ = normals(constant, values.at("mag_hard_iron_t"));
}

Eigen::Vector3d Magnetometer::read(const Eigen::Vector3d& true_I_t) {
  Eigen::Vector3d reading = soft_iron_ * true_I_t + hard_iron_t_ + normals(stream_, noise_t_);
  if (rail_t_ > 0.0) reading = reading.cwiseMin(rail_t_).cwiseMax(-rail_t_);
  return quantise(reading, Eigen::Vector3d::Constant(quantum_t_));
}

}  // namespace tumble::sim
