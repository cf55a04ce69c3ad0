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

/// Causal version of ClippingFinder: detects saturation levels and planes of gyro and accelerometer from the readings
/// so far.
///
/// For each triad it stores up to `readings_max` distinct readings, preferring the latest and those near the extremes.
/// The search is that of ClippingFinder. A search follows each segment near an extreme, and within a segment each
/// further eighth of readings near the extremes. A run of n such readings is therefore searched O(log n) times, not n
/// times. A plane remains valid after its readings were dropped, until readings contradict it. Saturation is detected
/// some samples after it first occurs, so users must re-evaluate those samples. Not modelled: see RailPlaneFinder.
class RailWatch {
 public:
  struct Params {
    ClippingFinder::Params clipping;
    int readings_max = 1024;

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
      visit(p.readings_max, {"readings_max", "1", 64, 65536, "largest number of distinct readings stored per triad"});
    }
  };
  /// Stored readings of one triad, rad/s or m/s^2.
  struct Memory {
    std::vector<Eigen::Vector3d> readings;           ///< distinct, in time order
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();  ///< largest magnitude of each axis
    std::size_t near = 0, unsearched = 0;            ///< readings near the extremes; new ones
    std::size_t samples_since_search = 0;            ///< readings near the extremes since the last search
    bool pruned = false;                             ///< readings were dropped
    bool operator==(const Memory&) const = default;
  };
  struct State {
    KnownRails known;
    std::array<Memory, 2> memory;     ///< gyro and accelerometer
    RailPlaneFinder::Workspace work;  ///< buffer, not part of the state
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RailWatch(const Params& params);

  /// Returns the state before the first sample, with all memory that observe() needs.
  State start() const;

  /// Updates the state with one finite sample. Returns whether the known levels or planes changed. O(1), sometimes a
  /// search.
  bool observe(const ImuSample& sample, State& state) const;

  /// Classifies a finite sample by the levels found so far and the flags of the device. `before` and `after` are its
  /// neighbours, null at the ends. The neighbours reveal saturation during a part of the window. O(1).
  Clipping judge(const ImuSample* before, const ImuSample& sample, const State& state,
                 const ImuSample* after = nullptr) const;

  const RailDetector& upright_rails() const { return upright_rails_; }

  /// Returns whether two states will give identical results, bit for bit.
  static bool equal(const State& a, const State& b);

  /// Returns whether a state that was loaded from outside fits into the preallocated memory.
  bool has_room_for(const State& state) const;

 private:
  void store(const Eigen::Vector3d& reading, Triad triad, Memory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const Memory& memory, double share) const;
  bool observe(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  RailPlanes search(Triad triad, State& state) const;

  RailDetector upright_rails_;
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;  // same as in ClippingFinder
  std::size_t readings_max_;
};

}  // namespace tumble
