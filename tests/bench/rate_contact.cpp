// SPDX-License-Identifier: BSD-3-Clause
// rate_contact SCENARIO FIRST LAST
//
// The program measures how much a contact model could reveal about the rate of a tumbling rig. For every IMU sample in
// contact with a saturated gyro, it computes the true torque about the centre of mass and the true force, both as means
// over the window. It predicts the torque by (a) nothing, (b) a force through one point, at right angles to it, (c) a
// force through the point that the sample before gives, and (d) a force through the best single point of the whole
// impact. The program prints the remaining share of the torque, and how long contacts last. The program is no test: it
// needs 2 s per simulated run.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/statistics/statistics.hpp"
#include "sim/simulate.hpp"
#include "tests/tree.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross(const Vector3d& v) {
  Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

// Returns the inertia about the centre of mass, divided by the mass, in body axes [m^2].
Matrix3d inertia_per_mass(const sim::Situation& situation) {
  const sim::Values& robot = situation.robot.values;
  const double x = robot.at("inertia_x_kg_m2") / robot.at("mass_kg");
  const Matrix3d R = Eigen::AngleAxisd(robot.at("inertia_yaw_rad"), Vector3d::UnitZ()).toRotationMatrix();
  return R * (x * Vector3d(1.0, robot.at("inertia_ratio_y"), robot.at("inertia_ratio_z"))).asDiagonal() * R.transpose();
}

struct Wrench {
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();  // divided by the mass
};

// Returns the mean wrench over the physics samples (first, last].
Wrench mean_wrench(const sim::Truth& truth, const Matrix3d& J, std::size_t first, std::size_t last) {
  Wrench out;
  const double dt_s = 1e-9 * static_cast<double>(truth.period_ns);
  for (std::size_t k = first; k < last; ++k) {
    const Vector3d w = 0.5 * (truth.w_WB_B_rad_s[k] + truth.w_WB_B_rad_s[k + 1]);
    const Vector3d alpha = (truth.w_WB_B_rad_s[k + 1] - truth.w_WB_B_rad_s[k]) / dt_s;
    out.torque += J * alpha + w.cross(J * w);
    out.force += truth.f_B_m_s2[k + 1];
  }
  const auto count = static_cast<double>(last - first);
  return {out.force / count, out.torque / count};
}

// Returns the point nearest to the centre of mass through which the forces explain the torques best.
Vector3d best_point(const std::vector<Wrench>& wrenches) {
  Matrix3d H = 1e-6 * Matrix3d::Identity();
  Vector3d g = Vector3d::Zero();
  for (const Wrench& w : wrenches) {
    const Matrix3d A = -cross(w.force);  // r x f = -f x r
    H += A.transpose() * A;
    g += A.transpose() * w.torque;
  }
  return H.ldlt().solve(g);
}

struct Shares {
  std::vector<double> across, last_point, one_point, arm_m;
  std::vector<double> length;  // lengths of contacts in samples, for contacts with a clipped sample
  std::size_t clipped = 0, clipped_contact = 0;
};

void close_impact(std::vector<Wrench>& impact, std::vector<bool>& clipped, Shares& shares) {
  if (std::count(clipped.begin(), clipped.end(), true) > 0) {
    shares.length.push_back(static_cast<double>(impact.size()));
    const Vector3d point = best_point(impact);
    for (std::size_t k = 0; k < impact.size(); ++k) {
      const Wrench& w = impact[k];
      if (!clipped[k] || w.force.norm() < 2.0) continue;
      const double torque = w.torque.norm();
      shares.across.push_back(std::abs(w.torque.dot(w.force.normalized())) / torque);
      shares.one_point.push_back((w.torque - point.cross(w.force)).norm() / torque);
      shares.arm_m.push_back(torque / w.force.norm());
      if (k > 0) shares.last_point.push_back((w.torque - best_point({impact[k - 1]}).cross(w.force)).norm() / torque);
    }
  }
  impact.clear();
  clipped.clear();
}

void add(const sim::Recording& recording, const Matrix3d& J, Shares& shares) {
  const sim::Truth& truth = recording.truth;
  const sim::ImuRecord& record = recording.sensors.imus.front();
  const scenarios::ClippingTruth clipping(recording.sensors, truth);
  const auto steps = static_cast<std::size_t>(record.period_ns / truth.period_ns);
  std::vector<Wrench> impact;
  std::vector<bool> clipped;
  for (std::size_t k = 0; k < record.time_ns.size(); ++k) {
    const auto last = static_cast<std::size_t>(record.time_ns[k] / truth.period_ns);
    if (last < steps || last >= truth.w_WB_B_rad_s.size()) continue;
    bool contact = false;
    for (std::size_t i = last - steps; i <= last; ++i) contact = contact || truth.label[i] != sim::ContactLabel::air;
    const bool at_rail = clipping.clipped_axes(k) != 0;
    shares.clipped += at_rail;
    shares.clipped_contact += at_rail && contact;
    if (!contact) {
      close_impact(impact, clipped, shares);
      continue;
    }
    impact.push_back(mean_wrench(truth, J, last - steps, last));
    clipped.push_back(at_rail);
  }
  close_impact(impact, clipped, shares);
}

void print(const char* what, const std::vector<double>& values) {
  using scenarios::quantile;
  std::printf("%-58s %8zu %8.3f %8.3f %8.3f\n", what, values.size(), quantile(values, 0.25), quantile(values, 0.5),
              quantile(values, 0.9));
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fprintf(stderr, "usage: rate_contact SCENARIO|FILE.yaml FIRST LAST\n");
    return 2;
  }
  try {
    const scenarios::DataRoot data{tumble::test::source_dir()};
    const scenarios::Scenario scenario = scenarios::load_scenario(data, words[1]);
    Shares shares;
    for (std::uint64_t seed = std::strtoull(words[2], nullptr, 10); seed <= std::strtoull(words[3], nullptr, 10);
         ++seed) {
      const sim::ResolvedSituation situation = scenarios::without_lidars(scenarios::draw(data, scenario, seed));
      add(sim::simulate(sim::BuiltSituation(situation, data.models())), inertia_per_mass(situation), shares);
    }
    std::printf("clipped samples %zu, of these in contact %zu\n", shares.clipped, shares.clipped_contact);
    std::printf("%-58s %8s %8s %8s %8s\n", "", "count", "25 %", "median", "90 %");
    print("samples in a row in contact, with a clipped one", shares.length);
    print("torque over force [m]", shares.arm_m);
    print("torque along the force, share (what one point leaves)", shares.across);
    print("left by the point of the sample before, share", shares.last_point);
    print("left by the best single point of the impact, share", shares.one_point);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
