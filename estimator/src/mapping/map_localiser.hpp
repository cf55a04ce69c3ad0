// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "prior_scene.hpp"

namespace tumble::mapping {

/// MapLocaliser decides whether and where the current run is in a prior map: mapping.md, "Localisation in a prior map".
///
/// The search proposes a pose of the local frame W in the frame M of the prior map. The pose is accepted if it passes
/// a test against chance after several successive sweeps. A pose that fails the test twice in succession is rejected.
class MapLocaliser {
 public:
  MapLocaliser() = default;
  explicit MapLocaliser(PriorMap map) : scene_(std::make_shared<const PriorScene>(std::move(map))) {}

  bool has_map() const { return scene_ != nullptr; }
  bool is_localised() const { return localised_; }
  const PriorMap& map() const { return scene_->map(); }
  /// Starts again with the same map, from the given pose or from the whole map.
  void restart(const std::optional<Eigen::Isometry3d>& T_MI);

  /// Compares the local map with the prior map after a sweep. Returns the pose of the local frame in the prior map when
  /// the pose is accepted. Cost: a few milliseconds, or about a second for every fifth sweep while no pose is proposed.
  std::optional<FramePose> observe(const VoxelMap& local, const Eigen::Vector3d& p_WI_m);
  /// Returns ok if there is no prior map, or if the run is localised in the prior map. Returns `degenerate` before.
  Status status() const;

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  void propose(const std::vector<SurfacePoint>& points, const Eigen::Vector3d& p_WI_m);
  bool passes(const FramePose& pose) const;

  std::shared_ptr<const PriorScene> scene_;
  bool localised_ = false;
  std::optional<Eigen::Isometry3d> T_MW_;  // proposed pose
  double chance_ = 0.0;                    // share of surface points that agree at a wrong pose
  double compared_poses_ = 1.0;            // number of poses that the search compared
  int passed_ = 0, failed_ = 0;            // successive sweeps that passed or failed the test
  int attempts_ = 0, sweeps_since_search_ = 0;
};

}  // namespace tumble::mapping
