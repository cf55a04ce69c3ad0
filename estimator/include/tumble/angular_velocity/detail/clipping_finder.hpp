// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane_finder.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct SaturationLevels {
  SaturationLimitDetector::State
      axis_limit_state;          ///< saturation limits per output axis, from equal readings or the data sheet
  SaturationPlanes gyro_planes;  ///< planes that contain the saturated gyro readings; empty if not observed
  SaturationPlanes accel_saturation_planes;
  bool gyro_clips_after_compensation = false;  ///< the gyro clips each output axis, after its misalignment compensation
  bool accel_clips_after_compensation = false;  ///< the accelerometer clips each output axis

  /// Returns the tilted saturation planes that are used to classify readings as clipped. If the sensor clips each
  /// output axis, the result contains only planes of axes without a known saturation limit.
  SaturationPlanes saturation_planes_in_use(Triad triad = Triad::gyro) const;
  /// Returns the sensing directions of the three sensing elements. `unknown_sigma` is the standard deviation of a
  /// cross-axis sensitivity that no saturation plane determines.
  SensingDirections rows(Triad triad, double unknown_sigma) const;
  bool operator==(const SaturationLevels&) const = default;
};

enum class SensingAxisReading : std::uint8_t {
  not_clipped,
  clipped_high,  ///< the true component is at or above the saturation limit
  clipped_low,
  invalid_reading  ///< the reading overflowed and changed its sign
};
SensingAxisReading sensing_axis_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

std::uint8_t clip_flags(const Clipping& clipping);

/// Saturation limits that a frozen sensor cannot imitate. Limits from equal readings are excluded, because a frozen
/// sensor also repeats one reading.
struct ConfirmedSaturation {
  SaturationPlanes gyro, accel;
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< range from the data sheet; 0: unknown
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds the clipped readings of a recording from clip flags of the sensor, equal readings (SaturationLimitDetector),
/// and tilted saturation planes (SaturationPlaneFinder).
class ClippingFinder {
 public:
  struct Params {
    SaturationLimitDetector::Params axis_limit_params = {};
    SaturationPlaneFinder::Params gyro_planes = {};  ///< a missing range is taken from `axis_limit_params`
    SaturationPlaneFinder::Params accel_saturation_planes = SaturationPlaneFinder::Params::defaults_for_accelerometer();

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("planes_", p.gyro_planes);
      visit.group("accel_planes_", p.accel_saturation_planes);
    }
  };
  struct ClippingSearchResult {
    SaturationLevels saturation_levels;
    std::vector<Clipping> clipping_per_sample;
  };

  /// If `use_tilted_planes` is false, ClippingFinder uses only clip flags and equal readings. Throws InvalidParams if a
  /// parameter is out of bounds.
  explicit ClippingFinder(const Params& params, bool use_tilted_planes = true);

  /// The samples must be finite and in time order. Cost: O(N) for N samples, plus SaturationPlaneFinder::find().
  ClippingSearchResult find(std::span<const ImuSample> samples) const;

  const SaturationLimitDetector& axis_limit_detector() const { return axis_limit_detector_; }

 private:
  SaturationPlanes find_planes(std::span<const ImuSample> samples, Triad triad,
                               const SaturationLimitDetector::State& axis_aligned_rails,
                               bool& clips_after_compensation) const;

  SaturationLimitDetector axis_limit_detector_;
  // The first index is 0 for the gyro and 1 for the accelerometer.
  std::array<std::array<SaturationPlaneFinder, 2>, 2> plane_finders_;
  bool use_tilted_planes_;
};

/// Causal form of ClippingFinder: detects saturation limits and saturation planes from all readings so far. A limit is
/// detected some samples after the first saturation, so callers must classify earlier samples again.
class StreamingClippingFinder {
 public:
  static constexpr std::size_t kReadingsMax = 1024;

  using Params = ClippingFinder::Params;
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
