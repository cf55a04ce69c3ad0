// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "sim/lidar/ray_scene.hpp"
#include "sim/situation.hpp"

namespace tumble::sim {

/// Up to sixteen firings in the order of time: when, from where and where to, in the axes of L.
struct Firings {
  int count = 0;
  std::int64_t slot =
      0;  ///< number of the first slot since the recording's start: unique, the key of the random numbers
  std::array<std::int64_t, kLanes> time_ns;     ///< true, since the recording's start
  std::array<std::uint32_t, kLanes> offset_ns;  ///< reported, since the sweep's start
  std::array<std::uint16_t, kLanes> ring;
  std::array<double, kLanes> origin_x_m, origin_y_m, origin_z_m;
  std::array<double, kLanes> direction_x, direction_y, direction_z;  ///< unit
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
  int lanes() const { return lanes_; }  ///< firings of a slot
  int slots_at_once() const { return kLanes / lanes_; }
  /// Longest time from a slot's start to its last firing.
  std::int64_t slot_length_ns() const { return slot_length_ns_; }

  /// The firings of the slots `slot` to `slot + slots - 1` of a sweep, at most slots_at_once().
  virtual void fire(std::int64_t sweep, std::int64_t slot, int slots, Firings& firings) const = 0;

 protected:
  std::int64_t sweep_period_ns_ = 0, slot_period_ns_ = 0, slot_length_ns_ = 0;
  int lanes_ = kLanes;
};

/// A column of lasers about the z axis. The azimuth is zero (along x of L) at each sweep's start and grows clockwise
/// seen from above. Channel c of sequence k fires at k P + c p; its beam leaves the mirror at R1 from the axis and R2
/// below the origin. Rings count from the lowest elevation up. (RoboSense RS-16 User's Guide v4.0 and the published
/// driver.)
class SpinningPattern final : public BeamPattern {
 public:
  explicit SpinningPattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, Firings& firings) const override;

 private:
  std::uint32_t reported_offset_ns(std::int64_t sweep, std::int64_t slot, int channel) const;

  double turn_rad_ns_, sense_, mirror_radius_m_, mirror_drop_m_;
  std::int64_t firing_period_ns_;
  bool driver_stamp_fault_;
  std::array<double, kLanes> cos_elevation_, sin_elevation_, cos_lag_,
      sin_lag_;  ///< lag: azimuth since the sequence's start
  std::array<std::uint16_t, kLanes> ring_;
};

/// A beam bent by two prisms turning at constant rates, repeated by units yawed apart: y/x + i z/x of the beam is
/// A exp(i w1 t) + B exp(i w2 t) + C exp(i (2 w1 - w2) t), t from the recording's start. Rings are the units, from the
/// right (negative yaw) to the left; all share the origin of L.
class RosettePattern final : public BeamPattern {
 public:
  explicit RosettePattern(const Values& values);
  void fire(std::int64_t sweep, std::int64_t slot, int slots, Firings& firings) const override;

 private:
  struct Term {
    double amplitude, turn_rad_ns;
    std::array<double, kLanes> cos_lag, sin_lag;  ///< phase since the first slot at once
  };
  std::array<Term, 3> terms_;
  std::array<double, 3> cos_yaw_, sin_yaw_;
};

}  // namespace tumble::sim
