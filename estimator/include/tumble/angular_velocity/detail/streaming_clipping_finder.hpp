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

/// Causal form of ClippingFinder: detects saturation limits and saturation planes from all readings so far. A limit is
/// detected some samples after the first saturation, so callers must classify earlier samples again.
class StreamingClippingFinder {
 public:
  static constexpr std::size_t kReadingsMax = 1024;

  struct Params {
    ClippingFinder::Params clipping;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.clipping);
    }
  };
  /// unit of the readings: rad/s for the gyro, m/s^2 for the accelerometer
  struct DistinctReadingMemory {
    std::vector<Eigen::Vector3d> readings;  ///< in time order
    Eigen::Vector3d peak = Eigen::Vector3d::Zero();
    std::size_t near_limit_count = 0,
                near_limit_since_search =
                    0;  ///< number of readings near the extremes; number since the last search for planes
    std::size_t samples_since_search = 0;
    bool readings_pruned = false;  ///< true if readings were dropped, because the memory was full
    bool operator==(const DistinctReadingMemory&) const = default;
  };
  struct State {
    SaturationLevels known_limits;
    std::array<DistinctReadingMemory, 2> distinct_readings;  ///< indexed by Triad
    SaturationPlaneFinder::Workspace search_workspace;       ///< buffer
  };

  /// `readings_max` is the maximum number of stored readings of the gyro, and of the accelerometer. Throws
  /// InvalidParams if a parameter is out of bounds.
  explicit StreamingClippingFinder(const Params& params, std::size_t readings_max = kReadingsMax);

  /// The returned state has all memory that observe_reading() needs.
  State start() const;

  /// Processes a finite sample. Returns true if a saturation limit or saturation plane changed. Cost: O(1), but
  /// O(`readings_max`) when enough new large readings have arrived.
  bool observe_reading(const ImuSample& sample, State& state) const;

  /// Returns the clipped axes of a finite sample, according to the saturation limits found so far and the clip flags of
  /// the IMU. `before` and `after` are the neighbouring samples, or null. Cost: O(1).
  Clipping classify_clipping(const ImuSample* before, const ImuSample& sample, const State& state,
                             const ImuSample* after = nullptr) const;

  const SaturationLimitDetector& axis_limit_detector() const { return axis_limit_detector_; }

 private:
  void store_distinct_reading(const Eigen::Vector3d& reading, Triad triad, DistinctReadingMemory& memory) const;
  bool is_near(const Eigen::Vector3d& reading, Triad triad, const DistinctReadingMemory& memory, double share) const;
  bool observe_reading(const Eigen::Vector3d& reading, Triad triad, State& state) const;
  SaturationPlanes search_saturation_planes(Triad triad, State& state) const;

  SaturationLimitDetector axis_limit_detector_;
  std::array<std::array<SaturationPlaneFinder, 2>, 2> plane_finders_;
  std::size_t readings_max_;
};

}  // namespace tumble
