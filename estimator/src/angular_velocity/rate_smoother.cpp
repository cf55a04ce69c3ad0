// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "element_clipping.hpp"
#include "rate_first_guess.hpp"
#include "recording_check.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// Other first thresholds of contact, as multiples of the given one, and the share of clipped samples in flight below
// which they are tried.
constexpr double kOtherStarts[] = {16.0, 0.25};
constexpr double kFlightShareExpected = 0.5;

double median_force(std::span<const ImuSample> samples) {
  std::vector<double> force(samples.size());
  for (std::size_t k = 0; k < force.size(); ++k) force[k] = samples[k].specific_force_m_s2.norm();
  std::nth_element(force.begin(), force.begin() + static_cast<std::ptrdiff_t>(force.size() / 2), force.end());
  return force[force.size() / 2];
}

// The linear system of one iteration and its solution.
class Iteration {
 public:
  explicit Iteration(std::span<const RateObservation> observations)
      : observations_(observations), blocks_(observations.size()) {}

  bool factorise(const RateModel& model, std::span<const RateEstimate> estimates, const RigConstants& rig) {
    corner_ = {};
    model.add_rig_prior(rig, corner_);
    blocks_[0] = {};
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      model.add_sample(observations_[k], estimates[k], rig, blocks_[k], corner_);
      const bool last = k + 1 == blocks_.size();
      if (!last) {
        blocks_[k + 1] = {};
        const double dt_s = seconds(observations_[k + 1].sample.time_ns - observations_[k].sample.time_ns);
        model.add_step(estimates[k], estimates[k + 1], dt_s, blocks_[k], blocks_[k + 1]);
      }
      if (!arrow::eliminate(blocks_[k], last ? nullptr : &blocks_[k + 1], corner_)) return false;
    }
    return arrow::solve_corner(corner_, rig_step_, rig_covariance_);
  }

  // Adds the step, cut to step_max; returns the largest change of a rate.
  double apply(const RateModel& model, double step_max, std::span<RateEstimate> estimates, RigConstants& rig) const {
    double largest = 0.0;
    arrow::StateVector step;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      const bool last = k + 1 == blocks_.size();
      step = arrow::back_substitute(blocks_[k], last ? nullptr : &step, rig_step_);
      const Eigen::Matrix<double, 6, 1> physical = model.unscaled(step);
      const double length = physical.head<3>().norm();
      const double share = length > step_max ? step_max / length : 1.0;
      estimates[k].knot.rate_rad_s += share * physical.head<3>();
      estimates[k].knot.acceleration_rad_s2 += share * physical.tail<3>();
      largest = std::max(largest, length);
    }
    rig.add(rig_step_);
    return largest;
  }

  // Of the last factorisation, from the last sample to the first: use(k, conditional).
  template <typename Use>
  void for_each_conditional(Use use) const {
    arrow::Conditional conditional;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      conditional = arrow::back_conditional(blocks_[k], k + 1 == blocks_.size() ? nullptr : &conditional);
      use(k, conditional);
    }
  }

  // Of the last factorisation, how far sample k moves with each of kErrors common errors: use(k, moved). `add` gives
  // what they do to the gradient: add(k, of the sample, of the border). Returns how far the border moves.
  template <typename Add, typename Use>
  arrow::BorderErrors for_each_moved(Add add, Use use) const {
    std::vector<arrow::ErrorMatrix> errors(blocks_.size(), arrow::ErrorMatrix::Zero());
    arrow::BorderErrors border = arrow::BorderErrors::Zero();
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      add(k, errors[k], border);
      arrow::eliminate_errors(blocks_[k], errors[k], k + 1 == blocks_.size() ? nullptr : &errors[k + 1], border);
    }
    border = (rig_covariance_ * border).eval();
    arrow::ErrorMatrix moved;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      moved = arrow::back_substitute_errors(blocks_[k], errors[k], k + 1 == blocks_.size() ? nullptr : &moved, border);
      use(k, moved);
    }
    return border;
  }

  const RigConstants::Matrix& rig_covariance() const { return rig_covariance_; }

 private:
  std::span<const RateObservation> observations_;
  std::vector<arrow::Block> blocks_;
  arrow::Corner corner_;
  arrow::BorderVector rig_step_;
  RigConstants::Matrix rig_covariance_;
};

