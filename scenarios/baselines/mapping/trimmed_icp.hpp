// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"
#include "tumble/mapping/detail/registration.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"

namespace tumble::baselines {

/// TrimmedIcp aligns a sweep to a map by point-to-plane registration with k matches per point and inverse-variance
/// weights. TrimmedIcp does not measure observability, so the registration reports success even in a featureless
/// corridor.
class TrimmedIcp {
 public:
  struct Params {
    int neighbours = 8;  ///< matches per point
    double match_distance_m = 1.0;
    int normal_neighbours = 20;  ///< neighbours for the normal of a map point
    double trim_min = 0.5;       ///< smallest fraction of the matches to keep
    double trim_max = 0.7;
    double trim_lambda = 2.35;
    /// If true, trimming keeps a fraction of all possible matches (number of points times `neighbours`). If false,
    /// trimming keeps a fraction of the matches that were found.
    bool count_unmatched_slots = false;
    int iterations_max = 40;
    double step_m = 0.01;  ///< the registration has converged below both step sizes
    double step_rad = 0.001;
    double correction_max_m = 15.0;
    double correction_max_rad = 1.1;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.neighbours, {"neighbours", "1", 1, 32, "number of matches per point"});
      visit(p.match_distance_m,
            {"match_distance_m", "m", 1e-3, 4.0, "maximum distance between a point and its matches in the map",
             ParameterAudience::common_use});
      visit(p.normal_neighbours, {"normal_neighbours", "1", 3, 32, "number of map points used for each normal"});
      visit(p.trim_min, {"trim_min", "1", 1e-3, 1.0, "minimum share of matches that trimming keeps"});
      visit(p.trim_max, {"trim_max", "1", 1e-3, 1.0, "maximum share of matches that trimming keeps"});
      visit(p.trim_lambda, {"trim_lambda", "1", 0.0, 100.0,
                            "exponent lambda of the kept share s of matches; trimming selects the s that minimises the "
                            "rms distance divided by s^lambda"});
      visit(p.count_unmatched_slots,
            boolean_parameter(
                "trim_counts_unmatched",
                "1: compute the kept share relative to all possible matches, including missing matches, as in "
                "the code of the ICRA 2024 paper; 0: relative to the found matches",
                ParameterAudience::common_use));
      visit(p.iterations_max, {"iterations_max", "1", 1, 1000, "maximum number of Gauss-Newton steps"});
      visit(p.step_m, {"step_m", "m", 0.0, 1.0, "position step below which the registration has converged"});
      visit(p.step_rad, {"step_rad", "rad", 0.0, 1.0, "rotation step below which the registration has converged"});
      visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6,
                                 "maximum accepted correction of the prior pose; a larger correction is rejected"});
      visit(p.correction_max_rad, {"correction_max_rad", "rad", 0.0, 3.15,
                                   "maximum accepted correction of the prior pose; a larger correction is rejected"});
    }
  };
  struct Point {
    Eigen::Vector3f position_m;
    float variance_m2 = 0.0f;  ///< along the ray, plus residual distortion
  };
  struct Result {
    RegistrationVerdict verdict = RegistrationVerdict::too_few_matches;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();  ///< the prior pose if the registration did not converge
    int iterations = 0;
    std::size_t matched_slots = 0;
    double kept_share = 0.0;  ///< kept fraction of the matched slots
  };

  explicit TrimmedIcp(const Params& params);

  /// A registration that stops at the limit of `iterations_max` iterations counts as success.
  Result align(std::span<const Point> points, const Eigen::Isometry3d& prior, const VoxelMap& map);

  /// Returns the number of matches that trimming keeps, for the parameter `trim_lambda`. `sorted_d2` contains the
  /// squared distances of the matches in ascending order.
  static std::size_t trim(std::span<const float> sorted_d2, std::size_t slots, const Params& params);

  /// Clears the cached normals of the map points. The caller must call forget_normals() after each change of the map.
  void forget_normals() { normals_.clear(); }

 private:
  struct Match {
    std::uint32_t point, map_index;
    float distance2_m2;
  };
  struct Normal {
    Eigen::Vector3f n = Eigen::Vector3f::Zero();
    bool known = false, usable = false;
  };
  const Normal& normal(const VoxelMap& map, std::uint32_t index);
  void match(std::span<const Point> points, const Eigen::Isometry3f& T, const VoxelMap& map);

  Params params_;
  std::vector<Match> matches_;
  std::vector<float> sorted_;
  std::vector<Normal> normals_;
};

}  // namespace tumble::baselines
