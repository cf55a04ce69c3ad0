// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/triad.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Finds the rails of a triad's elements in a whole recording, without flags and without a stated range.
///
/// A rail is a plane that bounds the readings, close to upright, with many samples in a thin slab below it. What else
/// puts samples there: the round top of a motion, which its neighbours give away (they fall off as a parabola does,
/// a rail is left by a kink), and a constant rate (a torque-free spin, a turntable), which is as noisy as any reading,
/// has a level of its own each time and is entered by an impact that all axes feel. The evidence of each segment is
/// added up as a log likelihood ratio against these, less what choosing slopes and level freely was worth (Occam).
/// Readings that repeat (sample and hold) count once; what is thinner than the digits or the noise is not told apart.
/// A device has three elements of one kind: a rail far below what another axis reads is none, one at the level of
/// another element's is likely. Elements that are not found are not clipped as far as anybody can tell.
///
/// What it does not model: rails that drift or recover slowly, readings that wrap around, several levels of one
/// element.
class RailPlaneFinder {
 public:
  struct Params {
    /// What differs for an accelerometer: below about 1.5 g gravity alone reads constant for long.
    static Params for_accelerometer() {
      Params out;
      out.distance_min_rad_s = 15.0;
      return out;
    }
    /// Cross-axis sensitivity of elements before compensation: prior of each slope.
    double slope_sigma = 0.03;
    double slope_max = 0.12;  ///< steepest slope searched
    /// Rails lower than this are not looked for: rest and creeping are constant too [rad/s].
    double distance_min_rad_s = 1.5;
    /// Range that the data sheet states, if any: the rail does not lie far below it [rad/s].
    std::optional<double> stated_rad_s = std::nullopt;
    double offset_share = 0.02;     ///< prior of the offset and of how far elements differ, as a share of r
    int samples_min = 4;            ///< on a rail, of one sign
    double log_odds_before = -6.0;  ///< before anything is seen, for each element and sign
    double log_odds_min = 1.0;      ///< of a rail that is believed
    double log_odds_keep = -3.0;    ///< of one that was believed before and still is
    /// Rails that an earlier run on the device has found: a device keeps them to a fraction of a percent. They hold as
    /// long as no readings contradict them, before anything is met, and make one near them likely.
    RailPlanes known = {};

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.slope_sigma,
            {"slope_sigma", "1", 1e-4, 0.2,
             "prior standard deviation of each slope: cross-axis sensitivity of the elements before compensation"});
      visit(p.slope_max, {"slope_max", "1", 0.0, 0.3, "steepest slope searched"});
      visit(p.distance_min_rad_s,
            {"distance_min_rad_s", "rad/s", 0.01, 1000.0, "lowest rail searched; m/s^2 for an accelerometer"});
      visit(p.offset_share,
            {"offset_share", "1", 1e-4, 0.2,
             "prior standard deviation of the rail's offset and of the spread of elements, as a share of the range"});
      visit(p.samples_min, {"samples_min", "1", 2, 1000, "least number of samples at a rail, per sign"});
      visit(p.log_odds_before,
            {"log_odds_before", "1", -100.0, 100.0, "prior log odds of a tilted rail, per element and sign"});
      visit(p.log_odds_min, {"log_odds_min", "1", -100.0, 100.0, "log odds from which a tilted rail is accepted"});
      visit(p.log_odds_keep, {"log_odds_keep", "1", -100.0, 100.0, "log odds above which an accepted rail is kept"});
    }
  };

  /// Scratch space of a search, which allocates nothing when it has room for all readings.
  struct Workspace {
    std::vector<Eigen::Vector3d> rates;
    std::vector<double> values;
    std::vector<std::size_t> near, inliers;
    void reserve(std::size_t readings);
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RailPlaneFinder(const Params& params);

  /// The rails that the readings of a triad show. Samples must be finite and in order of time. O(N) apart from a search
  /// of some hundred slopes over the samples near the extremes.
  RailPlanes find(std::span<const ImuSample> samples, Triad triad = Triad::gyro) const;
  /// The same of readings alone [rad/s]. `before`: rails that fewer of these readings showed.
  RailPlanes find(std::span<const Eigen::Vector3d> readings_rad_s, const RailPlanes& before,
                  Workspace& workspace) const;

  const Params& params() const { return params_; }

 private:
  RailPlanes with_known(const RailPlanes& found, std::span<const Eigen::Vector3d> readings_rad_s) const;
  Params params_;
};

/// Which elements of a sample are at their rail. O(1).
ElementClipping classify(const ImuSample& sample, const RailPlanes& planes);
/// The same for each sample of a recording; `out` has their number.
void classify(std::span<const ImuSample> samples, const RailPlanes& planes, std::span<ElementClipping> out);

}  // namespace tumble
