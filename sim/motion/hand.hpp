// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "sim/motion/motion_type.hpp"
#include "sim/motion/tremor.hpp"

namespace tumble::sim {

struct Reference {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero(), v_m_s = Eigen::Vector3d::Zero(), a_m_s2 = Eigen::Vector3d::Zero();
};

inline constexpr std::array kHandParameters = {
    Parameter{"stiffness_n_m", 400.0, 1.0, 5000.0, "N/m",
              "horizontal stiffness with which the hand keeps the robot on its path; assumed"},
    Parameter{"damping_n_s_m", 90.0, 0.0, 1000.0, "N s/m", "horizontal damping of the hand; assumed"},
    Parameter{"twist_damping_nm_s", 0.03, 0.0, 10.0, "N m s",
              "damping of the hand against rotation about the vertical axis; assumed"},
    Parameter{"tremor_n", 0.0, 0.0, 20.0, "N",
              "root mean square of the hand's tremor force per horizontal axis, from 0.7 to 9 Hz; assumed"},
    Parameter{"tremor_nm", 0.0, 0.0, 1.0, "N m",
              "root mean square of the tremor torque per axis, caused by fingers that rub the shell; assumed"},
    Parameter{"hand_seed", 0.0, 0.0, 1e9, "1", "seed of the hand's random behaviour; the number is rounded down"},
    Parameter{"torque_limit_nm", 3.0, 0.0, 50.0, "N m",
              "maximum torque of a burst (a short drive that makes the sphere spin or slide)"},
    Parameter{"burst_time_s", 0.04, 0.005, 1.0, "s",
              "time constant with which the sphere reaches the target rate of a burst"},
    Parameter{"burst_s", 1.0, 0.0, 30.0, "s",
              "maximum duration of a burst; the burst ends earlier if the sphere leaves the patch"},
    Parameter{"patch_1_spin_ratio", 1.0, -3.0, 15.0, "1",
              "target rate of a burst on patch 1, relative to pure rolling; above 1 the sphere spins, below 1 the "
              "sphere slides; 1: no burst"},
    Parameter{"patch_1_axis_rad", 0.0, -1.6, 1.6, "rad",
              "angle about the vertical between the axis of the burst and the rolling axis"},
    Parameter{"patch_2_spin_ratio", 1.0, -3.0, 15.0, "1", "as patch 1"},
    Parameter{"patch_2_axis_rad", 0.0, -1.6, 1.6, "rad", "as patch 1"},
    Parameter{"patch_3_spin_ratio", 1.0, -3.0, 15.0, "1", "as patch 1"},
    Parameter{"patch_3_axis_rad", 0.0, -1.6, 1.6, "rad", "as patch 1"},
};
inline constexpr std::size_t kHandPatches = 3;

template <std::size_t N>
constexpr std::array<Parameter, kHandParameters.size() + N> with_hand(const std::array<Parameter, N>& own) {
  std::array<Parameter, kHandParameters.size() + N> all{};
  for (std::size_t i = 0; i < N; ++i) all[i] = own[i];
  for (std::size_t i = 0; i < kHandParameters.size(); ++i) all[N + i] = kHandParameters[i];
  return all;
}

/// Hand moves a sphere by a horizontal force at the sphere's centre. The force is the sum of a spring and a damper to a
/// moving reference position, a feed-forward term for the rolling motion, and tremor. On floor patches with different
/// friction, the hand adds bursts of torque.
class Hand {
 public:
  /// `world` must outlive the Hand object.
  Hand(const std::string& motion, const Values& values, const engine::World& world);

  double radius_m() const { return radius_m_; }
  BodyState at_rest(const Eigen::Vector3d& p_G_m) const;
  /// Returns the force and torque of the hand. Times must increase from call to call, because the hand stores the start
  /// time of a burst of torque.
  Wrench wrench(const BodyState& state, const Reference& reference);

 private:
  Eigen::Vector3d burst(double time_s, const Eigen::Vector3d& p_G_m, const Eigen::Vector3d& v_m_s,
                        const Eigen::Vector3d& w_W_rad_s);

  struct Burst {
    double spin_ratio, axis_rad;
    double end_s = std::numeric_limits<double>::infinity();
  };
  const engine::World& world_;
  Values values_;
  double radius_m_ = 0.0, mass_kg_ = 0.0, inertia_kg_m2_ = 0.0;
  Eigen::Vector3d p_BG_m_;
  std::array<Burst, kHandPatches> bursts_;
  std::vector<Tremor> force_, torque_;
};

}  // namespace tumble::sim
