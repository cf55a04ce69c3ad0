// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/beam_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace tumble::sim {

namespace {

constexpr double kRevolution_rad = 6.283185307179586;
constexpr int kAzimuthCells = 2048;  // 3 mrad per cell

std::int64_t period_ns(const Values& values, const char* name) {
  return std::llround(values.at(name) * 1e9);
}

}  // namespace

SpinningPattern::SpinningPattern(const Values& values)
    : rate_rad_ns_(kRevolution_rad * values.at("spin_rate_hz") * 1e-9),
      sense_(values.at("clockwise") != 0.0 ? -1.0 : 1.0),
      mirror_radius_m_(values.at("mirror_radius_m")),
      mirror_drop_m_(values.at("mirror_drop_m")),
      driver_stamp_fault_(values.at("driver_stamp_fault") != 0.0) {
  sweep_period_ns_ = std::llround(1e9 / values.at("spin_rate_hz"));
  const bool current = values.at("current_driver_timing") != 0.0;
  firing_period_ns_ = current ? 2800 : period_ns(values, "firing_period_s");
  slot_period_ns_ = current ? 55500 : period_ns(values, "sequence_period_s");
  if (slot_length_ns() >= slot_period_ns_) {
    throw InvalidSituation("spinning_lidar: sequence_period_s must be at least sixteen times firing_period_s");
  }
  std::array<double, kMaxChannels> elevation_rad;
  for (int c = 0; c < kMaxChannels; ++c) {
    char name[32];
    std::snprintf(name, sizeof name, "elevation_%02d_rad", c + 1);
    elevation_rad[c] = values.at(name);
    cos_elevation_[c] = std::cos(elevation_rad[c]);
    sin_elevation_[c] = std::sin(elevation_rad[c]);
    const double lag_rad = rate_rad_ns_ * static_cast<double>(lag_ns(c));
    cos_lag_[c] = std::cos(lag_rad);
    sin_lag_[c] = std::sin(lag_rad);
  }
  for (int c = 0; c < kMaxChannels; ++c) {
    ring_[c] = static_cast<std::uint16_t>(
        std::count_if(elevation_rad.begin(), elevation_rad.end(), [&](double e) { return e < elevation_rad[c]; }));
  }
}

std::uint32_t SpinningPattern::reported_start_ns(std::int64_t sweep, std::int64_t slot) const {
  constexpr std::int64_t kPacket = 24;  // two sequences per block
  std::int64_t start_ns = slot * slot_period_ns_ - sweep * sweep_period_ns_;
  if (driver_stamp_fault_) {
    const std::int64_t in_packet = (slot - first_slot(sweep)) % kPacket;
    start_ns -= (in_packet - in_packet / 2) * slot_period_ns_;
  }
  return static_cast<std::uint32_t>(start_ns);
}

[[gnu::target("avx2")]] void SpinningPattern::aim(const std::array<double, kLanes>& azimuth_rad,
                                                  FiringBlock& block) const {
  alignas(64) double cos_start[kLanes], sin_start[kLanes];
  for (int s = 0; s < kLanes; ++s) {
    cos_start[s] = std::cos(azimuth_rad[s]);
    sin_start[s] = std::sin(azimuth_rad[s]);
  }
  for (int c = 0; c < kMaxChannels; ++c) {
    ChannelFirings& out = block.channel[c];
    const double cos_lag = cos_lag_[c], sin_lag = sin_lag_[c], sense = sense_, radius_m = mirror_radius_m_,
                 drop_m = mirror_drop_m_, cos_elevation = cos_elevation_[c], sin_elevation = sin_elevation_[c];
    for (int s = 0; s < kLanes; ++s) {
      const double cos_azimuth = cos_start[s] * cos_lag - sin_start[s] * sin_lag;
      const double sin_azimuth = sense * (sin_start[s] * cos_lag + cos_start[s] * sin_lag);
      out.origin_x_m[s] = radius_m * cos_azimuth;
      out.origin_y_m[s] = radius_m * sin_azimuth;
      out.origin_z_m[s] = -drop_m;
      out.direction_x[s] = cos_elevation * cos_azimuth;
      out.direction_y[s] = cos_elevation * sin_azimuth;
      out.direction_z[s] = sin_elevation;
    }
  }
}

