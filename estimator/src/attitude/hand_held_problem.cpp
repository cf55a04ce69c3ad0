// SPDX-License-Identifier: BSD-3-Clause
#include "hand_held_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/attitude/detail/hand_held_model.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

template struct BlockArrowSystem<hand_held::kBlockSize, hand_held::kBorderSize>;

}  // namespace tumble

namespace tumble::hand_held {

using Eigen::Vector3d;

namespace {

constexpr double kRestSigma_rad_s = 0.01;  // standard deviation of the rate at rest, per time step (node)
constexpr double kRestSigma_m_s = 0.02;
constexpr double kRestSigma_m_s2 = 0.1;

// largest change of an attitude in one iteration, for which the linearisation is still valid
constexpr double kRotationMax_rad = 0.8;
// The optimisation has converged if attitudes change by at most kConvergenceTolerance [rad], and rates by at most ten
// times this number [rad/s].
constexpr double kConvergenceTolerance = 1e-3;
// number of iterations before the optimisation estimates the spectral density of the hand's acceleration
constexpr int kFirstAdaptIteration = 3;
constexpr int kLastAdaptIteration = 8;
constexpr int kHalvings = 4;          // maximum number of times that a step is halved if the cost increases
constexpr double kCostRiseMax = 0.2;  // tolerated increase of the cost, corresponding to odds of 1.1
constexpr ErrorCode kLost = ErrorCode::diverged;

// The reported covariance neglects the lower bounds from saturated readings. For averaging windows of length P and the
// jerk density q, the mean rate minus the rate at the window's centre has the variance q P^3/320: carried.md (C26).
ReadingNoise noise_from_data_sheet(const HandHeldSmoother::Params& params, ReadingNoise noise, double period_s) {
  noise.bound = 0.0;
  noise.window_rate_sigma_rad_s = params.jerk_rad_s3_sqrts * std::sqrt(period_s * period_s * period_s / 320.0);
  return noise;
}

// The optimisation has converged if the cost changes by less than kCostChange. A cost change of kCostChange multiplies
// the odds between two solutions by 1.1.
constexpr double kCostChange = 0.2;
constexpr int kStepsMax = 30;

NodeMessage message(const Node& about, const System::StateBlock& block) {
  return {about, block.diagonal, block.gradient};
}

}  // namespace

Motion::Params motion_params(const HandHeldSmoother::Params& p, double jerk) {
  Motion::Params out;
  out.step_s = p.expert.node_s;
  out.jerk_rad_s3_sqrts = jerk * p.jerk_rad_s3_sqrts;
  out.rotation_error_sqrts = HandHeldSensorParams::kRotationError_sqrts;
  out.hand_sigma_m_s2 = p.hand_sigma_m_s2, out.hand_tau_s = p.expert.hand_motion.kHandTau_s;
  out.velocity_m_s = p.expert.hand_motion.kVelocity_m_s, out.velocity_tau_s = p.expert.hand_motion.kVelocityTau_s;
  out.position_m = p.expert.hand_motion.kPosition_m, out.position_tau_s = p.expert.hand_motion.kPositionTau_s,
  out.position_leak_s = p.expert.hand_motion.kPositionLeak_s;
  return out;
}

ReadingNoise reading_noise(const HandHeldSmoother::Params& p, double period_s) {
  const double root_rate = 1.0 / std::sqrt(period_s);
  ReadingNoise out;
  out.gyro_rad_s = p.gyro_noise_density * root_rate;
  out.deficit_error_ratio = HandHeldSensorParams::kDeficitErrorRatio;
  out.saturation_limit_sigma_rad_s = HandHeldSensorParams::kRailSigma_rad_s;
  out.accel_m_s2 = p.accel_noise_density * root_rate;
  out.force_noise_ratio = HandHeldSensorParams::kAccelErrorRatio;
  out.stationary_rate_sigma_rad_s = kRestSigma_rad_s;
  out.stationary_velocity_sigma_m_s = kRestSigma_m_s;
  out.stationary_acceleration_sigma_m_s2 = kRestSigma_m_s2;
  return out;
}

HandHeldProblem::HandHeldProblem(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows,
                                 const NodeData& collected, std::vector<Node> nodes)
    : params_(params),
      sensing_directions_(rows),
      readings_(collected.nodes),
      measured_jerk_(collected.jerk),
      motion_(motion_params(params)),
      period_s_(collected.rates.averaging_windows.period_s),
      noise_(reading_noise(params, period_s_)),
      g_W_m_s2_(0.0, 0.0, -params.gravity_m_s2),
      nodes_(std::move(nodes)),
      jerk_(nodes_.size(), 1.0),
      hand_acceleration_factors_(nodes_.size(), 1.0),
      hand_power_cumulative_(nodes_.size() + 1, 0.0),
      state_blocks_(nodes_.size()) {}

double add_node(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise,
                const Vector3d& g_W_m_s2, const Motion& motion, const Node& node, const Constants& constants,
                System::StateBlock& block, System::BorderBlock& corner) {
  double cost = add_gyro(readings, rows, noise, node, constants, block, corner);
  cost += add_force(readings, g_W_m_s2, noise, node, constants, block, corner);
  cost += motion.add_bounds(node, block);
  if (readings.is_stationary) cost += add_rest(noise, node, block);
  return cost;
}

// See carried.md (C1).
double add_constants_prior(const HandHeldSmoother::Params& params, const Constants& constants,
                           System::BorderBlock& corner) {
  double cost = 0.0;
  const auto prior = [&](const Vector3d& value, double sigma, int at) {
    const double information = 1.0 / (sigma * sigma);
    corner.matrix.diagonal().segment<3>(at).array() += information;
    corner.gradient.segment<3>(at) -= information * value;
    cost += information * value.squaredNorm();
  };
  prior(constants.gyro_bias_rad_s, params.gyro_bias_sigma_rad_s, kGyroBias);
  prior(constants.accel_bias_m_s2, params.accel_bias_sigma_m_s2, kAccelBias);
  prior(constants.lever_arm_m, params.lever_arm_sigma_m, kLever);
  return cost;
}

double HandHeldProblem::add_node(std::size_t i, System::StateBlock& block, System::BorderBlock& corner) const {
  ReadingNoise noise = noise_;
  noise.window_rate_sigma_rad_s *= jerk_[i];
  return hand_held::add_node(readings_[i], sensing_directions_, noise, g_W_m_s2_, motion_, nodes_[i], constants_, block,
                             corner);
}

double HandHeldProblem::linearise() {
  std::fill(state_blocks_.begin(), state_blocks_.end(), System::StateBlock{});
  border_block_ = {};
  double cost = problem_segment_ ? problem_segment_->message_from_before.add(nodes_.front(), state_blocks_.front()) +
                                       problem_segment_->message_from_after.add(nodes_.back(), state_blocks_.back())
                                 : motion_.add_initial_prior(nodes_[0], state_blocks_[0]);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    cost += add_node(i, state_blocks_[i], border_block_);
    if (i + 1 < nodes_.size())
      cost += motion_.add_motion_model(nodes_[i], nodes_[i + 1], hand_acceleration_factors_[i], state_blocks_[i],
                                       state_blocks_[i + 1], jerk_[i]);
  }
  if (problem_segment_) {
    border_block_ = {};
    border_block_.matrix.setIdentity();
    for (System::StateBlock& block : state_blocks_) block.border_coupling.setZero();
    return cost;
  }
  cost += add_constants_prior(params_, constants_, border_block_);
  return cost;
}

