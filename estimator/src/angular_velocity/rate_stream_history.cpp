// SPDX-License-Identifier: BSD-3-Clause
// What has left the window of RateStream: marginalised, kept, and linearised anew when the rig is known better.
#include <algorithm>
#include <cmath>
#include <limits>

#include "rate_stream_prior.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

double seconds_between(const RateStream::Knot& from, const RateStream::Knot& to) {
  return seconds(to.observation.sample.time_ns - from.observation.sample.time_ns);
}

void add_prior(const RateStream::Prior& prior, const RateModel& model, const RateKnot& knot, const RigConstants& rig,
               arrow::Block& block, arrow::Corner& corner) {
  Eigen::Matrix<double, 6, 1> moved;
  moved << knot.rate_rad_s - prior.knot.rate_rad_s, knot.acceleration_rad_s2 - prior.knot.acceleration_rad_s2;
  const arrow::StateVector x = model.scaled(moved);
  const arrow::BorderVector c = rig.vector() - prior.rig.vector();
  block.diagonal += prior.block.diagonal;
  block.border += prior.block.border;
  block.gradient += prior.block.gradient - prior.block.diagonal * x - prior.block.border * c;
  corner.matrix += prior.corner.matrix;
  corner.gradient += prior.corner.gradient - prior.corner.matrix * c - prior.block.border.transpose() * x;
}

// Takes a sample into the prior of the next. False when nothing can be said of it: then what was known of the rig
// beforehand is all that is left.
bool RateStream::absorb(const Knot& oldest, const Knot& next, bool doubted, const State& state, Prior& prior) const {
  arrow::Block block, after;
  arrow::Corner corner;
  add_prior(prior, model_, oldest.estimate.knot, state.rig, block, corner);
  model_.add_sample(oldest.observation, oldest.estimate, state.rig, block, corner,
                    doubted ? &state.rig_covariance : nullptr);
  model_.add_step(oldest.estimate, next.estimate, seconds_between(oldest, next), block, after);
  const bool sound = arrow::eliminate(block, &after, corner);
  prior = {};
  if (sound) {
    prior.block = after;
    prior.corner = corner;
  } else {
    model_.add_rig_prior(state.rig, prior.corner);
  }
  prior.knot = next.estimate.knot;
  prior.rig = state.rig;
  return sound;
}

bool RateStream::refresh_due(const State& state) const {
  if (state.history.empty() || state.since_refresh < params_.refresh_samples) return false;
  const RigConstants::Vector moved = (state.rig.vector() - state.history_rig.vector()).cwiseAbs();
  return (moved.array() > params_.refresh_moved * state.rig_covariance.diagonal().array().sqrt()).any();
}

// One iteration of the batch over history and window.
bool RateStream::refresh(State& state) const {
  state.since_refresh = 0;
  const std::size_t old = state.history.size(), count = old + state.window.size();
  const auto knot = [&](std::size_t k) -> Knot& { return k < old ? state.history[k] : state.window[k - old]; };

  double before = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < old; ++k) {
    const double after =
        model_.jump(knot(k).estimate.knot, knot(k + 1).estimate.knot, seconds_between(knot(k), knot(k + 1)));
    model_.weigh(knot(k).observation, state.rig, state.rig_covariance, 1.0, std::min(before, after), knot(k).estimate);
    before = after;
  }

  std::vector<arrow::Block>& blocks = state.work;
  arrow::Corner corner;
  blocks[0] = {};
  add_prior(state.base, model_, knot(0).estimate.knot, state.rig, blocks[0], corner);
  std::size_t flight_end = 0;  // of the flight that sample k belongs to
  std::size_t flight_begin = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (k == old) {
      state.prior.block = blocks[k];
      state.prior.corner = corner;
      state.prior.knot = knot(k).estimate.knot;
      state.prior.rig = state.rig;
    }
    if (k >= flight_end) {
      flight_begin = flight_end = k;
      while (flight_end < count && knot(flight_end).estimate.flight_weight >= 0.5) ++flight_end;
      flight_end = std::max(flight_end, k + 1);
    }
    const bool doubted = k < old && flight_end - flight_begin < static_cast<std::size_t>(params_.flight_run_min);
    model_.add_sample(knot(k).observation, knot(k).estimate, state.rig, blocks[k], corner,
                      doubted ? &state.rig_covariance : nullptr);
    const bool last = k + 1 == count;
    if (!last) {
      blocks[k + 1] = {};
      model_.add_step(knot(k).estimate, knot(k + 1).estimate, seconds_between(knot(k), knot(k + 1)), blocks[k],
                      blocks[k + 1]);
    }
    if (!arrow::eliminate(blocks[k], last ? nullptr : &blocks[k + 1], corner)) return false;
  }
  arrow::BorderVector rig_step;
  arrow::BorderMatrix rig_covariance;
  if (!arrow::solve_corner(corner, rig_step, rig_covariance)) return false;
  state.history_rig = state.rig;
  state.rig_covariance = rig_covariance;
  state.rig.add(rig_step);
  arrow::StateVector x;
  arrow::Conditional conditional;
  for (std::size_t k = count; k-- > 0;) {
    const bool last = k + 1 == count;
    x = arrow::back_substitute(blocks[k], last ? nullptr : &x, rig_step);
    conditional = arrow::back_conditional(blocks[k], last ? nullptr : &conditional);
    apply(x, conditional, state, knot(k));
    ++knot(k).age;
  }
  return true;
}

// What is older than the history is long is marginalised for good.
void RateStream::shorten_history(State& state) const {
  const std::size_t surplus = state.history.size() - history_capacity_;
  for (std::size_t k = 0; k < surplus; ++k) {
    if (!absorb(state.history[k], state.history[k + 1], false, state, state.base)) ++state.failures;
  }
  state.history.erase(state.history.begin(), state.history.begin() + static_cast<std::ptrdiff_t>(surplus));
}

}  // namespace tumble