void SpinningPattern::fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const {
  block.first_slot = slot;
  block.slots = slots;
  std::array<double, kLanes> azimuth_rad;
  for (int s = 0; s < kLanes; ++s) {
    block.start_ns[s] = (slot + s) * slot_period_ns_;
    block.reported_ns[s] = reported_start_ns(sweep, slot + s);
    azimuth_rad[s] = rate_rad_ns_ * static_cast<double>(block.start_ns[s] - sweep * sweep_period_ns_);
    block.cell[s] = static_cast<int>(azimuth_rad[s] * (kAzimuthCells / kRevolution_rad)) % kAzimuthCells;
  }
  aim(azimuth_rad, block);
}

int SpinningPattern::cells() const {
  return kAzimuthCells;
}

double SpinningPattern::cell_half_angle_rad() const {
  return 0.5 * kRevolution_rad / kAzimuthCells;
}

void SpinningPattern::fire_cells(int first, FiringBlock& block) const {
  std::array<double, kLanes> azimuth_rad;
  for (int s = 0; s < kLanes; ++s) azimuth_rad[s] = (first + s + 0.5) * (kRevolution_rad / kAzimuthCells);
  aim(azimuth_rad, block);
}

ColumnPattern::ColumnPattern(const Values& values)
    : rate_rad_ns_(kRevolution_rad * values.at("spin_rate_hz") * 1e-9),
      sense_(values.at("clockwise") != 0.0 ? -1.0 : 1.0),
      lowest_rad_(values.at("elevation_low_rad")),
      shift_share_(values.at("elevation_shift_share")) {
  const double rings = values.at("rings");
  banks_ = static_cast<int>(rings) / kMaxChannels;
  if (rings != static_cast<double>(banks_ * kMaxChannels))
    throw InvalidSituation("column_lidar: rings must be a multiple of 16");
  if (values.at("elevation_high_rad") <= lowest_rad_)
    throw InvalidSituation("column_lidar: elevation_high_rad must be greater than elevation_low_rad");
  spacing_rad_ = (values.at("elevation_high_rad") - lowest_rad_) / (rings - 1.0);
  sweep_period_ns_ = std::llround(1e9 / values.at("spin_rate_hz"));
  slot_period_ns_ = period_ns(values, "column_period_s") / banks_;
  firing_period_ns_ = period_ns(values, "firing_period_s");
  if (slot_length_ns() >= slot_period_ns_)
    throw InvalidSituation("column_lidar: rings times firing_period_s must fit into column_period_s");
  for (int c = 0; c < kMaxChannels; ++c) ring_[c] = static_cast<std::uint16_t>(c);
}

[[gnu::target("avx2")]] void ColumnPattern::fire(std::int64_t sweep, std::int64_t slot, int slots,
                                                 FiringBlock& block) const {
  block.first_slot = slot;
  block.slots = slots;
  const double shift = shift_share_ * static_cast<double>(sweep);
  const double lowest_rad = lowest_rad_ + spacing_rad_ * (shift - std::floor(shift));
  for (int s = 0; s < kLanes; ++s) {
    block.start_ns[s] = (slot + s) * slot_period_ns_;
    block.reported_ns[s] = static_cast<std::uint32_t>(block.start_ns[s] - sweep * sweep_period_ns_);
  }
  for (int c = 0; c < channels_; ++c) {
    ChannelFirings& out = block.channel[c];
    for (int s = 0; s < kLanes; ++s) {
      const double azimuth_rad =
          rate_rad_ns_ * static_cast<double>(block.start_ns[s] + lag_ns(c) - sweep * sweep_period_ns_);
      const double elevation_rad = lowest_rad + spacing_rad_ * ring(c, slot + s);
      out.origin_x_m[s] = out.origin_y_m[s] = out.origin_z_m[s] = 0.0;
      out.direction_x[s] = std::cos(elevation_rad) * std::cos(azimuth_rad);
      out.direction_y[s] = sense_ * std::cos(elevation_rad) * std::sin(azimuth_rad);
      out.direction_z[s] = std::sin(elevation_rad);
    }
  }
}