// See carried.md (C17), (C18).
bool HandHeldProblem::eliminate(System::BorderVector& step) {
  for (std::size_t i = 0; i < state_blocks_.size(); ++i) {
    System::StateBlock* const next = i + 1 < state_blocks_.size() ? &state_blocks_[i + 1] : nullptr;
    if (!System::eliminate(state_blocks_[i], next, border_block_)) return false;
  }
  return System::solve_border_block(border_block_, step, constants_covariance_);
}

// See carried.md (C19).
bool HandHeldProblem::step(double& largest) {
  if (!eliminate(border_unknowns_step_)) return false;
  state_steps_.resize(state_blocks_.size());
  double turn = 0.0;
  largest = 0.0;
  for (std::size_t i = state_blocks_.size(); i-- > 0;) {
    const System::StateVector* const next = i + 1 < state_blocks_.size() ? &state_steps_[i + 1] : nullptr;
    state_steps_[i] = System::back_substitute(state_blocks_[i], next, border_unknowns_step_).eval();
    const double moved = state_steps_[i].segment<3>(kAttitudeError).norm();
    turn = std::max(turn, moved);
    largest = std::max({largest, moved, 0.1 * state_steps_[i].segment<3>(kRate).norm()});
  }
  if (!std::isfinite(turn)) return false;
  const double share = turn > kRotationMax_rad ? kRotationMax_rad / turn : 1.0;
  for (System::StateVector& each : state_steps_) each *= share;
  border_unknowns_step_ *= share;
  apply_state_step(1.0);
  return true;
}

