// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/reference_clipping.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "scenarios/recordings/upper_median.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kNearExtreme = 0.95, kAtPlane = 0.02;
constexpr double kBeyondErrorsShare = 0.02, kBeyondErrors = 4.0;
constexpr std::size_t kLeastSamples = 5;
constexpr double kSlopePrior = 0.03, kSpread_rad_s = 0.02;

struct Side {
  int axis, first, second;
  double sign;
};

Side side_of(std::size_t i) {
  const int axis = static_cast<int>(i / 2);
  return {axis, axis == 0 ? 1 : 0, axis == 2 ? 1 : 2, i % 2 == 0 ? 1.0 : -1.0};
}

double plane_at(const ReferenceRail& rail, const Side& side, const Eigen::Vector3d& y) {
  return rail.rail_rad_s + rail.slopes[0] * y[side.first] + rail.slopes[1] * y[side.second];
}

ReferenceRail fit(const Side& side, std::span<const Eigen::Vector3d> readings) {
  Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& y : readings) {
    const Eigen::Vector3d row(1.0, y[side.first], y[side.second]);
    N += row * row.transpose();
    b += side.sign * y[side.axis] * row;
  }
  const double prior = kSpread_rad_s * kSpread_rad_s / (kSlopePrior * kSlopePrior);
  N(1, 1) += prior;
  N(2, 2) += prior;
  const Eigen::Vector3d x = N.ldlt().solve(b);
  return {true, x[0], x.tail<2>()};
}

ReferenceRail find_rail(const Side& side, std::span<const Eigen::Vector3d> reading,
                        std::span<const Eigen::Vector3d> reference) {
  double extreme = 0.0;
  std::vector<double> errors;
  for (std::size_t k = 0; k < reading.size(); ++k) {
    extreme = std::max(extreme, side.sign * reading[k][side.axis]);
    if (reference[k].allFinite()) errors.push_back(std::abs(reading[k][side.axis] - reference[k][side.axis]));
  }
  const double beyond = std::max(kBeyondErrorsShare * extreme, kBeyondErrors * upper_median(std::move(errors)));
  std::vector<Eigen::Vector3d> held;
  std::size_t near = 0;
  for (std::size_t k = 0; k < reading.size(); ++k) {
    const double y = side.sign * reading[k][side.axis], w = side.sign * reference[k][side.axis];
    if (!reference[k].allFinite() || y < kNearExtreme * extreme || extreme <= 0.0) continue;
    ++near;
    if (w > y + beyond) held.push_back(reading[k]);
  }
  if (held.size() < kLeastSamples || 2 * held.size() < near) return {};
  const ReferenceRail first = fit(side, held);
  std::erase_if(held, [&](const Eigen::Vector3d& y) {
    return std::abs(side.sign * y[side.axis] - plane_at(first, side, y)) > kAtPlane * first.rail_rad_s;
  });
  return held.size() < kLeastSamples ? ReferenceRail{} : fit(side, held);
}

}  // namespace

std::array<ReferenceRail, 6> reference_rails(std::span<const Eigen::Vector3d> reading,
                                             std::span<const Eigen::Vector3d> reference) {
  std::array<ReferenceRail, 6> rails;
  for (std::size_t i = 0; i < rails.size(); ++i) rails[i] = find_rail(side_of(i), reading, reference);
  return rails;
}

std::vector<std::uint8_t> clipped_by_reference(std::span<const Eigen::Vector3d> reading,
                                               std::span<const Eigen::Vector3d> reference) {
  const std::array<ReferenceRail, 6> rails = reference_rails(reading, reference);
  std::vector<std::uint8_t> clipped(reading.size(), 0);
  for (std::size_t i = 0; i < rails.size(); ++i) {
    if (!rails[i].found) continue;
    const Side side = side_of(i);
    for (std::size_t k = 0; k < reading.size(); ++k) {
      const double least = (1.0 - kAtPlane) * plane_at(rails[i], side, reading[k]);
      const bool at = side.sign * reading[k][side.axis] >= least && side.sign * reference[k][side.axis] >= least;
      if (at && reference[k].allFinite()) clipped[k] = static_cast<std::uint8_t>(clipped[k] | (1u << side.axis));
    }
  }
  return clipped;
}

}  // namespace tumble::scenarios
