// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

namespace tumble::sim::engine {

/// NearGeoms restricts MuJoCo's bounding-volume tree of the world to the geoms that a free robot may touch in the next
/// steps, which saves computing time. Contacts and their order do not change, so the motion stays bit-identical. The
/// destructor restores the original bounding-volume tree.
class NearGeoms {
 public:
  /// The NearGeoms object refers to `model`. `model` must outlive the object, and must not be copied while the object
  /// exists.
  explicit NearGeoms(mjModel& model);
  ~NearGeoms();
  NearGeoms(const NearGeoms&) = delete;
  NearGeoms& operator=(const NearGeoms&) = delete;

  static bool serves(const mjModel& model);

  void around(const Eigen::Vector3d& p_WB_m);

 private:
  struct Leaf {
    int geom;
    bool always;                      ///< in the tree at any distance
    Eigen::Matrix<double, 6, 1> box;  ///< centre and half sizes, world axes
  };
  using Nodes = std::vector<Leaf>::iterator;

  void find_leaves();
  int plant(Nodes first, Nodes last);

  mjModel& model_;
  double reach_m_ = -1.0;  ///< negative: the tree is not restricted
  Eigen::Vector3d asked_W_m_;
  std::vector<Leaf> leaves_, near_;
  int planted_ = 0;
  std::vector<int> own_child_, own_geom_;
  std::vector<mjtNum> own_box_;
};

}  // namespace tumble::sim::engine
