// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

struct MagneticDipole {
  Eigen::Vector3d p_W_m;
  Eigen::Vector3d moment_W_a_m2;
};

/// MagneticField is the magnetic flux density in the world [T]: the uniform field of the Earth plus point dipoles. At
/// the position r relative to a dipole with the moment m, the field of the dipole is B = mu_0 / (4 pi) (3 (m r) r - m
/// r^2) / r^5 (Jackson, Classical Electrodynamics, equation 5.56). Induced magnetisation, currents and moving sources
/// are not simulated.
struct MagneticField {
  Eigen::Vector3d earth_W_t = Eigen::Vector3d::Zero();
  std::vector<MagneticDipole> dipoles;
  Eigen::Vector3d at(const Eigen::Vector3d& p_W_m) const;
};

/// Draws a random magnetic field. The angle earth_north_rad from the world's x axis towards the y axis is the direction
/// of the horizontal part of the Earth's field. The moments of the dipoles are log-uniform within a factor of 3 of
/// magnetic_source_moment_a_m2, in random directions. Equal parameters and seeds give equal fields for every
/// magnetometer.
MagneticField draw_magnetic_field(const Values& values, std::span<const Eigen::Vector3d> p_W_m, std::uint64_t seed);

/// Magnetometer simulates the errors of a magnetometer with three axes: soft iron (scale and misalignment), hard iron
/// (a constant offset in sensor axes), white noise, saturation, quantisation. Bandwidth, delay and temperature are not
/// simulated.
class Magnetometer {
 public:
  Magnetometer(const Values& values, std::uint64_t seed, const std::string& stream_name);
  Eigen::Vector3d read(const Eigen::Vector3d& true_I_t);

 private:
  Stream stream_;
  double noise_t_, rail_t_, quantum_t_;
  Eigen::Matrix3d soft_iron_;
  Eigen::Vector3d hard_iron_t_;
};

}  // namespace tumble::sim
