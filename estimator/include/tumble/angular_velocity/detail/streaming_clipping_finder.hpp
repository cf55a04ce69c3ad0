// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects saturation limits and planes of saturated readings from all readings so far; causal form of ClippingFinder.
/// Saturation is detected some samples after its first occurrence, so callers must classify earlier samples again.
class StreamingClippingFinder {
 public:
  static constexpr std::size_t kReadingsMax = 1024;  ///< default of `readings_max`, see StreamingClippingFinder()

  struct Params {
    ClippingFinder::Params clipping;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
    }
  };
  /// unit of the readings: rad/s for the gyro, m/s^2 for the accelerometer
  struct DistinctReadingMemory {
    std::vector<Eigen::Vector3d> readings;           ///< distinct readings, in time order
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();  ///< largest magnitude of each axis
    std::size_t near_limit_count = 0,
                near_limit_since_search = 0;  ///< number of readings near the extremes; number not yet searched
    std::size_t samples_since_search = 0;     ///< readings near the extremes since the last search
    bool readings_pruned = false;             ///< readings were dropped
    bool operator==(const DistinctReadingMemory&) const = default;
  };
  struct State {
    SaturationLevels known_limits;
    std::array<DistinctReadingMemory, 2> distinct_readings;  ///< gyro and accelerometer
    SaturationPlaneFinder::Workspace search_workspace;       ///< buffer, not part of the state
  };

  /// `readings_max` is the maximum number of distinct readings stored per triad. Throws InvalidParams if a parameter is
  /// out of bounds.
  explicit StreamingClippingFinder(const Params& params, std::size_t readings_max = kReadingsMax);

  /// The returned state has all memory that observe_reading() needs.
  State start() const;

  /// The sample must be finite. Returns true if the known saturation limits or planes changed. Cost: O(1), but
  /// O(`readings_max`) when enough new large readings have arrived.
  bool observe_reading(const ImuSample& sample, State& state) const;

  /// Returns the clipped axes of a finite sample, according to the saturation limits found so far and the flags of the
  /// device. `before` and `after` are the neighbours of the sample, or null at the ends. Cost: O(1).
  Clipping classify_clipping(const ImuSample* before, const ImuSample& sample, const State& state,
                             const ImuSample* after = nullptr) const;

  const SaturationLimitDetector& axis_limit_detector() const { return axis_limit_detector_; }

 private:
  void store_distinct_reading(const Eigen::Vector3d& reading, Triad triad, DistinctReadingMemory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const DistinctReadingMemory& memory, double share) const;
  bool observe_reading(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  SaturationPlanes search_saturation_planes(Triad triad, State& state) const;

  SaturationLimitDetector axis_limit_detector_;
  std::array<std::array<SaturationPlaneFinder, 2>, 2> plane_finders_;  // gyro and accelerometer, as in ClippingFinder
  std::size_t readings_max_;
};

}  // namespace tumble
