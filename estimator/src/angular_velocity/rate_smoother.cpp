// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "element_clipping.hpp"
#include "near_rails.hpp"
#include "rate_rounds.hpp"
#include "sample_hold.hpp"
#include "tumble/angular_velocity/detail/held_rates.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"
#include "unseen_rails.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// Deviations within which a delay that both triads share lies: three in a hundred normal ones lie beyond.
constexpr double kSharedReach = 2.0;

double median_force(std::span<const ImuSample> samples) {
  std::vector<double> force(samples.size());
  for (std::size_t k = 0; k < force.size(); ++k) force[k] = samples[k].specific_force_m_s2.norm();
  std::nth_element(force.begin(), force.begin() + static_cast<std::ptrdiff_t>(force.size() / 2), force.end());
  return force[force.size() / 2];
}

void count(const RateState& state, RateReport& report) {
  report.clipped += state.clipped_axes != 0;
  report.recovered_flight += state.source == RateSource::recovered_flight;
  report.recovered_contact += state.source == RateSource::recovered_contact;
  report.bounded_only += state.source == RateSource::bounded_only;
}

// Readings that a triad says twice, and how old they are.
void mark_held(const std::optional<HeldReadings>& gyro, const std::optional<HeldReadings>& accel,
               std::span<RateObservation> observations, RateReport& health) {
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (gyro) {
      observations[k].gyro_age_s = gyro->age_s[k];
      observations[k].gyro_repeats = gyro->repeats[k] && !observations[k].at_rest;
    }
    if (accel) observations[k].accel_age_s = accel->age_s[k];
  }
  if (gyro) health.gyro_update_s = gyro->period_s;
  if (accel) health.accel_update_s = accel->period_s;
}

Status check_auxiliary_imus(const RateModelParams& params,
                            std::span<const std::vector<AuxiliaryReading>> auxiliary_imus, std::size_t count) {
  const auto needed = static_cast<double>(params.auxiliary_imus.size());
  if (auxiliary_imus.size() != params.auxiliary_imus.size()) {
    return {Trouble::too_few, "auxiliary_imus", static_cast<double>(auxiliary_imus.size()), needed};
  }
  for (const std::vector<AuxiliaryReading>& readings : auxiliary_imus) {
    if (readings.size() == count) continue;
    return {Trouble::too_few, "readings of an auxiliary_imu", static_cast<double>(readings.size()),
            static_cast<double>(count)};
  }
  return {};
}

// What a gyro that is slower than the log says of each sample's own time, where it reads all axes.
std::vector<std::optional<HeldRate>> read_in_time(std::span<const ImuSample> samples,
                                                  std::span<const RateObservation> observations,
                                                  const std::optional<HeldReadings>& gyro) {
  std::vector<std::uint8_t> hidden(samples.size());
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    const RateObservation& o = observations[k];
    hidden[k] = static_cast<std::uint8_t>(o.clipping.gyro | o.clipping.void_gyro | o.read_in_part());
  }
  return rates_between_readings(samples, hidden, gyro);
}

// What remains open of the device's errors, in a rate, and no more than any rate: rate_smoother.md (R41).
Eigen::Matrix3d considered(const arrow::ErrorMatrix& moved, const SensorErrors::Matrix& covariance,
                           double rate_max_rad_s) {
  const Eigen::Matrix<double, 3, SensorErrors::kSize> rates = moved.topRows<3>(), spread = rates * covariance;
  const Eigen::Matrix3d out = spread.lazyProduct(rates.transpose());
  const double most = rate_max_rad_s * rate_max_rad_s;
  return std::min(1.0, most / std::max(out.trace(), 1e-300)) * out;
}

// How fast the rate may change between a sample and the next, beyond the angular acceleration: by free readings that is
// told, else force of contact bounds it.
double change_rad_s2(const RateModelParams& params, std::span<const RateObservation> observations,
                     std::span<const RateEstimate> estimates, std::size_t k) {
  const RateObservation &from = observations[k], &to = observations[k + 1];
  if (from.at_rest && to.at_rest) return 0.0;
  if (((from.clipping.gyro | from.may_hide()) | (to.clipping.gyro | to.may_hide())) != 0)
    return params.expert.contact.gain_rad_m *
           std::max(estimates[k].contact_m_s2.norm(), estimates[k + 1].contact_m_s2.norm());
  const double dt_s = seconds(to.sample.time_ns - from.sample.time_ns);
  return (estimates[k + 1].knot.rate_rad_s - estimates[k].knot.rate_rad_s).norm() / dt_s;
}