void weigh_all(const RateModel& model, std::span<const RateObservation> observations, const RigConstants& rig,
               const RigConstants::Matrix& rig_covariance, double widen, std::span<RateEstimate> estimates) {
  double before = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    double after = std::numeric_limits<double>::max();
    if (k + 1 < estimates.size()) {
      const double dt_s = seconds(observations[k + 1].sample.time_ns - observations[k].sample.time_ns);
      after = model.jump(estimates[k].knot, estimates[k + 1].knot, dt_s);
    }
    // where the gyro reads all axes nothing is unknown that would excuse a residual
    const int clipped = observations[k].unseen();
    model.weigh(observations[k], rig, rig_covariance, clipped != 0 ? widen : 1.0, std::min(before, after),
                estimates[k]);
    before = after;
  }
}

void count(const RateState& state, RateReport& report) {
  report.clipped += state.clipped_axes != 0;
  report.recovered_flight += state.source == RateSource::recovered_flight;
  report.recovered_contact += state.source == RateSource::recovered_contact;
  report.bounded_only += state.source == RateSource::bounded_only;
}

struct Solution {
  std::vector<RateEstimate> estimates;
  RigConstants rig;
  RigConstants::Matrix rig_covariance;
  Iteration iteration;
};

// Gauss-Newton from the first guess; false when a system is not positive definite.
bool descend(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
             double widen, Solution& solution, RateReport& health) {
  solution.estimates = first_guess(observations, params.model, model, params.gap_max_s);
  solution.rig = model.prior_constants();
  solution.rig_covariance = model.prior_covariance();
  std::vector<RateEstimate>& estimates = solution.estimates;
  int soft = 0;  // iterations with soft bounds
  health.iterations = 0;
  health.converged = false;
  while (health.iterations < params.iterations_max) {
    weigh_all(model, observations, solution.rig, solution.rig_covariance, widen, estimates);
    if (!solution.iteration.factorise(model, estimates, solution.rig)) return false;
    solution.rig_covariance = solution.iteration.rig_covariance();
    health.last_step_rad_s = solution.iteration.apply(model, params.step_max_rad_s, estimates, solution.rig);
    ++health.iterations;

    const bool settled = widen == 1.0 && health.last_step_rad_s < params.tolerance_rad_s;
    if (soft > 0) {
      solution.iteration.for_each_conditional([&](std::size_t k, const arrow::Conditional& conditional) {
        model.update_bounds(observations[k], solution.rig, conditional, solution.rig_covariance, params.bound_damping,
                            estimates[k]);
      });
    }
    if (soft > 0 || settled || health.iterations + params.bound_iterations >= params.iterations_max) {
      for (std::size_t k = 0; k < estimates.size() && soft == 0; ++k) {
        if (estimates[k].flight_weight >= 0.5) continue;
        model.seek_flight(observations[k], solution.rig, estimates[k]);
        model.start_bounds(observations[k], solution.rig, estimates[k]);
      }
      health.converged = settled || health.converged;
      if (soft++ == params.bound_iterations) break;
    }
    widen = std::max(1.0, 0.5 * widen);
  }
  health.rig_surprise = model.rig_surprise(solution.rig);
  return true;
}

// How much of what the gyro does not see is explained as free flight: the part of the robust cost that differs between
// the minima in which a run may end. `share`: of these samples, those that count as flight.
double explained(std::span<const RateObservation> observations, std::span<const RateEstimate> estimates,
                 double& share) {
  double sum = 0.0, unseen = 0.0, flight = 0.0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    sum += std::sqrt(estimates[k].flight_weight);
    if (observations[k].unseen() == 0) continue;
    unseen += 1.0;
    flight += estimates[k].flight_weight >= 0.5 ? 1.0 : 0.0;
  }
  share = unseen > 0.0 ? flight / unseen : 1.0;
  return sum;
}

// The descent, again from wider and narrower thresholds of contact where most clipped samples pass for contact: with
// a lever arm that is far off the first may end in a minimum in which nothing is flight.
bool solve(const RateSmoother::Params& params, const RateModel& model, std::span<const RateObservation> observations,
           Solution& solution, RateReport& health) {
  if (!descend(params, model, observations, params.widen_first, solution, health)) return false;
  double share = 1.0;
  double best = explained(observations, solution.estimates, share);
  for (const double factor : kOtherStarts) {
    if (share >= kFlightShareExpected) break;
    Solution other{{}, {}, {}, Iteration(observations)};
    RateReport other_health = health;
    const double widen = std::max(1.0, factor * params.widen_first);
    if (!descend(params, model, observations, widen, other, other_health)) continue;
    double other_share = 0.0;
    const double found = explained(observations, other.estimates, other_share);
    ++health.restarts;
    if (!(found > best)) continue;
    best = found;
    share = other_share;
    other_health.restarts = health.restarts;
    health = other_health;
    solution = std::move(other);
  }
  return true;
}

