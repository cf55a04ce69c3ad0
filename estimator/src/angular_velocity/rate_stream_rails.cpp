// SPDX-License-Identifier: BSD-3-Clause
// How the window of a RateStream is read by the rails, as they become known.
#include <Eigen/LU>

#include "element_clipping.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

// What walls say of the window now that more is known of them.
void RateStream::classify_again(State& state) const {
  RailDetector::State& walls = state.rails.known.walls;
  for (RailDetector::Channel& channel : walls.channels) channel.clipped = false;
  for (Knot& knot : state.window) knot.by_walls = rails_.walls().classify(knot.observation.sample, walls);
}

// Reads the samples of the window from `first` on with the rails as they are known. One that turns out to be clipped
// starts anew.
void RateStream::judge(std::size_t first, State& state) const {
  const KnownRails& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use(), accel_planes = rails.planes_in_use(Triad::accelerometer);
  const ElementRows accel_rows = rails.rows(Triad::accelerometer, params_.model.element_sigma);
  const double noise = model_.gyro_sigma_rad_s();
  for (std::size_t k = first; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    RateObservation& now = knot.observation;
    const ImuSample* const before = k > 0 ? &state.window[k - 1].observation.sample : nullptr;
    const ImuSample* const after = k + 1 < state.window.size() ? &state.window[k + 1].observation.sample : nullptr;
    const std::uint8_t read = now.unseen();
    Clipping by_walls = knot.by_walls;
    if (after != nullptr) {
      rails_.walls().add_edge(now.sample, *after, state.window[k + 1].by_walls, rails.walls, by_walls);
    }
    now.clipping = clip_by_planes(planes, Triad::gyro, by_walls, before, now.sample, after);
    now.clipping = clip_by_planes(accel_planes, Triad::accelerometer, now.clipping, before, now.sample, after);
    now.accel_rows = accel_rows;
    mark_partial(planes, rails_.walls(), rails.walls, noise, before, now, after);
    if (!rails.upright) doubt_unseen_rails(planes, noise, before, now, after);
    const bool newest = k + 1 == state.window.size();
    if (!newest && (now.unseen() & ~read) == 0) continue;
    if (!newest) {
      knot.age = 0;
      knot.estimate.soft_bounds = false;
    }
    if (k > 0) guess(knot, state.window[k - 1], state);
  }
}

// What the rails tell of the elements that clip at them: anew with each step, since they become known better.
void RateStream::add_rails(const State& state, arrow::Corner& corner) const {
  const KnownRails& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Index first = RigConstants::kElements + 2 * j;
    const auto told = told_slopes(planes, rails.upright, j, model_.prior_covariance().block<2, 2>(first, first));
    if (!told) continue;
    const Eigen::Matrix2d information = told->covariance.inverse();
    corner.matrix.block<2, 2>(first, first) += information;
    corner.gradient.segment<2>(first) -= information * (state.rig.elements.segment<2>(2 * j) - told->slopes);
  }
}

}  // namespace tumble
