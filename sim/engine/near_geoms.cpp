// SPDX-License-Identifier: BSD-3-Clause
#include "sim/engine/near_geoms.hpp"

#include <algorithm>
#include <limits>

namespace tumble::sim::engine {

namespace {

using Eigen::Vector3d;
using Box = Eigen::Matrix<double, 6, 1>;

/// margin around the robot; with 0.5 m, one bounding-volume tree is valid for hundreds of simulation steps
constexpr double kMargin_m = 0.5;
/// upper bound of a robot's motion in one simulation step: 0.5 ms at 400 m/s
constexpr double kStep_m = 0.2;

Box everything() {
  Box box;
  box << Vector3d::Zero(), Vector3d::Constant(mjMAXVAL);
  return box;
}

Box around_both(const Box& a, const Box& b) {
  const Vector3d low = (a.head<3>() - a.tail<3>()).cwiseMin(b.head<3>() - b.tail<3>());
  const Vector3d high = (a.head<3>() + a.tail<3>()).cwiseMax(b.head<3>() + b.tail<3>());
  Box box;
  box << 0.5 * (low + high), 0.5 * (high - low);
  return box;
}

double distance_m(const Box& box, const Vector3d& p_m) {
  return ((p_m - box.head<3>()).cwiseAbs() - box.tail<3>()).cwiseMax(0.0).norm();
}

double reach_of_robot_m(const mjModel& model) {
  double reach_m = 0.0;
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_bodyid[i] == 0) continue;
    if (model.geom_rbound[i] <= 0.0) return -1.0;
    reach_m = std::max(reach_m, Vector3d::Map(model.geom_pos + 3 * i).norm() + model.geom_rbound[i]);
  }
  return reach_m;
}

}  // namespace

NearGeoms::NearGeoms(mjModel& model)
    : model_(model), asked_W_m_(Vector3d::Constant(std::numeric_limits<double>::infinity())) {
  const int first = model.body_bvhadr[0], nodes = model.body_bvhnum[0];
  if (!serves(model) || first != 0 || nodes < 2) return;
  reach_m_ = reach_of_robot_m(model);
  if (reach_m_ < 0.0) return;
  own_child_.assign(model.bvh_child, model.bvh_child + 2 * nodes);
  own_geom_.assign(model.bvh_nodeid, model.bvh_nodeid + nodes);
  own_box_.assign(model.bvh_aabb, model.bvh_aabb + 6 * nodes);
  find_leaves();
}

NearGeoms::~NearGeoms() {
  std::copy(own_child_.begin(), own_child_.end(), model_.bvh_child);
  std::copy(own_geom_.begin(), own_geom_.end(), model_.bvh_nodeid);
  std::copy(own_box_.begin(), own_box_.end(), model_.bvh_aabb);
}

bool NearGeoms::serves(const mjModel& model) {
  return model.nbody == 2 && model.njnt == 1 && model.jnt_type[0] == mjJNT_FREE && model.nflex == 0;
}

void NearGeoms::find_leaves() {
  for (std::size_t i = 0; i < own_geom_.size(); ++i) {
    const int geom = own_geom_[i];
    if (geom < 0) continue;
    const bool always = model_.geom_type[geom] == mjGEOM_PLANE || model_.geom_type[geom] == mjGEOM_HFIELD;
    leaves_.push_back({geom, always, always ? everything() : Box(Box::Map(own_box_.data() + 6 * i))});
  }
}

void NearGeoms::around(const Vector3d& p_WB_m) {
  if (reach_m_ < 0.0 || (p_WB_m - asked_W_m_).norm() <= kMargin_m - kStep_m) return;
  asked_W_m_ = p_WB_m;
  near_.clear();
  for (const Leaf& leaf : leaves_) {
    if (leaf.always || distance_m(leaf.box, p_WB_m) <= reach_m_ + kMargin_m) near_.push_back(leaf);
  }
  if (near_.empty()) near_.push_back(leaves_.front());  // a tree needs at least one leaf
  std::stable_partition(near_.begin(), near_.end(), [](const Leaf& leaf) { return leaf.always; });
  planted_ = 0;
  plant(near_.begin(), near_.end());
}

int NearGeoms::plant(Nodes first, Nodes last) {
  const int node = planted_++;
  int* child = model_.bvh_child + 2 * node;
  Eigen::Map<Box> box(model_.bvh_aabb + 6 * node);
  if (last - first == 1) {
    child[0] = child[1] = -1;
    model_.bvh_nodeid[node] = first->geom;
    box = first->box;
    return node;
  }
  Nodes middle = first + 1;  // an unbounded geom has a separate node
  if (!first->always) {
    Box all = first->box;
    for (Nodes leaf = middle; leaf != last; ++leaf) all = around_both(all, leaf->box);
    int axis = 0;
    all.tail<3>().maxCoeff(&axis);
    middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [axis](const Leaf& a, const Leaf& b) { return a.box[axis] < b.box[axis]; });
    box = all;
  } else {
    box = everything();
  }
  model_.bvh_nodeid[node] = -1;
  const int left = plant(first, middle), right = plant(middle, last);
  child[0] = left;
  child[1] = right;
  return node;
}

}  // namespace tumble::sim::engine