void HandHeldProblem::apply_state_step(double share) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].move(share * state_steps_[i]);
  constants_.move(share * border_unknowns_step_);
}

// See carried.md (C10).
void HandHeldProblem::adapt_process_noise() {
  const std::size_t count = nodes_.size();
  const double assumed = 3.0 * params_.hand_sigma_m_s2 * params_.hand_sigma_m_s2;
  for (std::size_t i = 0; i < count; ++i)
    hand_power_cumulative_[i + 1] = hand_power_cumulative_[i] + nodes_[i].a_W_m_s2.squaredNorm() / assumed;
  const auto half = static_cast<std::size_t>(0.5 * params_.expert.hand_motion.kHandWindow_s / params_.expert.node_s);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = i > half ? i - half : 0, b = std::min(count, i + half + 1);
    const double local = (hand_power_cumulative_[b] - hand_power_cumulative_[a]) / static_cast<double>(b - a);
    hand_acceleration_factors_[i] = std::max(params_.expert.hand_motion.kHandNoiseFloorRatio,
                                             1.0 + params_.expert.hand_motion.hand_noise_adaptation * (local - 1.0));
  }
}

void HandHeldProblem::restore(Solution answer) {
  nodes_ = std::move(answer.nodes);
  constants_ = answer.constants;
  constants_covariance_ = answer.constants_covariance;
  hand_acceleration_factors_ = std::move(answer.hand_acceleration_factors);
  covariances_ = std::move(answer.covariances);
}

// See carried.md (C19), (C20).
Status HandHeldProblem::solve(HandHeldSmoother::Report& report) {
  std::optional<Iterate> before;
  report.converged = false;
  for (int k = 0; k < params_.expert.iterations_max; ++k) {
    if (k >= kFirstAdaptIteration && k <= kLastAdaptIteration &&
        params_.expert.hand_motion.hand_noise_adaptation > 0.0) {
      adapt_process_noise();
      before.reset();  // costs with different process noise are not comparable
    }
    report.cost = linearise();
    if (before && !halve_step_until_decrease(*before, report.cost)) break;
    before = Iterate{nodes_, constants_, report.cost};
    double largest = 0.0;
    if (!step(largest))
      return {kLost, "iteration in which the smoother for hand-held motion failed", k + 1.0, static_cast<double>(k)};
    report.iterations = k + 1;
    report.converged = largest < kConvergenceTolerance;
    if (report.converged && k > kFirstAdaptIteration) break;
  }
  if (before && !report.converged) {
    report.cost = linearise();
    (void)halve_step_until_decrease(*before, report.cost);
  }
  report.constants = constants_;
  return {};
}

bool HandHeldProblem::halve_step_until_decrease(const Iterate& before, double& cost) {
  const auto cost_decreases = [&] { return cost < before.cost + kCostRiseMax; };
  for (int k = 0; k < kHalvings && !cost_decreases(); ++k) {
    nodes_ = before.nodes;
    constants_ = before.constants;
    apply_state_step(std::ldexp(1.0, -k - 1));
    cost = linearise();
  }
  if (cost_decreases()) return true;
  nodes_ = before.nodes;
  constants_ = before.constants;
  cost = linearise();
  return false;
}

// See carried.md (C21), (C22), (C23).
Status HandHeldProblem::covariances(HandHeldSmoother::Report& report) {
  for (std::size_t i = 0; i < jerk_.size(); ++i)
    jerk_[i] = std::max(params_.expert.jerk_inflation, measured_jerk_[i] / params_.jerk_rad_s3_sqrts);
  const ReadingNoise assumed = std::exchange(noise_, noise_from_data_sheet(params_, noise_, period_s_));
  (void)linearise();
  noise_ = assumed;
  std::fill(jerk_.begin(), jerk_.end(), 1.0);
  System::BorderVector unused;
  if (!eliminate(unused))
    return {kLost, "cost when the covariance of the smoother for hand-held motion failed", report.cost, 0.0};
  report.constants_covariance = constants_covariance_;
  covariances_.resize(nodes_.size());
  System::StateGivenNextState here, next;
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    here = System::state_given_next_state(state_blocks_[i], i + 1 < nodes_.size() ? &next : nullptr);
    const Eigen::Matrix<double, 9, kBorderSize> rows = here.border_jacobian.topRows<9>();
    covariances_[i] = here.state.topLeftCorner<9, 9>();
    covariances_[i].noalias() += rows * constants_covariance_ * rows.transpose();
    next = here;
  }
  return {};
}

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
