// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

namespace tumble::sim::engine {

/// Keeps in the engine's tree over the world's geoms those that a floating robot may touch soon, and puts the tree of
/// the compiler back at the end. The engine asks the rest of each pair as ever and sorts contacts by geom, so that no
/// bit of a motion depends on it. Planes and height fields are always in it, with boxes without end, which spares
/// asking for them. Does nothing to a model with other moving bodies, and to one whose world has no tree.
class NearGeoms {
 public:
  /// `model` outlives it and is copied by nobody meanwhile.
  explicit NearGeoms(mjModel& model);
  ~NearGeoms();
  NearGeoms(const NearGeoms&) = delete;
  NearGeoms& operator=(const NearGeoms&) = delete;

  /// Whether one floating body is all that moves.
  static bool serves(const mjModel& model);

  /// Before each step: where the robot's body is. Good for the step unless it goes more than 0.2 m in it.
  void around(const Eigen::Vector3d& p_WB_m);

 private:
  struct Leaf {
    int geom;
    bool always;                      ///< whatever is near
    Eigen::Matrix<double, 6, 1> box;  ///< centre and half sizes, world axes
  };
  using Nodes = std::vector<Leaf>::iterator;

  void find_leaves();
  int plant(Nodes first, Nodes last);

  mjModel& model_;
  double reach_m_ = -1.0;  ///< of the robot about its body; negative: nothing is done
  Eigen::Vector3d asked_W_m_;
  std::vector<Leaf> leaves_, near_;
  int planted_ = 0;
  std::vector<int> own_child_, own_geom_;  ///< the compiler's tree
  std::vector<mjtNum> own_box_;
};

}  // namespace tumble::sim::engine
