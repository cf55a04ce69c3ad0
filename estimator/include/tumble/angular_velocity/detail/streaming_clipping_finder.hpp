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

/// Detects saturation limits and saturation planes of gyro and accelerometer from all readings so far.
/// StreamingClippingFinder is the causal form of ClippingFinder.
///
/// For each of the two sensors, StreamingClippingFinder stores up to `readings_max` distinct readings. The latest
/// readings and readings near the extremes have priority. StreamingClippingFinder searches for saturation planes after
/// each segment of readings near an extreme, with the method of ClippingFinder. Within a segment,
/// StreamingClippingFinder also searches whenever the number of readings near the extremes has grown by an eighth. A
/// run of n readings at the extreme therefore needs only O(log n) searches. A saturation plane remains valid after its
/// readings were dropped, until readings contradict the plane. StreamingClippingFinder detects saturation some samples
/// after the saturation first occurs, so users must classify the samples before the detection again. The limitations of
/// RailPlaneFinder apply to StreamingClippingFinder.
class StreamingClippingFinder {
 public:
  struct Params {
    ClippingFinder::Params clipping;
    int readings_max = 1024;

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
      visit(p.readings_max, {"readings_max", "1", 64, 65536, "maximum number of distinct readings stored per triad"});
    }
  };
  /// Memory contains the stored readings of the gyro [rad/s] or of the accelerometer [m/s^2].
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

  /// Returns the state before the first sample, with all memory that observe() needs.
  State start() const;

  /// Updates the state with one finite sample. Cost: O(1), sometimes a search. Returns true if the known saturation
  /// limits or planes changed.
  bool observe(const ImuSample& sample, State& state) const;

  /// Returns the clipped axes of a finite sample, according to the saturation limits found so far and the flags of the
  /// device. Cost: O(1). The arguments `before` and `after` are the neighbours of the sample, or null at the ends. The
  /// neighbours reveal saturation during a part of the sample.
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