// What the scale and misalignment of gyro and accelerometer, which no run can tell from the rig's constants, add to the
// covariance of each rate and, returned, of the constants (S. F. Schmidt, 1966: parameters considered, not estimated).
RigConstants::Matrix consider_matrices(const RateModelParams& params, const RateModel& model,
                                       std::span<const RateObservation> observations, const Solution& solution,
                                       std::span<Eigen::Matrix3d> spread_rad2_s2) {
  RigConstants::Matrix of_rig = RigConstants::Matrix::Zero();
  const auto consider = [&](double sigma, auto add) {
    if (!(sigma > 0.0)) return;
    const arrow::BorderErrors moved =
        sigma * solution.iteration.for_each_moved(add, [&](std::size_t k, const arrow::ErrorMatrix& by_error) {
          const Eigen::Matrix<double, 3, arrow::kErrors> rates = sigma * by_error.topRows<3>();
          spread_rad2_s2[k].noalias() += rates.lazyProduct(rates.transpose());
        });
    of_rig += moved * moved.transpose();
  };
  consider(params.gyro_matrix_sigma, [&](std::size_t k, arrow::ErrorMatrix& block, arrow::BorderErrors& border) {
    model.add_gyro_errors(observations[k], solution.estimates[k], solution.rig, block, border);
  });
  consider(params.accel_matrix_sigma, [&](std::size_t k, arrow::ErrorMatrix& block, arrow::BorderErrors& border) {
    model.add_accel_errors(observations[k], solution.estimates[k], solution.rig, block, border);
  });
  return of_rig;
}

Status check_companions(const RateModelParams& params, std::span<const std::vector<CompanionReading>> companions,
                        std::size_t count) {
  const auto needed = static_cast<double>(params.companions.size());
  if (companions.size() != params.companions.size()) {
    return {Trouble::too_few, "companions", static_cast<double>(companions.size()), needed};
  }
  for (const std::vector<CompanionReading>& readings : companions) {
    if (readings.size() == count) continue;
    return {Trouble::too_few, "readings of a companion", static_cast<double>(readings.size()),
            static_cast<double>(count)};
  }
  return {};
}

// The rig as it was known; the gyro's elements, which flight cannot be taken for, stay free.
RateModelParams held(const RateModelParams& params, const RateModel& model) {
  constexpr int kFirst = RigConstants::kElements, kCount = RigConstants::kSize - kFirst;
  RateModelParams out = params;
  out.calibration = RigCalibration{model.prior_constants(), 1e-12 * RigConstants::Matrix::Identity()};
  out.calibration->covariance.block<kCount, kCount>(kFirst, kFirst) =
      model.prior_covariance().block<kCount, kCount>(kFirst, kFirst);
  return out;
}

}  // namespace

RateSmoother::RateSmoother(const Params& params)
    : params_(params), rails_({params.rails, params.planes}), rests_(params.rests) {
  require_within("iterations_max", params.iterations_max, 1, 1000);
  require_within("tolerance_rad_s", params.tolerance_rad_s, 1e-12, 1.0);
  require_within("step_max_rad_s", params.step_max_rad_s, 1e-3, 1e4);
  require_within("widen_first", params.widen_first, 1.0, 1000.0);
  require_within("recovered_sigma_rad_s", params.recovered_sigma_rad_s, 0.0, 1e4);
  require_within("bound_iterations", params.bound_iterations, 0, 1000);
  require_within("bound_damping", params.bound_damping, 0.01, 1.0);
  require_within("rig_surprise_max", params.rig_surprise_max, 0.1, 1e6);
  require_within("gap_max_s", params.gap_max_s, 1e-6, 3600.0);
  (void)RateModel(params.model, 0.01);  // throws on bad parameters
}

