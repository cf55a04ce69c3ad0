// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Detects saturation limits and planes of saturated readings from all readings so far; causal form of ClippingFinder.
/// Saturation is detected some samples after its first occurrence, so callers must classify earlier samples again.
class StreamingClippingFinder {
 public:
  struct Params {
    ClippingFinder::Params clipping;
    int readings_max = 1024;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
      visit(p.readings_max, {"readings_max", "1", 64, 65536, "maximum number of distinct readings stored per triad"});
    }
  };
  /// unit of the readings: rad/s for the gyro, m/s^2 for the accelerometer
  struct Memory {
    std::vector<Eigen::Vector3d> readings;           ///< distinct readings, in time order
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();  ///< largest magnitude of each axis
    std::size_t near = 0,
                unsearched_near_extremes = 0;  ///< number of readings near the extremes; number not yet searched
    std::size_t samples_since_search = 0;      ///< readings near the extremes since the last search
    bool pruned = false;                       ///< readings were dropped
    bool operator==(const Memory&) const = default;
  };
  struct State {
    SaturationLevels known;
    std::array<Memory, 2> memory;     ///< gyro and accelerometer
    RailPlaneFinder::Workspace work;  ///< buffer, not part of the state
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit StreamingClippingFinder(const Params& params);

  /// The returned state has all memory that observe() needs.
  State start() const;

  /// The sample must be finite. Returns true if the known saturation limits or planes changed. Cost: O(1), but
  /// O(`readings_max`) when enough new large readings have arrived.
  bool observe(const ImuSample& sample, State& state) const;

  /// Returns the clipped axes of a finite sample, according to the saturation limits found so far and the flags of the
  /// device. `before` and `after` are the neighbours of the sample, or null at the ends. Cost: O(1).
  Clipping classify(const ImuSample* before, const ImuSample& sample, const State& state,
                    const ImuSample* after = nullptr) const;

  const RailDetector& axis_aligned_rails() const { return axis_aligned_rails_; }

 private:
  void store(const Eigen::Vector3d& reading, Triad triad, Memory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const Memory& memory, double share) const;
  bool observe(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  RailPlanes search(Triad triad, State& state) const;

  RailDetector axis_aligned_rails_;
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;  // gyro and accelerometer, as in ClippingFinder
  std::size_t readings_max_;
};

}  // namespace tumble
