// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// ClippingFinder as a stream: the rails that the readings so far show, upright ones and planes, of gyro and
/// accelerometer.
///
/// Of each it keeps up to `readings_max` distinct readings, the latest and those about the extremes before others, and
/// searches them as the batch does: when a segment near an extreme has ended, and within one after each eighth more of
/// readings near the extremes, so that a run of n such readings is searched O(log n) times and not n. A plane whose
/// readings had to be forgotten stays until readings contradict it. What it does not model: see RailPlaneFinder; a rail
/// is seen some samples after it was first met, so that who believed those has to read them again.
class RailWatch {
 public:
  struct Params {
    ClippingFinder::Params clipping;
    int readings_max = 1024;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
      visit(p.readings_max, {"readings_max", "1", 64, 65536, "largest number of distinct readings stored per triad"});
    }
  };
  /// What is kept of one triad, rad/s or m/s^2.
  struct Memory {
    std::vector<Eigen::Vector3d> readings;           ///< distinct, in order of time
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();  ///< largest magnitude of each axis
    std::size_t near = 0, unsearched = 0, past = 0;  ///< readings near the extremes; not searched yet; since the last
    bool forgot = false;                             ///< readings were dropped
    bool operator==(const Memory&) const = default;
  };
  struct State {
    KnownRails known;
    std::array<Memory, 2> memory;     ///< of gyro and accelerometer
    RailPlaneFinder::Workspace work;  ///< scratch space, no part of the state proper
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RailWatch(const Params& params);

  /// A state before the first sample, with all memory that observe() needs.
  State start() const;

  /// Learns from one finite sample; true when what is known of the rails has changed. O(1), and a search now and then.
  bool observe(const ImuSample& sample, State& state) const;

  /// What a finite sample says by the rails that those observed before showed; flags of the device count. `before` and
  /// `after`: those beside it, null where there is none; what met a rail in a part of its window is told by them. O(1).
  Clipping judge(const ImuSample* before, const ImuSample& sample, const State& state,
                 const ImuSample* after = nullptr) const;

  const RailDetector& upright_rails() const { return upright_rails_; }

  /// Whether two states will behave alike for ever, bit for bit.
  static bool equal(const State& a, const State& b);

  /// Whether there is room for the readings of a state that comes from elsewhere.
  bool has_room_for(const State& state) const;

 private:
  void remember(const Eigen::Vector3d& reading, Triad triad, Memory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const Memory& memory, double share) const;
  bool observe(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  RailPlanes search(Triad triad, State& state) const;

  RailDetector upright_rails_;
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;  // as ClippingFinder has them
  std::size_t readings_max_;
};

}  // namespace tumble