// What a time that both triads may share makes of a rate: the most that it changes by within reach of it, where a
// stroke of the next sample's window may belong to this one.
Eigen::Matrix3d of_shared_delay(double variance_s2, const RateModelParams& params,
                                std::span<const RateObservation> observations, std::span<const RateEstimate> estimates,
                                std::size_t k) {
  if (!(variance_s2 > 0.0)) return Eigen::Matrix3d::Zero();
  const auto reach_ns = static_cast<TimeNs>(1e9 * kSharedReach * std::sqrt(variance_s2));
  const TimeNs now = observations[k].sample.time_ns;
  double change = 0.0;
  for (std::size_t i = k; i > 0 && now - observations[i].sample.time_ns <= reach_ns; --i)
    change = std::max(change, change_rad_s2(params, observations, estimates, i - 1));
  for (std::size_t i = k; i + 1 < estimates.size() && observations[i].sample.time_ns - now < reach_ns; ++i)
    change = std::max(change, change_rad_s2(params, observations, estimates, i));
  const Vector3d& alpha = estimates[k].knot.acceleration_rad_s2;
  return variance_s2 * (alpha * alpha.transpose() + change * change * Eigen::Matrix3d::Identity());
}

// The rate some time after a sample, cubic between the knots about that instant, and its covariance, which between two
// knots is at most the mean of theirs.
RateState state_later(std::span<const RateObservation> observations, std::span<const RateEstimate> estimates,
                      std::span<const Eigen::Matrix3d> covariances, std::size_t k, double late_s) {
  RateState out;
  double left_s = late_s;
  for (; k + 1 < estimates.size(); ++k) {
    const double dt_s = seconds(observations[k + 1].sample.time_ns - observations[k].sample.time_ns);
    if (left_s < dt_s) {
      const RateKnot &a = estimates[k].knot, &b = estimates[k + 1].knot;
      const double u = std::max(0.0, left_s / dt_s), v = 1.0 - u;
      out.w_WI_I_rad_s = v * v * (1.0 + 2.0 * u) * a.rate_rad_s + u * u * (3.0 - 2.0 * u) * b.rate_rad_s +
                         u * v * dt_s * (v * a.acceleration_rad_s2 - u * b.acceleration_rad_s2);
      out.covariance_rad2_s2 = v * covariances[k] + u * covariances[k + 1];
      return out;
    }
    left_s -= dt_s;
  }
  out.w_WI_I_rad_s = estimates[k].knot.rate_rad_s;
  out.covariance_rad2_s2 = covariances[k];
  return out;
}

}  // namespace

RateSmoother::RateSmoother(const Params& params)
    : params_(params),
      rails_({params.rails, params.expert.planes, params.expert.accel_planes}),
      rests_(params.expert.rests) {
  require_fields(params);
  if (params.learnt_errors) {
    for (const double value : params.learnt_errors->errors.vector()) require_within("learnt errors", value, -0.2, 0.2);
    for (const double value : params.learnt_errors->covariance.reshaped()) {
      require_within("learnt errors' covariance", value, -1.0, 1.0);
    }
    // a negative eigenvalue would pass for perfect knowledge
    const SensorErrors::Vector pivots = params.learnt_errors->covariance.ldlt().vectorD();
    require_within("learnt errors' covariance, least pivot", pivots.minCoeff(), -1e-9 * pivots.maxCoeff(), 1.0);
  }
  (void)RateModel(params.model, 0.01);  // throws on bad parameters
}

