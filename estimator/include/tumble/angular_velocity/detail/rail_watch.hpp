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

/// Detects saturation levels and planes of gyro and accelerometer from the readings so far. RailWatch is the causal
/// form of ClippingFinder.
///
/// For each triad, RailWatch stores up to `readings_max` distinct readings, preferring the latest readings and readings
/// near the extremes. The search is that of ClippingFinder. A search follows each segment near an extreme. Within a
/// segment, a search follows whenever the readings near the extremes have grown by an eighth. A run of n readings at
/// the extreme is therefore searched O(log n) times, not n times. A plane remains valid after its readings were
/// dropped, until readings contradict the plane. Saturation is detected some samples after it first occurs, so users
/// must re-evaluate the samples before the detection. The limitations of RailPlaneFinder apply.
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

  /// Classifies a finite sample by the levels found so far and the flags of the device. `before` and `after` are the
  /// sample's neighbours, null at the ends. The neighbours reveal saturation during a part of the window. O(1).
  Clipping judge(const ImuSample* before, const ImuSample& sample, const State& state,
                 const ImuSample* after = nullptr) const;

  const RailDetector& upright_rails() const { return upright_rails_; }

  /// Returns whether two states will give identical results, bit for bit.
  static bool equal(const State& a, const State& b);

  /// Returns whether a state that was loaded from a file fits into the preallocated memory.
  bool has_room_for(const State& state) const;

 private:
  void store(const Eigen::Vector3d& reading, Triad triad, Memory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const Memory& memory, double share) const;
  bool observe(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  RailPlanes search(Triad triad, State& state) const;

  RailDetector upright_rails_;
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;  // gyro and accelerometer, as in ClippingFinder
  std::size_t readings_max_;
};

}  // namespace tumble
