// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/beam_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace tumble::sim {

namespace {

constexpr double kTurn_rad = 6.283185307179586;

std::int64_t period_ns(const Values& values, const char* name) {
  return std::llround(values.at(name) * 1e9);
}

}  // namespace

SpinningPattern::SpinningPattern(const Values& values)
    : turn_rad_ns_(kTurn_rad * values.at("spin_rate_hz") * 1e-9),
      sense_(values.at("clockwise") != 0.0 ? -1.0 : 1.0),
      mirror_radius_m_(values.at("mirror_radius_m")),
      mirror_drop_m_(values.at("mirror_drop_m")),
      firing_period_ns_(period_ns(values, "firing_period_s")),
      driver_stamp_fault_(values.at("driver_stamp_fault") != 0.0) {
  sweep_period_ns_ = std::llround(1e9 / values.at("spin_rate_hz"));
  slot_period_ns_ = period_ns(values, "sequence_period_s");
  slot_length_ns_ = (kLanes - 1) * firing_period_ns_;
  if (slot_length_ns_ >= slot_period_ns_) {
    throw InvalidSituation("spinning_lidar: sixteen times firing_period_s must fit into sequence_period_s");
  }
  std::array<double, kLanes> elevation_rad;
  for (int c = 0; c < kLanes; ++c) {
    char name[32];
    std::snprintf(name, sizeof name, "elevation_%02d_rad", c + 1);
    elevation_rad[c] = values.at(name);
    cos_elevation_[c] = std::cos(elevation_rad[c]);
    sin_elevation_[c] = std::sin(elevation_rad[c]);
    const double lag_rad = turn_rad_ns_ * static_cast<double>(c * firing_period_ns_);
    cos_lag_[c] = std::cos(lag_rad);
    sin_lag_[c] = std::sin(lag_rad);
  }
  for (int c = 0; c < kLanes; ++c) {
    ring_[c] = static_cast<std::uint16_t>(
        std::count_if(elevation_rad.begin(), elevation_rad.end(), [&](double e) { return e < elevation_rad[c]; }));
  }
}

std::uint32_t SpinningPattern::reported_offset_ns(std::int64_t sweep, std::int64_t slot, int channel) const {
  constexpr std::int64_t kPacket = 24;  // sequences, two to a block
  std::int64_t start_ns = slot * slot_period_ns_ - sweep * sweep_period_ns_;
  if (driver_stamp_fault_) {
    const std::int64_t in_packet = (slot - first_slot(sweep)) % kPacket;
    start_ns -= (in_packet - in_packet / 2) * slot_period_ns_;
  }
  return static_cast<std::uint32_t>(start_ns + channel * firing_period_ns_);
}

void SpinningPattern::fire(std::int64_t sweep, std::int64_t slot, int /*slots*/, Firings& out) const {
  const std::int64_t start_ns = slot * slot_period_ns_;
  const double azimuth_rad = turn_rad_ns_ * static_cast<double>(start_ns - sweep * sweep_period_ns_);
  const double cos_start = std::cos(azimuth_rad), sin_start = std::sin(azimuth_rad);
  out.count = kLanes;
  out.slot = slot;
  for (int c = 0; c < kLanes; ++c) {
    const double cos_azimuth = cos_start * cos_lag_[c] - sin_start * sin_lag_[c];
    const double sin_azimuth = sense_ * (sin_start * cos_lag_[c] + cos_start * sin_lag_[c]);
    out.origin_x_m[c] = mirror_radius_m_ * cos_azimuth;
    out.origin_y_m[c] = mirror_radius_m_ * sin_azimuth;
    out.origin_z_m[c] = -mirror_drop_m_;
    out.direction_x[c] = cos_elevation_[c] * cos_azimuth;
    out.direction_y[c] = cos_elevation_[c] * sin_azimuth;
    out.direction_z[c] = sin_elevation_[c];
    out.time_ns[c] = start_ns + c * firing_period_ns_;
    out.offset_ns[c] = reported_offset_ns(sweep, slot, c);
    out.ring[c] = ring_[c];
  }
}

RosettePattern::RosettePattern(const Values& values) {
  const double units = values.at("units");
  if (units != std::floor(units)) throw InvalidSituation("rosette_lidar: units must be a whole number");
  lanes_ = static_cast<int>(units);
  sweep_period_ns_ = period_ns(values, "sweep_period_s");
  slot_period_ns_ = period_ns(values, "point_period_s");
  const double rate_1_hz = values.at("prism_1_rate_hz"), rate_2_hz = values.at("prism_2_rate_hz");
  const std::array<double, 3> rate_hz = {rate_1_hz, rate_2_hz, 2.0 * rate_1_hz - rate_2_hz};
  const std::array<double, 3> amplitude = {values.at("prism_1_amplitude"), values.at("prism_2_amplitude"),
                                           values.at("mixed_amplitude")};
  for (int k = 0; k < 3; ++k) {
    Term& term = terms_[k];
    term.amplitude = amplitude[k];
    term.turn_rad_ns = kTurn_rad * rate_hz[k] * 1e-9;
    for (int i = 0; i < kLanes; ++i) {
      const double lag_rad = term.turn_rad_ns * static_cast<double>(i * slot_period_ns_);
      term.cos_lag[i] = std::cos(lag_rad);
      term.sin_lag[i] = std::sin(lag_rad);
    }
  }
  for (int unit = 0; unit < lanes_; ++unit) {
    const double yaw_rad = (unit - 0.5 * (lanes_ - 1)) * values.at("unit_spacing_rad");
    cos_yaw_[unit] = std::cos(yaw_rad);
    sin_yaw_[unit] = std::sin(yaw_rad);
  }
}

void RosettePattern::fire(std::int64_t sweep, std::int64_t slot, int slots, Firings& out) const {
  const std::int64_t start_ns = slot * slot_period_ns_;
  std::array<double, 3> cos_start, sin_start;
  for (int k = 0; k < 3; ++k) {
    const double phase_rad = terms_[k].turn_rad_ns * static_cast<double>(start_ns);
    cos_start[k] = terms_[k].amplitude * std::cos(phase_rad);
    sin_start[k] = terms_[k].amplitude * std::sin(phase_rad);
  }
  out.count = slots * lanes_;
  out.slot = slot;
  for (int i = 0; i < slots; ++i) {
    double y = 0.0, z = 0.0;
    for (int k = 0; k < 3; ++k) {
      y += cos_start[k] * terms_[k].cos_lag[i] - sin_start[k] * terms_[k].sin_lag[i];
      z += sin_start[k] * terms_[k].cos_lag[i] + cos_start[k] * terms_[k].sin_lag[i];
    }
    const double scale = 1.0 / std::sqrt(1.0 + y * y + z * z);
    const std::int64_t time_ns = start_ns + i * slot_period_ns_;
    for (int unit = 0; unit < lanes_; ++unit) {
      const int lane = i * lanes_ + unit;
      out.origin_x_m[lane] = out.origin_y_m[lane] = out.origin_z_m[lane] = 0.0;
      out.direction_x[lane] = scale * (cos_yaw_[unit] - sin_yaw_[unit] * y);
      out.direction_y[lane] = scale * (sin_yaw_[unit] + cos_yaw_[unit] * y);
      out.direction_z[lane] = scale * z;
      out.time_ns[lane] = time_ns;
      out.offset_ns[lane] = static_cast<std::uint32_t>(time_ns - sweep * sweep_period_ns_);
      out.ring[lane] = static_cast<std::uint16_t>(unit);
    }
  }
}

}  // namespace tumble::sim
