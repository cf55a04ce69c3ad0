// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "sim/lidar/ray_scene.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Most beams of a slot.
inline constexpr int kMaxChannels = 16;

/// One channel's firings in kLanes consecutive slots: where from and where to, in the axes of L.
struct ChannelFirings {
  alignas(64) double origin_x_m[kLanes], origin_y_m[kLanes], origin_z_m[kLanes];
  alignas(64) double direction_x[kLanes], direction_y[kLanes], direction_z[kLanes];  ///< unit
};

/// The firings of up to kLanes consecutive slots. Neighbouring lanes look in almost the same direction, which is what
/// makes a packet of rays cheap to cast; all kLanes lanes are filled, also those beyond `slots`.
struct FiringBlock {
  std::int64_t first_slot = 0;  ///< counted from the recording's start: unique, the key of the random numbers
  int slots = 0;
  std::array<std::int64_t, kLanes> start_ns{};      ///< true, since the recording's start
  std::array<std::uint32_t, kLanes> reported_ns{};  ///< of the slot's start, since the sweep's start
  std::array<int, kLanes> cell{};                   ///< of the slot, see BeamPattern::cells()
  std::array<ChannelFirings, kMaxChannels> channel;
};

/// The firings of a lidar. A slot is a sequence of all channels (spinning) or an instant at which all units fire
/// (rosette); slot k starts at k times the slot period, also across sweeps, and belongs to the sweep that it starts in.
class BeamPattern {
 public:
  virtual ~BeamPattern() = default;

  std::int64_t sweep_period_ns() const { return sweep_period_ns_; }
  std::int64_t first_slot(std::int64_t sweep) const {
    return (sweep * sweep_period_ns_ + slot_period_ns_ - 1) / slot_period_ns_;
  }
  int channels() const { return channels_; }
  /// True and reported time from a slot's start to the firing of a channel.
  std::int64_t lag_ns(int channel) const { return channel * firing_period_ns_; }
  /// Longest time from a slot's start to its last firing.
  std::int64_t slot_length_ns() const { return lag_ns(channels_ - 1); }
  std::uint16_t ring(int channel) const { return ring_[channel]; }

  /// The firings of the slots `slot` to `slot + slots - 1` of a sweep, at most kLanes.
  virtual void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const = 0;

  /// Number of cells that all slots fall into by their directions, so that something can be worked out beforehand per
  /// channel and cell; 0 when the pattern does not repeat.
  virtual int cells() const { return 0; }
  /// No firing of a cell lies farther from the firing at its middle than this angle about the z axis of L.
  virtual double cell_half_angle_rad() const { return 0.0; }
  /// Origins and directions at the middles of the cells `first` to `first + kLanes - 1`.
  virtual void fire_cells(int /*first*/, FiringBlock& /*block*/) const {}

 protected:
  std::int64_t sweep_period_ns_ = 0, slot_period_ns_ = 0, firing_period_ns_ = 0;
  int channels_ = kMaxChannels;
  std::array<std::uint16_t, kMaxChannels> ring_{};
};

/// A column of lasers about the z axis. The azimuth is zero (along x of L) at each sweep's start and grows clockwise
/// seen from above. Channel c of sequence k fires at k P + c p; its beam leaves the mirror at R1 from the axis and R2
/// below the origin. Rings count from the lowest elevation up. (RoboSense RS-16 User's Guide v4.0 and the published
/// driver.)
class SpinningPattern final : public BeamPattern {
 public:
  explicit SpinningPattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const override;
  int cells() const override;
  double cell_half_angle_rad() const override;
  void fire_cells(int first, FiringBlock& block) const override;

 private:
  std::uint32_t reported_start_ns(std::int64_t sweep, std::int64_t slot) const;
  /// Fills all channels from the azimuth at the start of each lane's slot.
  void aim(const std::array<double, kLanes>& azimuth_rad, FiringBlock& block) const;

  double rate_rad_ns_, sense_, mirror_radius_m_, mirror_drop_m_;
  bool driver_stamp_fault_;
  std::array<double, kMaxChannels> cos_elevation_, sin_elevation_, cos_lag_,
      sin_lag_;  ///< lag: azimuth since the sequence's start
};

/// A beam bent by two prisms turning at constant rates, repeated by units yawed apart: y/x + i z/x of the beam is
/// A exp(i w1 t) + B exp(i w2 t) + C exp(i (2 w1 - w2) t), t from the recording's start. Rings are the units, from the
/// right (negative yaw) to the left; all share the origin of L.
class RosettePattern final : public BeamPattern {
 public:
  explicit RosettePattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, FiringBlock& block) const override;

 private:
  struct Term {
    double amplitude, rate_rad_ns;
    std::array<double, kLanes> cos_lag, sin_lag;  ///< phase since the block's first slot
  };
  std::array<Term, 3> terms_;
  std::array<double, 3> cos_yaw_, sin_yaw_;
};

}  // namespace tumble::sim
