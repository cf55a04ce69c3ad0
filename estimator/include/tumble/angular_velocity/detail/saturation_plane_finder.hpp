// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Finds the planes that contain the readings of saturated sensing elements (SaturationPlane), in a whole recording of
/// a gyro or accelerometer. SaturationPlaneFinder needs neither clip flags nor the stated range of the sensor.
///
/// A plane is a saturation limit if no reading is beyond the plane, and unusually many readings are close to it. The
/// equations are in docs/maths/rails.md.
///
/// SaturationPlaneFinder assumes that saturation limits are constant, and similar for the three sensing elements of a
/// sensor. SaturationPlaneFinder does not detect readings that overflow and change sign.
class SaturationPlaneFinder {
 public:
  struct Params {
    /// Returns the parameters for an accelerometer. The minimum saturation limit is about 1.5 g, because gravity alone
    /// can cause constant readings.
    static Params defaults_for_accelerometer() {
      Params out;
      out.distance_min_rad_s = 15.0;
      return out;
    }
    /// prior standard deviation of each cross-axis sensitivity of a sensing element, before the misalignment
    /// compensation
    static constexpr double kSlopeSigma = 0.03;
    static constexpr double kSlopeMax = 0.12;
    /// minimum saturation limit [rad/s]; excludes constant readings at rest and in slow motion
    double distance_min_rad_s = 1.5;
    /// Range in the data sheet [rad/s], if known. Saturation limits far below the stated range are not accepted.
    std::optional<double> stated_range_rad_s = std::nullopt;
    /// prior standard deviation of SaturationPlane::offset_rad_s, and of the differences between the limits of the
    /// sensing elements, relative to the limit
    static constexpr double kOffsetSigmaRatio = 0.02;
    int samples_min = 4;
    static constexpr double kLogOddsBefore = -6.0;  ///< prior log odds of saturation for each element and sign
    static constexpr double kLogOddsMin = 1.0;      ///< minimum for accepting a plane
    static constexpr double kLogOddsKeep = -3.0;    ///< minimum for keeping a plane after more readings
    /// Saturation planes from an earlier run of the sensor, which are used until readings contradict them.
    SaturationPlanes known_limits = {};

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.distance_min_rad_s, {"distance_min_rad_s", "rad/s", 0.01, 1000.0,
                                   "minimum saturation limit that is detected; in m/s^2 for an accelerometer"});
      visit(p.samples_min,
            {"samples_min", "1", 2, 1000, "minimum number of samples at a saturation limit, for each sign"});
    }
  };

  /// Buffers for find(); after reserve() for all readings, find() allocates no memory.
  struct Workspace {
    std::vector<Eigen::Vector3d> rates;
    std::vector<double> values;
    std::vector<std::size_t> near_plane_indices, inliers;
    void reserve(std::size_t readings);
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SaturationPlaneFinder(const Params& params);

  /// Finds the planes of saturated readings in the gyro or accelerometer readings of a recording. The samples must be
  /// finite and in time order. Cost: O(N), plus a comparison of some hundred planes with the largest readings.
  SaturationPlanes find(std::span<const ImuSample> samples, Triad triad = Triad::gyro) const;
  /// Finds the saturation planes in readings without time stamps [rad/s]. `before` contains the planes that were found
  /// in earlier readings.
  SaturationPlanes find(std::span<const Eigen::Vector3d> readings_rad_s, const SaturationPlanes& before,
                        Workspace& workspace) const;

  const Params& params() const { return params_; }

 private:
  SaturationPlanes merge_known_saturation_planes(const SaturationPlanes& found,
                                                 std::span<const Eigen::Vector3d> readings_rad_s) const;
  Params params_;
};

}  // namespace tumble
