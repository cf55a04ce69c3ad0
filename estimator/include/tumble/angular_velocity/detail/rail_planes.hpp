// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Finds the tilted saturation planes of a gyro or accelerometer in a whole recording. RailPlaneFinder needs neither
/// clip flags nor the stated range of the sensor.
///
/// A saturation plane is nearly axis-aligned, limits the readings, and has many samples in a thin slab below it. Two
/// kinds of motion look like saturation: the rounded maximum of a motion, and a constant rate (torque-free spin,
/// turntable). The readings near a rounded maximum follow a parabola, but the readings after saturation start with a
/// kink. A constant rate has full sensor noise, has a different value each time, and starts with an impact on all axes.
/// RailPlaneFinder sums the log likelihood ratio of saturation against rounded maxima and constant rates over all
/// segments. A penalty (Occam factor) accounts for the free choice of cross-axis sensitivities and saturation limit.
///
/// RailPlaneFinder counts repeated readings (sample and hold) as one reading. RailPlaneFinder assumes that the three
/// sensing elements of a gyro or accelerometer are of one type. RailPlaneFinder therefore rejects a saturation limit
/// that is far below readings of another axis. A saturation limit that equals the limit of another sensing element has
/// a higher prior probability. Sensing elements without a saturation plane count as unsaturated.
///
/// RailPlaneFinder assumes that saturation limits are constant and that each sensing element has one limit per sign.
/// RailPlaneFinder does not detect readings that overflow and change sign.
class RailPlaneFinder {
 public:
  struct Params {
    /// Returns the parameters for an accelerometer. The minimum saturation limit is about 1.5 g, because gravity alone
    /// can cause constant readings below 1.5 g.
    static Params for_accelerometer() {
      Params out;
      out.distance_min_rad_s = 15.0;
      return out;
    }
    /// Prior standard deviation of each cross-axis sensitivity of a sensing element, before the device's compensation.
    double slope_sigma = 0.03;
    double slope_max = 0.12;  ///< largest cross-axis sensitivity in the search
    /// Minimum saturation limit [rad/s]. At rest and in slow motion, readings below the minimum saturation limit can be
    /// constant without saturation.
    double distance_min_rad_s = 1.5;
    /// Range of the sensor according to its data sheet [rad/s], if known. RailPlaneFinder assumes that the saturation
    /// limit is not far below the stated range.
    std::optional<double> stated_rad_s = std::nullopt;
    /// Prior standard deviation of the offset b, and of the difference of r between two sensing elements, relative to
    /// r.
    double offset_sigma_ratio = 0.02;
    int samples_min = 4;            ///< minimum number of samples on the plane of one sign
    double log_odds_before = -6.0;  ///< prior log odds of saturation for each element and sign
    double log_odds_min = 1.0;      ///< minimum log odds for accepting a plane
    double log_odds_keep = -3.0;    ///< minimum log odds for keeping an accepted plane
    /// Saturation planes found in an earlier run of the same device. RailPlaneFinder uses known planes from the start
    /// of a run until readings contradict the planes. Saturation planes of one device change by a fraction of a percent
    /// between runs. A new plane near a known plane has a higher prior probability.
    RailPlanes known = {};

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.slope_sigma, {"slope_sigma", "1", 1e-4, 0.2,
                            "prior standard deviation of each slope of a saturation plane: cross-axis sensitivity of "
                            "the elements before compensation"});
      visit(p.slope_max, {"slope_max", "1", 0.0, 0.3, "steepest slope searched"});
      visit(p.distance_min_rad_s, {"distance_min_rad_s", "rad/s", 0.01, 1000.0,
                                   "lower end of the search for saturation limits; in m/s^2 for an accelerometer"});
      visit(p.offset_sigma_ratio,
            {"offset_sigma_ratio", "1", 1e-4, 0.2,
             "prior standard deviation of the offset of a saturation limit and of the differences "
             "between elements, as a share of the range"});
      visit(p.samples_min, {"samples_min", "1", 2, 1000, "minimum number of samples at a saturation limit, per sign"});
      visit(p.log_odds_before, {"log_odds_before", "1", -100.0, 100.0,
                                "prior log odds of a tilted saturation limit, per element and sign"});
      visit(p.log_odds_min,
            {"log_odds_min", "1", -100.0, 100.0, "minimum log odds with which a tilted saturation limit is accepted"});
      visit(p.log_odds_keep, {"log_odds_keep", "1", -100.0, 100.0,
                              "minimum log odds with which an accepted tilted saturation limit is kept"});
    }
  };

  /// Workspace contains the buffers of a search. The search for planes allocates no memory if the buffers have room for
  /// all readings.
  struct Workspace {
    std::vector<Eigen::Vector3d> rates;
    std::vector<double> values;
    std::vector<std::size_t> near, inliers;
    void reserve(std::size_t readings);
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RailPlaneFinder(const Params& params);

  /// Finds the saturation planes in the gyro or accelerometer readings of a recording. The samples must be finite and
  /// in time order. Cost: O(N), plus a search of some hundred cross-axis sensitivities over the samples near the
  /// extremes.
  RailPlanes find(std::span<const ImuSample> samples, Triad triad = Triad::gyro) const;
  /// Finds the saturation planes in readings without time stamps [rad/s]. The argument `before` contains the saturation
  /// planes that were found in a subset of the readings.
  RailPlanes find(std::span<const Eigen::Vector3d> readings_rad_s, const RailPlanes& before,
                  Workspace& workspace) const;

  const Params& params() const { return params_; }

 private:
  RailPlanes merge_with_known_planes(const RailPlanes& found, std::span<const Eigen::Vector3d> readings_rad_s) const;
  Params params_;
};

/// Returns which sensing elements are clipped in an IMU sample. Cost: O(1).
ElementClipping classify(const ImuSample& sample, const RailPlanes& planes);
/// Determines the clipped sensing elements in each sample of a recording. The output `out` must have the size of
/// `samples`.
void classify(std::span<const ImuSample> samples, const RailPlanes& planes, std::span<ElementClipping> out);

}  // namespace tumble