RosettePattern::RosettePattern(const Values& values) {
  const double units = values.at("units");
  if (units != std::floor(units)) throw InvalidSituation("rosette_lidar: units must be a whole number");
  channels_ = static_cast<int>(units);
  sweep_period_ns_ = period_ns(values, "sweep_period_s");
  slot_period_ns_ = period_ns(values, "point_period_s");
  const double rate_1_hz = values.at("prism_1_rate_hz"), rate_2_hz = values.at("prism_2_rate_hz");
  const std::array<double, 3> rate_hz = {rate_1_hz, rate_2_hz, 2.0 * rate_1_hz - rate_2_hz};
  const std::array<double, 3> amplitude = {values.at("prism_1_amplitude"), values.at("prism_2_amplitude"),
                                           values.at("mixed_amplitude")};
  for (int k = 0; k < 3; ++k) {
    Term& term = terms_[k];
    term.amplitude = amplitude[k];
    term.rate_rad_ns = kRevolution_rad * rate_hz[k] * 1e-9;
    for (int i = 0; i < kLanes; ++i) {
      const double lag_rad = term.rate_rad_ns * static_cast<double>(i * slot_period_ns_);
      term.cos_lag[i] = std::cos(lag_rad);
      term.sin_lag[i] = std::sin(lag_rad);
    }
  }
  for (int unit = 0; unit < channels_; ++unit) {
    const double yaw_rad = (unit - 0.5 * (channels_ - 1)) * values.at("unit_spacing_rad");
    cos_yaw_[unit] = std::cos(yaw_rad);
    sin_yaw_[unit] = std::sin(yaw_rad);
    ring_[unit] = static_cast<std::uint16_t>(unit);
  }
}

[[gnu::target("avx2")]] void RosettePattern::fire(std::int64_t sweep, std::int64_t slot, int slots,
                                                  FiringBlock& block) const {
  block.first_slot = slot;
  block.slots = slots;
  const std::int64_t start_ns = slot * slot_period_ns_;
  alignas(64) double x[kLanes], y[kLanes] = {}, z[kLanes] = {};  // beam of an unrotated unit
  for (const Term& term : terms_) {
    const double phase_rad = term.rate_rad_ns * static_cast<double>(start_ns);
    const double cos_start = term.amplitude * std::cos(phase_rad), sin_start = term.amplitude * std::sin(phase_rad);
    for (int s = 0; s < kLanes; ++s) {
      y[s] += cos_start * term.cos_lag[s] - sin_start * term.sin_lag[s];
      z[s] += sin_start * term.cos_lag[s] + cos_start * term.sin_lag[s];
    }
  }
  for (int s = 0; s < kLanes; ++s) {
    block.start_ns[s] = start_ns + s * slot_period_ns_;
    block.reported_ns[s] = static_cast<std::uint32_t>(block.start_ns[s] - sweep * sweep_period_ns_);
    x[s] = 1.0 / std::sqrt(1.0 + y[s] * y[s] + z[s] * z[s]);
    y[s] *= x[s];
    z[s] *= x[s];
  }
  for (int unit = 0; unit < channels_; ++unit) {
    ChannelFirings& out = block.channel[unit];
    const double cos_yaw = cos_yaw_[unit], sin_yaw = sin_yaw_[unit];
    for (int s = 0; s < kLanes; ++s) {
      out.origin_x_m[s] = out.origin_y_m[s] = out.origin_z_m[s] = 0.0;
      out.direction_x[s] = cos_yaw * x[s] - sin_yaw * y[s];
      out.direction_y[s] = sin_yaw * x[s] + cos_yaw * y[s];
      out.direction_z[s] = z[s];
    }
  }
}

}  // namespace tumble::sim
