// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

/// ClippedBaseline estimates clipped angular rates from the gyro alone, independently for each axis. A cubic polynomial
/// bridges each gap of clipped samples and matches the rate and its derivative at both ends of the gap.
class ClippedBaseline {
 public:
  struct Params {
    SaturationLimitDetector::Params rails = {};
    bool tilted_rails = false;  ///< true: also detects saturation limits that depend on all three gyro outputs
    /// Noise density of the gyro [rad/s/sqrt(Hz)]
    double gyro_noise_density = 5.236e-4;
    double rate_max_rad_s = 50.0;  ///< largest rate about one axis in a gap
    double gap_max_s = 1.0;        ///< longest accepted time between samples

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(
          p.tilted_rails,
          boolean_parameter("tilted_rails",
                            "1: also search for tilted saturation limits; 0: treat each axis separately, as published",
                            ParameterAudience::common_use));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-6, 3600.0, "maximum time between two samples; a longer gap causes an error"});
    }
  };

  explicit ClippedBaseline(const Params& params);

  /// Returns the error `empty`, `insufficient_data` (fewer than two samples), `non_finite`, `time_order` or `gap` for
  /// unusable samples.
  Status estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
