// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hand_held_problem.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::hand_held {

namespace {

// A change of the cost by 0.2 corresponds to odds of 1.1.
constexpr double kCostChange = 0.2;
constexpr int kStepsMax = 30;  // maximum number of iterations

Message message(const Node& about, const System::Block& block) {
  return {about, block.diagonal, block.gradient};
}

}  // namespace

System::StateVector moved(const Node& from, const Node& to) {
  System::StateVector out;
  out << so3::log(from.q_WI.conjugate() * to.q_WI), to.w_WI_I_rad_s - from.w_WI_I_rad_s,
      to.angular_acceleration_rad_s2 - from.angular_acceleration_rad_s2, to.a_W_m_s2 - from.a_W_m_s2,
      to.v_W_m_s - from.v_W_m_s, to.p_W_m - from.p_W_m;
  return out;
}

double Message::add(const Node& node, System::Block& block) const {
  const System::StateVector x = moved(about, node), pull = information * x;
  block.diagonal += information;
  block.gradient += gradient - pull;
  return x.dot(pull) - 2.0 * x.dot(gradient);
}

Problem::Problem(const Problem& whole, const Part& part)
    : params_(whole.params_),
      rows_(whole.rows_),
      readings_(whole.readings_.subspan(part.first, part.last - part.first + 1)),
      motion_(whole.motion_),
      noise_(whole.noise_),
      g_W_m_s2_(whole.g_W_m_s2_),
      part_(part),
      nodes_(whole.nodes_.begin() + static_cast<std::ptrdiff_t>(part.first),
             whole.nodes_.begin() + static_cast<std::ptrdiff_t>(part.last + 1)),
      constants_(whole.constants_),
      jerk_(nodes_.size(), 1.0),
      hand_(whole.hand_.begin() + static_cast<std::ptrdiff_t>(part.first),
            whole.hand_.begin() + static_cast<std::ptrdiff_t>(part.last + 1)),
      blocks_(nodes_.size()) {}

// See carried.md (C17).
bool Problem::condense_rest(std::span<Part> parts) const {
  System::Corner unused;
  System::Block here, next;
  motion_.add_initial_prior(nodes_[0], here);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (Part& part : parts)
      if (part.first == i) part.before = message(nodes_[i], here);
    if (i + 1 == nodes_.size()) break;
    next = {};
    add_node(i, here, unused);
    motion_.add_step(nodes_[i], nodes_[i + 1], hand_[i], here, next);
    if (!System::eliminate(here, &next, unused)) return false;
    here = next;
    here.border.setZero();
  }
  here = {};
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    for (Part& part : parts)
      if (part.last == i) part.after = message(nodes_[i], here);
    if (i == 0) break;
    System::Block before;
    add_node(i, here, unused);
    motion_.add_step(nodes_[i - 1], nodes_[i], hand_[i - 1], before, here);
    const Eigen::LLT<System::StateMatrix> factor(here.diagonal);
    if (factor.info() != Eigen::Success) return false;
    const System::StateMatrix by = before.coupling * factor.solve(System::StateMatrix::Identity());
    before.diagonal -= by * before.coupling.transpose();
    before.gradient -= by * here.gradient;
    here = {};
    here.diagonal = 0.5 * (before.diagonal + before.diagonal.transpose());
    here.gradient = before.gradient;
  }
  return true;
}

double Problem::converge() {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double before = kNone;
  for (int k = 0; k < kStepsMax; ++k) {
    const double cost = linearise();
    if (std::abs(cost - before) < kCostChange) return cost;
    before = cost;
    double largest = 0.0;
    if (!step(largest)) return kNone;
  }
  return kNone;
}

void Problem::place(std::size_t first, std::span<const Node> nodes) {
  std::copy(nodes.begin(), nodes.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace tumble::hand_held
