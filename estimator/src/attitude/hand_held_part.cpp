// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hand_held_problem.hpp"
#include "tumble/common/types.hpp"

namespace tumble::hand_held {

namespace {

// The optimisation has converged if the cost changes by less than kCostChange. A cost change of kCostChange multiplies
// the odds between two solutions by 1.1.
constexpr double kCostChange = 0.2;
constexpr int kStepsMax = 30;

NodeMessage message(const Node& about, const System::StateBlock& block) {
  return {about, block.diagonal, block.gradient};
}

}  // namespace

System::StateVector node_difference(const Node& from, const Node& to) {
  System::StateVector out;
  out << so3::logarithm(from.q_WI.conjugate() * to.q_WI), to.w_WI_I_rad_s - from.w_WI_I_rad_s,
      to.angular_acceleration_rad_s2 - from.angular_acceleration_rad_s2, to.a_W_m_s2 - from.a_W_m_s2,
      to.v_W_m_s - from.v_W_m_s, to.p_W_m - from.p_W_m;
  return out;
}

double NodeMessage::add(const Node& node, System::StateBlock& block) const {
  const System::StateVector x = node_difference(linearisation_node, node), pull = information * x;
  block.diagonal += information;
  block.gradient += gradient - pull;
  return x.dot(pull) - 2.0 * x.dot(gradient);
}

HandHeldProblem::HandHeldProblem(const HandHeldProblem& whole, const ProblemSegment& part)
    : params_(whole.params_),
      sensing_directions_(whole.sensing_directions_),
      readings_(whole.readings_.subspan(part.first, part.last - part.first + 1)),
      motion_(whole.motion_),
      noise_(whole.noise_),
      g_W_m_s2_(whole.g_W_m_s2_),
      problem_segment_(part),
      nodes_(whole.nodes_.begin() + static_cast<std::ptrdiff_t>(part.first),
             whole.nodes_.begin() + static_cast<std::ptrdiff_t>(part.last + 1)),
      constants_(whole.constants_),
      jerk_(nodes_.size(), 1.0),
      hand_acceleration_factors_(whole.hand_acceleration_factors_.begin() + static_cast<std::ptrdiff_t>(part.first),
                                 whole.hand_acceleration_factors_.begin() + static_cast<std::ptrdiff_t>(part.last + 1)),
      state_blocks_(nodes_.size()) {}

// See carried.md (C17).
bool HandHeldProblem::condense_other_nodes(std::span<ProblemSegment> parts) const {
  System::BorderBlock unused;
  System::StateBlock here, next;
  motion_.add_initial_prior(nodes_[0], here);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    for (ProblemSegment& part : parts)
      if (part.first == i) part.message_from_before = message(nodes_[i], here);
    if (i + 1 == nodes_.size()) break;
    next = {};
    add_node(i, here, unused);
    motion_.add_motion_model(nodes_[i], nodes_[i + 1], hand_acceleration_factors_[i], here, next);
    if (!System::eliminate(here, &next, unused)) return false;
    here = next;
    here.border_coupling.setZero();
  }
  here = {};
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    for (ProblemSegment& part : parts)
      if (part.last == i) part.message_from_after = message(nodes_[i], here);
    if (i == 0) break;
    System::StateBlock before;
    add_node(i, here, unused);
    motion_.add_motion_model(nodes_[i - 1], nodes_[i], hand_acceleration_factors_[i - 1], before, here);
    const Eigen::LLT<System::StateMatrix> factor(here.diagonal);
    if (factor.info() != Eigen::Success) return false;
    const System::StateMatrix by = before.coupling_to_next_state * factor.solve(System::StateMatrix::Identity());
    before.diagonal -= by * before.coupling_to_next_state.transpose();
    before.gradient -= by * here.gradient;
    here = {};
    here.diagonal = 0.5 * (before.diagonal + before.diagonal.transpose());
    here.gradient = before.gradient;
  }
  return true;
}

double HandHeldProblem::iterate_to_convergence() {
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

void HandHeldProblem::set_nodes(std::size_t first, std::span<const Node> nodes) {
  std::copy(nodes.begin(), nodes.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace tumble::hand_held
