// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tumble::sim {

namespace {

constexpr double kNode_m = 0.005;
constexpr double kPi = std::numbers::pi;

using Nodes = std::vector<Eigen::Vector2d>;

Nodes line(const PathPlan& plan, int count) {
  Nodes nodes;
  for (int i = 0; i <= count; ++i) {
    const double x_m = plan.length_m * i / count;
    constexpr double kFade_m = 0.5;
    const double u = std::clamp(std::min(x_m, plan.length_m - x_m) / kFade_m, 0.0, 1.0);
    const double fade = u * u * (3.0 - 2.0 * u);
    nodes.emplace_back(x_m, fade * plan.sway_m * std::sin(2.0 * kPi * x_m / plan.sway_length_m));
  }
  return nodes;
}

Nodes corner(const PathPlan& plan, int count) {
  Nodes nodes;
  const double leg_m = plan.length_m / 2.0;
  for (int i = 0; i <= count; ++i) {
    const double s_m = plan.length_m * i / count;
    nodes.emplace_back(std::min(s_m, leg_m), std::max(s_m - leg_m, 0.0));
  }
  return nodes;
}

Nodes eight(int count) {
  Nodes nodes;
  for (int i = 0; i <= count; ++i) {
    const double t = 2.0 * kPi * i / count;
    nodes.emplace_back(std::sin(t), std::sin(t) * std::cos(t));
  }
  return nodes;
}

Nodes free_path(const PathPlan& plan, int count, Stream& stream) {
  struct Bend {
    double turns, phase_rad, amplitude_rad;
  };
  std::array<Bend, 4> bends;
  for (Bend& bend : bends) {
    bend.turns = stream.uniform(0.3, 1.0) * std::max(plan.length_m / 2.0, 1.0);
    bend.phase_rad = stream.uniform(0.0, 2.0 * kPi);
    bend.amplitude_rad = stream.uniform(0.3, 1.1);
  }
  Nodes nodes = {Eigen::Vector2d::Zero()};
  for (int i = 0; i < count; ++i) {
    double heading_rad = 0.0;
    for (const Bend& bend : bends)
      heading_rad += bend.amplitude_rad * std::sin(2.0 * kPi * bend.turns * (i + 0.5) / count + bend.phase_rad);
    nodes.push_back(nodes.back() +
                    plan.length_m / count * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad)));
  }
  return nodes;
}

double length_m(const Nodes& nodes) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) sum_m += (nodes[i] - nodes[i - 1]).norm();
  return sum_m;
}

Nodes shaped(const PathPlan& plan, Stream& stream) {
  const int count = std::max(2, static_cast<int>(std::ceil(plan.length_m / kNode_m)));
  switch (plan.shape) {
    case PathShape::line:
      return line(plan, count);
    case PathShape::l:
      return corner(plan, count);
    case PathShape::eight: {
      Nodes nodes = eight(count);
      const double scale = plan.length_m / length_m(nodes);
      for (Eigen::Vector2d& node : nodes) node *= scale;
      return nodes;
    }
    case PathShape::free:
      break;
  }
  return free_path(plan, count, stream);
}

}  // namespace

std::vector<Eigen::Vector2d> plan_path(const PathPlan& plan, Stream& stream) {
  Nodes nodes = shaped(plan, stream);
  Eigen::Matrix2d turn;
  turn << std::cos(plan.heading_rad), -std::sin(plan.heading_rad), std::sin(plan.heading_rad),
      std::cos(plan.heading_rad);
  Eigen::Vector2d low = turn * nodes.front(), high = low;
  for (Eigen::Vector2d& node : nodes) {
    node = turn * node;
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  for (Eigen::Vector2d& node : nodes) node -= 0.5 * (low + high);
  return nodes;
}

}  // namespace tumble::sim
