// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/motion_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tumble::scenarios {

namespace {

constexpr std::size_t kCells = MotionMap::kCells;
constexpr double kMargin = 0.25;

struct Decades {
  double rate, force;
};

struct GridAxis {
  double low = 0.0, step = 1.0;
  double width = 0.0;  ///< width of the kernel in cells

  std::size_t cell(double value) const {
    const double at = std::floor((value - low) / step);
    return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kCells - 1)));
  }
  double centre(std::size_t cell) const { return std::pow(10.0, low + (static_cast<double>(cell) + 0.5) * step); }
};

GridAxis axis_over(const std::vector<Decades>& points, double Decades::*member) {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0, square = 0.0;
  for (const Decades& point : points) {
    low = std::min(low, point.*member);
    high = std::max(high, point.*member);
    sum += point.*member;
  }
  const double count = static_cast<double>(points.size()), mean = sum / count;
  for (const Decades& point : points) square += (point.*member - mean) * (point.*member - mean);
  GridAxis axis;
  axis.low = low - kMargin;
  axis.step = (high - low + 2.0 * kMargin) / static_cast<double>(kCells);
  axis.width = std::max(0.5, std::sqrt(square / count) * std::pow(count, -1.0 / 6.0) / axis.step);
  return axis;
}

std::vector<double> kernel(std::size_t from, double width) {
  std::vector<double> weights(kCells);
  double sum = 0.0;
  for (std::size_t i = 0; i < kCells; ++i) {
    const double away = (static_cast<double>(i) - static_cast<double>(from)) / width;
    sum += weights[i] = std::exp(-0.5 * away * away);
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::vector<double> smoothed(const std::vector<double>& counts, const GridAxis& rate, const GridAxis& force) {
  std::vector<double> along(kCells * kCells), out(kCells * kCells);
  for (std::size_t from = 0; from < kCells; ++from) {
    const std::vector<double> weights = kernel(from, rate.width);
    for (std::size_t row = 0; row < kCells; ++row) {
      const double count = counts[row * kCells + from];
      if (count == 0.0) continue;
      for (std::size_t i = 0; i < kCells; ++i) along[row * kCells + i] += count * weights[i];
    }
  }
  for (std::size_t from = 0; from < kCells; ++from) {
    const std::vector<double> weights = kernel(from, force.width);
    for (std::size_t row = 0; row < kCells; ++row) {
      for (std::size_t i = 0; i < kCells; ++i) out[row * kCells + i] += along[from * kCells + i] * weights[row];
    }
  }
  return out;
}

std::vector<MotionPoint> thinned(const std::vector<MotionPoint>& points) {
  const std::size_t stride = (points.size() + MotionMap::kPointsMax - 1) / MotionMap::kPointsMax;
  std::vector<MotionPoint> out;
  for (std::size_t i = 0; i < points.size(); i += stride) out.push_back(points[i]);
  return out;
}

/// The ICRA 2024 paper by Deschênes et al. reports rates and forces of the rig; the CRV 2021 paper reports an angular
/// acceleration and forces.
std::vector<PublishedExtreme> published() {
  return {{"rig that tumbled down a hill 32 times",
           "Deschênes and others, ICRA 2024: up to 18.6 rad/s and 157.8 m/s² (the accelerometer has a range of 16 g)",
           18.6, 157.8},
          {"collisions of a rig", "Deschênes and others, CRV 2021: up to 200 m/s²; the paper does not state rates",
           std::numeric_limits<double>::quiet_NaN(), 200.0}};
}

}  // namespace

MotionMap motion_map(std::span<const DrawValues> draws) {
  MotionMap map;
  std::map<std::string, std::size_t> place;
  std::vector<Decades> all;
  for (const DrawValues& draw : draws) {
    const MotionPoint point{value_of(draw.values, "motion_peak_rate_rad_s"),
                            value_of(draw.values, "motion_peak_accel_m_s2")};
    if (!(point.rate_rad_s > 0.0 && point.force_m_s2 > 0.0) || !std::isfinite(point.rate_rad_s + point.force_m_s2))
      continue;
    const auto [at, is_new] = place.emplace(draw.scenario, map.clouds.size());
    if (is_new) map.clouds.push_back({draw.scenario, 0, {}});
    map.clouds[at->second].points.push_back(point);
    all.push_back({std::log10(point.rate_rad_s), std::log10(point.force_m_s2)});
  }
  if (all.empty()) return map;
  const GridAxis rate = axis_over(all, &Decades::rate), force = axis_over(all, &Decades::force);
  std::vector<double> shares(kCells * kCells);
  for (const Decades& point : all)
    shares[force.cell(point.force) * kCells + rate.cell(point.rate)] += 1.0 / static_cast<double>(all.size());
  map.share = smoothed(shares, rate, force);
  for (std::size_t i = 0; i < kCells; ++i) {
    map.rate_rad_s.push_back(rate.centre(i));
    map.force_m_s2.push_back(force.centre(i));
  }
  for (MotionCloud& cloud : map.clouds) {
    cloud.draws = cloud.points.size();
    cloud.points = thinned(cloud.points);
  }
  map.extremes = published();
  return map;
}

}  // namespace tumble::scenarios