Status RateSmoother::estimate(std::span<const ImuSample> samples,
                              std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                              std::vector<RateState>& out, RateReport& report) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  if (Status status = check_auxiliary_imus(params_.model, auxiliary_imus, samples.size()); !status.ok()) return status;

  RateReport health;
  health.samples = samples.size();
  const ClippingFinder::Found found = rails_.find(samples);
  const KnownRails& rails = found.rails;
  const std::vector<Clipping>& clippings = found.clippings;
  const RailPlanes planes = rails.planes_in_use(), accel_planes = rails.planes_in_use(Triad::accelerometer);
  health.planes = rails.planes;
  health.accel_planes = rails.planes_in_use(Triad::accelerometer);
  health.rails_upright = rails.upright;
  for (int c = 0; c < 6; ++c) {
    health.rail[static_cast<std::size_t>(c)] = rails_.walls().rail(rails.walls, c);
    const auto& plane = (c < 3 ? planes : accel_planes).element[static_cast<std::size_t>(c % 3)];
    if (plane) health.rail[static_cast<std::size_t>(c)] = plane->distance_rad_s;
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
  const ElementRows accel_rows = rails.rows(Triad::accelerometer, params_.model.element_sigma);
  const std::vector<Neighbours> beside = other_readings(samples, Triad::gyro);
  LeastRails least;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (clippings[k].void_gyro == 0) least.add(samples[k].angular_velocity_rad_s);
  }
  for (std::size_t k = 0; k < samples.size(); ++k) {
    observations[k] = {samples[k], clippings[k], rest[k]};
    observations[k].accel_rows = accel_rows;
    for (std::size_t i = 0; i < auxiliary_imus.size(); ++i) observations[k].auxiliary_imus[i] = auxiliary_imus[i][k];
    const auto [before, after] = beside[k];
    mark_partial(planes, rails_.walls(), rails.walls, model.gyro_sigma_rad_s(), before, observations[k], after);
    if (health.rails_upright) continue;
    doubt_unseen_rails(planes, least, model.gyro_sigma_rad_s(), before, observations[k], after);
  }
  if (!health.rails_upright) {
    doubt_level_tops(planes, least, params_.expert.planes.offset_share, model.gyro_sigma_rad_s(), observations);
  }
  const std::optional<HeldReadings> gyro_held = find_held(samples, Triad::gyro);
  mark_held(gyro_held, find_held(samples, Triad::accelerometer), observations, health);
  RateFit fit(observations, model);
  if (Status status = fit_rounds(params_, known, samples, clippings, observations, fit, health); !status.ok()) {
    return status;
  }
  const RateSolution& solution = fit.solution;

  const double gyro_late_s = std::max(0.0, -health.sensor_errors.errors.accel_delay_s);
  const double shared_s2 = health.shared_delay_sigma_s * health.shared_delay_sigma_s;
  std::vector<Eigen::Matrix3d> covariances(samples.size());
  solution.iteration.for_each_conditional([&](std::size_t k, const arrow::Conditional& conditional) {
    const Eigen::Matrix3d covariance =
        arrow::rate_covariance(conditional, solution.rig_covariance) +
        considered(fit.moved.of_sample[k], health.sensor_errors.covariance, params_.model.rate_max_rad_s) +
        of_shared_delay(shared_s2, known, observations, solution.estimates, k);
    covariances[k] = fit.model.reported(covariance, observations[k], solution.estimates[k]);
  });
  std::vector<RateState> states(samples.size());
  const std::vector<std::uint8_t> near =
      may_meet_rails(samples, health.rails_upright ? RailPlanes{} : planes);  // upright ones show to the bit
  const std::vector<std::optional<HeldRate>> own = read_in_time(samples, observations, gyro_held);
  std::size_t in_flight = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const RateEstimate& estimate = solution.estimates[k];
    RateState& state = states[k];
    state = state_later(observations, solution.estimates, covariances, k, gyro_late_s);
    // a motion that flight tells is smoother than readings; of any other they say more than white jerk between them
    const bool by_readings = estimate.flight_weight < 0.5 && !observations[k].at_rest && gyro_late_s == 0.0;
    if (by_readings && !own.empty() && own[k]) {
      const Vector3d felt = health.sensor_errors.errors.felt_s_m * samples[k].specific_force_m_s2;
      state.w_WI_I_rad_s = own[k]->rate_rad_s - felt - solution.rig.gyro_bias_rad_s;
      state.covariance_rad2_s2.diagonal() += own[k]->variance_rad2_s2;
    }
    state.time_ns = samples[k].time_ns;
    state.clipped_axes = clippings[k].gyro | clippings[k].void_gyro;
    state.source = rate_source(observations[k], estimate, state.covariance_rad2_s2, params_.recovered_sigma_rad_s);
    if (near[k] != 0 && state.source == RateSource::measured) state.source = RateSource::bounded_only;
    count(state, health);
    health.void_readings += clippings[k].void_gyro != 0;
    health.doubted_axes.push_back(static_cast<std::uint8_t>(observations[k].may_hide() & ~state.clipped_axes));
    in_flight += estimate.flight_weight >= 0.5;
  }
  health.flight_share = static_cast<double>(in_flight) / static_cast<double>(samples.size());
  out = std::move(states);
  report = health;
  return {};
}

}  // namespace tumble
