// SPDX-License-Identifier: BSD-3-Clause
// What a RateStream holds of its rig: as what left the window tells it, held, dropped, and doubted where it is given
// out.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

namespace {

// For so much of a window's steps a rig may be held; steps that agree with it count against those that do not.
constexpr double kHeldShare = 0.25;

}  // namespace

// The prior at another point than the one about which it stands: rate_stream.md (R91).
void RateStream::add_prior(const State& state, const RateKnot& knot, arrow::Block& block, arrow::Corner& corner) const {
  Eigen::Matrix<double, 6, 1> moved;
  moved << knot.rate_rad_s - state.prior_knot.rate_rad_s,
      knot.acceleration_rad_s2 - state.prior_knot.acceleration_rad_s2;
  const arrow::StateVector x = model_.scaled(moved);
  const arrow::BorderVector c = state.rig.vector() - state.prior_rig.vector();
  block.diagonal += state.prior.diagonal;
  block.border += state.prior.border;
  block.gradient += state.prior.gradient - state.prior.diagonal * x - state.prior.border * c;
  corner.matrix += state.prior_corner.matrix;
  corner.gradient += state.prior_corner.gradient - state.prior_corner.matrix * c - state.prior.border.transpose() * x;
}

// Whether constants lie beyond what a rig may be: rate_smoother.md (R4).
bool RateStream::is_another_rig(const RigConstants& rig) const {
  return model_.calibration_mahalanobis(rig) > params_.calibration_mahalanobis_max;
}

// The rig by what left the window and by the rails alone; false, and nothing done, where that is none either.
// rate_stream.md (R97)
bool RateStream::hold_rig(State& state) const {
  arrow::Block block;
  arrow::Corner corner;
  add_prior(state, state.window.front().estimate.knot, block, corner);
  add_rails(state, corner);
  const bool of_motion = !block.diagonal.isZero(0.0);  // not before anything has left
  if (of_motion && !arrow::eliminate(block, nullptr, corner)) return false;
  arrow::BorderVector moved;
  RigConstants::Matrix covariance;
  if (!arrow::solve_corner(corner, moved, covariance)) return false;
  RigConstants told = state.rig;
  told.add(moved);
  if (is_another_rig(told)) return false;
  state.rig = told;
  state.rig_covariance = covariance;
  return true;
}

// What was learnt of the rig and of the motion with it is dropped where it is no rig itself, or where the window has
// spoken against it for too long: then what has left took contact for flight. rate_stream.md (R98)
void RateStream::hold_or_forget_rig(State& state) const {
  ++state.rig_resets;
  ++state.held_steps;
  const double most = kHeldShare * static_cast<double>(capacity_) / static_cast<double>(every_);
  if (static_cast<double>(state.held_steps) <= most && hold_rig(state)) return;
  ++state.rig_drops;
  state.rig = state.prior_rig = model_.prior_constants();
  state.rig_covariance = model_.prior_covariance();
  state.prior = {};
  state.prior_corner = {};
  model_.add_rig_prior(state.rig, state.prior_corner);
  state.learnt_from = state.held_steps = 0;
}

// rate_stream.md (R93)
RigConstants::Matrix RateStream::widened(const State& state) const {
  if (params_.model.calibration) return state.rig_covariance;
  const double samples = static_cast<double>(state.learnt_from) / params_.rig_doubt_samples;
  const double largest = std::sqrt(1.0 + params_.rig_doubt / (1.0 + samples));
  RigConstants::Vector factor;
  for (int i = 0; i < RigConstants::kSize; ++i) {
    // nothing is known less than beforehand; the gyro's bias is told by rest, not by flight
    const bool of_gyro = i >= 3 && i < 6;
    const double before = std::sqrt(model_.prior_covariance()(i, i) / state.rig_covariance(i, i));
    factor[i] = of_gyro ? 1.0 : std::clamp(before, 1.0, largest);
  }
  return factor.asDiagonal() * state.rig_covariance * factor.asDiagonal();
}

// rate_stream.md (R96)
Eigen::Matrix3d RateStream::doubted(const Knot& knot, const State& state) const {
  Eigen::Matrix3d out = knot.covariance_rad2_s2;
  if (params_.model.calibration || knot.estimate.flight_weight >= 0.5) return out;
  const double samples = static_cast<double>(state.learnt_from) / params_.rig_doubt_samples;
  const double share = params_.contact_doubt / (1.0 + samples);
  for (int j = 0; j < 3; ++j) {
    if ((knot.observation.unseen() & knot.observation.clipping.gyro & 1u << j) == 0) continue;
    const double read = std::abs(knot.observation.sample.angular_velocity_rad_s[j]);
    const double least = share * std::max(0.0, std::abs(knot.estimate.knot.rate_rad_s[j]) - read);
    out(j, j) = std::max(out(j, j), least * least);
  }
  return out;
}

}  // namespace tumble
