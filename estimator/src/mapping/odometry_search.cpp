// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "odometry_impl.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kExcessTries_rad_s[] = {3.0, 6.0, 9.0, 15.0};
constexpr int kExcessTriesMax = 5;       // of these for one sweep, all axes together
constexpr int kStartsPerSweep = 3;       // of a search, the prior itself among them
constexpr std::size_t kFewPoints = 300;  // serve a start that may be far off
constexpr double kSearchTurn_rad = 0.3;  // starts of a search reach so far at first, in attitude
constexpr double kSearchShift_m = 1.0;   // and so far in position
constexpr int kSearchRounds = 3;         // each reaches that much further than the last
constexpr int kStarts = 1 + 12 * kSearchRounds;

// What one sweep may cost, in searches for a point's neighbours (2 to 3 us each on a core of 2.6 GHz). A registration
// from a good prior needs little more than one per point; one that wanders would need as many as it has iterations.
constexpr std::size_t kFirstSearches = 7'000;  // of the first registration, at least kFirstPerPoint per point
constexpr double kFirstPerPoint = 1.25;
constexpr double kCoarsePerPoint = 5.0;         // of each start that is explored
constexpr std::size_t kEnoughPoints = 3'000;    // serve the registration that finds the way back
constexpr std::size_t kFineSearches = 6'000;    // of it
constexpr std::size_t kSweepSearches = 17'000;  // of all, beyond which nothing further is begun

std::size_t times(double share, std::size_t count) {
  return static_cast<std::size_t>(share * static_cast<double>(count));
}

/// At most `count` of the points, evenly.
void thin(std::span<const SweepPoint> points, std::size_t count, std::vector<SweepPoint>& few) {
  few.clear();
  const std::size_t every = std::max<std::size_t>(1, (points.size() + count - 1) / count);
  for (std::size_t i = 0; i < points.size(); i += every) few.push_back(points[i]);
}

/// Start number `index` of a search: moved along each axis by what it may be off by, nearer ones first.
Registration::Prior moved_start(Registration::Prior prior, int index) {
  const double reach = 1.0 + (index - 1) / 12;
  const int axis = (index - 1) / 2 % 6;
  const double sign = (index - 1) % 2 == 0 ? 1.0 : -1.0;
  const double sigma = std::sqrt(prior.covariance(axis, axis));
  MotionState& state = prior.mean.state;
  if (axis < 3) {
    state.p_WI_m[axis] += sign * std::clamp(1.5 * sigma, 0.3, reach * kSearchShift_m);
  } else {
    const double angle = sign * std::clamp(1.5 * sigma, 0.1, reach * kSearchTurn_rad);
    state.q_WI = so3::exp(angle * Eigen::Vector3d::Unit(axis - 3)) * state.q_WI;
  }
  return prior;
}

}  // namespace

void LidarInertialOdometry::Impl::choose_few() {
  thin(chosen, kFewPoints, few);
}

/// Follows a start that may be far off, coarsely and with few points, and keeps where it leads to.
Status LidarInertialOdometry::Impl::explore(const Registration::Prior& start, TimeNs end_ns,
                                            Registration::Result& found) {
  const Status status =
      coarse.align(start, samples, end_ns, few, map, trajectory, found, times(kCoarsePerPoint, few.size()));
  searches += found.searches;
  if (!status.ok() || found.verdict != RegistrationVerdict::converged) return status;
  landings.push_back({start, found.inliers});
  landings.back().start.mean.state = found.mean.state;
  landings.back().start.excess_start_rad_s = found.mean.excess_rad_s;
  return status;
}

/// Registers from where the starts led to, the best first, as far as the sweep's share of work goes.
Status LidarInertialOdometry::Impl::refine(TimeNs end_ns, Registration::Result& found) {
  std::stable_sort(landings.begin(), landings.end(),
                   [](const auto& a, const auto& b) { return a.inliers > b.inliers; });
  Status status;
  thin(chosen, kEnoughPoints, few);
  for (const mapping::Landing& landing : landings) {
    if (searches + few.size() > kSweepSearches) break;
    const int iterations = found.iterations;
    status = registration.align(landing.start, samples, end_ns, few, map, trajectory, found, kFineSearches);
    searches += found.searches;
    found.iterations += iterations;
    if (!status.ok() || found.verdict == RegistrationVerdict::converged) return status;
  }
  return status;
}

/// Registers; where that fails and the rate may be short on a clipped axis, tries again from larger excess rates, since
/// a rail that is left behind within one sweep may put the start a whole radian off.
Status LidarInertialOdometry::Impl::align(const Registration::Prior& prior, TimeNs end_ns,
                                          Registration::Result& found) {
  const std::size_t allowed = std::max(kFirstSearches, times(kFirstPerPoint, chosen.size()));
  Status status = registration.align(prior, samples, end_ns, chosen, map, trajectory, found, allowed);
  if (!status.ok() || found.verdict == RegistrationVerdict::converged) return status;
  const RegistrationVerdict verdict = found.verdict;  // of the sweep where nothing is found
  searches = found.searches;
  landings.clear();
  Registration::Result rough;
  // with few points and a wide kernel it may find its way
  if (verdict == RegistrationVerdict::diverged) status = explore(prior, end_ns, rough);
  int tries = 0;
  const std::size_t reserve = times(kCoarsePerPoint, few.size()) + kFineSearches;
  for (const double more : kExcessTries_rad_s) {
    for (int axis = 0; axis < 3; ++axis) {
      const int first = Registration::kExcess + axis;
      if (!status.ok() || tries == kExcessTriesMax || searches + reserve > kSweepSearches) break;
      if (std::sqrt(prior.covariance(first, first)) < more / 5.0) continue;
      Registration::Prior start = prior;
      start.excess_start_rad_s.row(axis).array() += more;
      status = explore(start, end_ns, rough);
      ++tries;
    }
  }
  if (status.ok()) status = refine(end_ns, found);
  if (found.verdict != RegistrationVerdict::converged) found.verdict = verdict;
  return status;
}

/// Looks for the way back: from the prior and from starts around it. A search goes on with the next sweep where this
/// one ended, so that no sweep costs too much.
Status LidarInertialOdometry::Impl::search(const Registration::Prior& prior, TimeNs end_ns,
                                           Registration::Result& found) {
  searches = 0;
  landings.clear();
  Status status = explore(prior, end_ns, found);
  const RegistrationVerdict verdict = found.verdict;  // of the sweep where nothing is found
  for (int k = 0; status.ok() && k + 1 < kStartsPerSweep; ++k) {
    const int index = 1 + (failed_searches * (kStartsPerSweep - 1) + k) % (kStarts - 1);
    Registration::Result rough;
    status = explore(moved_start(prior, index), end_ns, rough);
    found.iterations += rough.iterations;
  }
  if (!status.ok()) return status;
  found.verdict = RegistrationVerdict::diverged;
  status = refine(end_ns, found);
  if (found.verdict != RegistrationVerdict::converged && verdict != RegistrationVerdict::converged)
    found.verdict = verdict;
  return status;
}

}  // namespace tumble
