// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Finds single axes of an IMU that have stopped reading, sample by sample.
///
/// An axis has frozen that repeats one reading to the last bit for `frozen_s` and ten times as long as it ever did
/// before, after as long of readings that change, while another axis of its triad changes from sample to sample and by
/// far more than a quantum of this one. Not told from a sound one by that: an axis that never moved or held its reading
/// as long before (a coarse quantum at rest, a simulation without noise).
///
/// A reading at the rail (0.9 of the stated range, flagged by the device, or the highest or lowest of the axis so far
/// from 0.5 of the range on) may repeat. It has frozen where all other axes of both triads say for `rail_still_s` that
/// the body rests: one that turns or is pushed so hard does not. On a body that never comes to rest it has frozen where
/// it repeats the rail for `rail_held_s` while another axis of its triad moves: either that, or the range is not one
/// for such a spin, and of either nothing is known of the axis. Not told: one on a body that spins about this axis so
/// evenly that no other one moves.
class FrozenAxes {
 public:
  struct Params {
    double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< as the device states them; 0: not stated
    double frozen_s = 0.5;      ///< longest time for which a sound axis repeats its reading while the body moves
    double rail_still_s = 1.5;  ///< of rest by all other axes, while one reads its rail
    double rail_held_s = 5.0;   ///< of one reading at the rail while the body moves: flights last a third of it

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gyro_range_rad_s,
            {"gyro_range_rad_s", "rad/s", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
      visit(p.accel_range_m_s2,
            {"accel_range_m_s2", "m/s^2", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
      visit(p.frozen_s, {"frozen_s", "s", 1e-3, 1e4,
                         "longest time for which a healthy axis may repeat its reading while the body moves"});
      visit(p.rail_still_s,
            {"rail_still_s", "s", 1e-3, 1e4, "an axis at its rail is frozen if all other axes rest for this long"});
      visit(p.rail_held_s,
            {"rail_held_s", "s", 1e-3, 1e4,
             "an axis that repeats one reading at its rail for this long, while others move, is frozen"});
    }
  };
  /// One axis of one triad.
  struct Axis {
    double reading = 0.0;
    TimeNs since_ns = 0;       ///< first sample with this reading
    double held_s = 0.0;       ///< since then
    bool flagged = false;      ///< by the device, meanwhile
    bool frozen = false;       ///< it is, with this reading
    bool ever_frozen = false;  ///< it was, with this or another
    double longest_s = 0.0;    ///< of sound holds before
    double moved_s = 0.0;      ///< of readings that change
    double quantum = 0.0;      ///< smallest change that was seen; 0: none yet
    double lowest = 0.0, highest = 0.0;
    /// Of the two other axes of the triad, in turn, during the hold.
    std::array<double, 2> other_low{}, other_high{}, other_changes{};
    double samples = 0.0;  ///< of the hold, but the first
    double still_s = 0.0;  ///< for which the body seems to rest, during the hold
    std::array<double, 6> still_at{};
    bool operator==(const Axis&) const = default;
  };
  struct State {
    std::array<Axis, 6> axes;  ///< gyro x, y, z; accelerometer x, y, z
    std::array<double, 6> before{};
    TimeNs last_time_ns = 0;
    double fastest_rad_s = 0.0;  ///< that the gyro has read
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit FrozenAxes(const Params& params);

  /// Takes a reading; one that is not finite or out of order is passed over. O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  static const Axis& axis(Triad triad, int axis, const State& state);

  /// `out_of_range` with the axis that is frozen now by name, for how long and the bound; `ok` where none is.
  Status verdict(const State& state) const;

  /// Variance of the axes of a rate at `time_ns` by what is frozen now: of a frozen axis of the gyro nothing is known
  /// but that it turns no faster than anything that was read. Zero of the others.
  Eigen::Vector3d rate_variance_rad2_s2(TimeNs time_ns, const State& state) const;

 private:
  void hold(std::size_t channel, const std::array<double, 6>& now, double dt_s, std::uint8_t flags, State& state) const;
  bool at_rail(std::size_t channel, const Axis& axis) const;
  bool others_move(std::size_t channel, double changing_share, const Axis& axis) const;

  Params params_;
};

}  // namespace tumble
