// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "sim/lidar/ray_scene.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// largest number of lasers (channels) that fire in one sequence
inline constexpr int kMaxChannels = 16;

struct ChannelFirings {
  alignas(64) double origin_x_m[kLanes], origin_y_m[kLanes], origin_z_m[kLanes];
  alignas(64) double direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< unit vectors
};

struct FiringBlock {
  std::int64_t first_slot = 0;
  int slots = 0;
  std::array<std::int64_t, kLanes> start_ns{};      ///< true firing time since the recording's start
  std::array<std::uint32_t, kLanes> reported_ns{};  ///< reported firing time since the sweep's start
  std::array<int, kLanes> cell{};                   ///< azimuth cell: BeamPattern::cells()
  std::array<ChannelFirings, kMaxChannels> channel;
};

/// BeamPattern contains the times and directions of the laser pulses of a lidar. A slot is one firing sequence of all
/// lasers (spinning lidar), or one instant at which all lidar units fire (rosette lidar). Slot number k starts at the
/// time k times the slot period, and the slot numbers continue from sweep to sweep.
class BeamPattern {
 public:
  virtual ~BeamPattern() = default;

  std::int64_t sweep_period_ns() const { return sweep_period_ns_; }
  std::int64_t first_slot(std::int64_t sweep) const {
    return (sweep * sweep_period_ns_ + slot_period_ns_ - 1) / slot_period_ns_;
  }
  int channels() const { return channels_; }
  std::int64_t lag_ns(int channel) const { return channel * firing_period_ns_; }
  std::int64_t slot_length_ns() const { return lag_ns(channels_ - 1); }
  std::uint16_t ring(int channel, std::int64_t slot) const {
    return static_cast<std::uint16_t>(ring_[channel] + channels_ * (slot % banks_));
  }

  virtual void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const = 0;

  /// Returns the number of azimuth cells (intervals of azimuth) in a sweep, or 0 if the firing pattern changes from
  /// sweep to sweep.
  virtual int cells() const { return 0; }
  virtual double cell_half_angle_rad() const { return 0.0; }
  virtual void fire_cells(int /*first*/, FiringBlock& /*block*/) const {}

 protected:
  std::int64_t sweep_period_ns_ = 0, slot_period_ns_ = 0, firing_period_ns_ = 0;
  int channels_ = kMaxChannels;
  int banks_ = 1;  ///< number of slots in which all rings fire once
  std::array<std::uint16_t, kMaxChannels> ring_{};
};

/// Firing pattern of a spinning lidar, in which a column of lasers rotates about the z axis. The azimuth is zero (along
/// the lidar's x axis) at the start of each sweep, and increases clockwise seen from above. In firing sequence k, laser
/// c fires at the time k P + c p, with the sequence period P and the firing period p. Timing and geometry are from the
/// RoboSense RS-16 User's Guide v4.0 and the published driver.
class SpinningPattern final : public BeamPattern {
 public:
  explicit SpinningPattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const override;
  int cells() const override;
  double cell_half_angle_rad() const override;
  void fire_cells(int first, FiringBlock& block) const override;

 private:
  std::uint32_t reported_start_ns(std::int64_t sweep, std::int64_t slot) const;
  void aim(const std::array<double, kLanes>& azimuth_rad, FiringBlock& block) const;

  double rate_rad_ns_, sense_, mirror_radius_m_, mirror_drop_m_;
  bool driver_stamp_fault_;
  std::array<double, kMaxChannels> cos_elevation_, sin_elevation_, cos_lag_,
      sin_lag_;  ///< cosine and sine of the azimuth change within a sequence, for each laser
};

/// Firing pattern of a lidar with up to 128 evenly spaced rings, in which a column of lasers rotates about the z axis.
/// The lasers of the column fire in groups of 16 rings from bottom to top, and the groups are evenly distributed over
/// the firing period of the column. From sweep to sweep, the elevations may increase by a fraction of the ring spacing,
/// which approximates scan patterns that do not repeat.
class ColumnPattern final : public BeamPattern {
 public:
  explicit ColumnPattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const override;

 private:
  double rate_rad_ns_, sense_, lowest_rad_, spacing_rad_, shift_share_;
};

/// Firing pattern of a rosette lidar with one or several units. In each unit, two prisms that rotate at constant rates
/// deflect the beam. The lateral deflection of the beam is the sum of three rotating vectors, with the rates w1 and w2
/// of the two prisms and the rate 2 w1 - w2. The ring number is the number of the lidar unit, from right (negative yaw)
/// to left.
class RosettePattern final : public BeamPattern {
 public:
  explicit RosettePattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const override;

 private:
  struct Term {
    double amplitude, rate_rad_ns;
    std::array<double, kLanes> cos_lag, sin_lag;  ///< cosine and sine of the vector's rotation within a block
  };
  std::array<Term, 3> terms_;
  std::array<double, 3> cos_yaw_, sin_yaw_;
};

}  // namespace tumble::sim