Status RateSmoother::estimate(std::span<const ImuSample> samples,
                              std::span<const std::vector<CompanionReading>> companions, std::vector<RateState>& out,
                              RateReport& report) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  if (Status status = check_companions(params_.model, companions, samples.size()); !status.ok()) return status;

  RateReport health;
  health.samples = samples.size();
  const ClippingFinder::Found found = rails_.find(samples);
  const KnownRails& rails = found.rails;
  const std::vector<Clipping>& clippings = found.clippings;
  const RailPlanes planes = rails.planes_in_use();
  health.planes = rails.planes;
  health.rails_upright = rails.upright;
  for (int c = 0; c < 6; ++c) {
    health.rail[static_cast<std::size_t>(c)] = rails_.walls().rail(rails.walls, c);
    if (c < 3 && planes.element[static_cast<std::size_t>(c)]) {
      health.rail[static_cast<std::size_t>(c)] = planes.element[static_cast<std::size_t>(c)]->distance_rad_s;
    }
    health.rail_disagrees[static_cast<std::size_t>(c)] = rails_.walls().disagrees(rails.walls, c);
  }
  const double force = median_force(samples);
  health.rate_unit_suspect = std::any_of(samples.begin(), samples.end(), [&](const ImuSample& sample) {
    return sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() > params_.model.rate_max_rad_s;
  });
  health.force_unit_suspect = force > 0.5 && force < 2.0;
  std::vector<RateObservation> observations(samples.size());
  const double period_s = median_period_s(samples);
  RateModelParams known = params_.model;
  known.calibration = with_planes(RateModel(params_.model, period_s), planes, rails.upright);
  const RateModel model(known, period_s);
  const std::vector<bool> rest = rests_.find(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    observations[k] = {samples[k], clippings[k], rest[k]};
    for (std::size_t i = 0; i < companions.size(); ++i) observations[k].companions[i] = companions[i][k];
    const ImuSample* const before = k > 0 ? &samples[k - 1] : nullptr;
    const ImuSample* const after = k + 1 < samples.size() ? &samples[k + 1] : nullptr;
    mark_partial(planes, rails_.walls(), rails.walls, model.gyro_sigma_rad_s(), before, observations[k], after);
    if (health.rails_upright) continue;
    doubt_unseen_rails(planes, model.gyro_sigma_rad_s(), before, observations[k], after);
  }
  Solution solution{{}, {}, {}, Iteration(observations)};
  if (!solve(params_, model, observations, solution, health)) {
    return {Trouble::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
  }
  health.calibration = {solution.rig, solution.rig_covariance};
  if (health.rig_surprise > params_.rig_surprise_max) {
    // contact was taken for flight of another rig: hold the rig to what was known of it
    const double surprise = health.rig_surprise;
    const RateModel fixed(held(known, model), period_s);
    if (!solve(params_, fixed, observations, solution, health)) {
      return {Trouble::diverged, "iteration", static_cast<double>(health.iterations), 0.0};
    }
    health.rig_held = true;
    health.rig_surprise = surprise;
    health.calibration = {model.prior_constants(), model.prior_covariance()};
  }

  std::vector<Eigen::Matrix3d> considered(samples.size(), Eigen::Matrix3d::Zero());
  const RigConstants::Matrix of_rig = consider_matrices(params_.model, model, observations, solution, considered);
  if (!health.rig_held) health.calibration.covariance += of_rig;

  std::vector<RateState> states(samples.size());
  std::size_t in_flight = 0;
  solution.iteration.for_each_conditional([&](std::size_t k, const arrow::Conditional& conditional) {
    const RateEstimate& estimate = solution.estimates[k];
    RateState& state = states[k];
    state.time_ns = samples[k].time_ns;
    state.w_WI_I_rad_s = estimate.knot.rate_rad_s;
    state.covariance_rad2_s2 = model.reported(
        arrow::rate_covariance(conditional, solution.rig_covariance) + considered[k], observations[k], estimate);
    state.clipped_axes = clippings[k].gyro | clippings[k].void_gyro;
    state.source = rate_source(observations[k], estimate, state.covariance_rad2_s2, params_.recovered_sigma_rad_s);
    count(state, health);
    health.void_readings += clippings[k].void_gyro != 0;
    in_flight += estimate.flight_weight >= 0.5;
  });
  health.flight_share = static_cast<double>(in_flight) / static_cast<double>(samples.size());
  out = std::move(states);
  report = health;
  return {};
}

}  // namespace tumble
