// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/angular_velocity/tumble_recording.hpp"

#include "oracles/gaussian.hpp"
#include "oracles/torque_free_rotation.hpp"
#include "tests/testing.hpp"

namespace tumble {

namespace {

constexpr double kStep_s = 5e-4;
constexpr double kImpactTime = 0.02;
// rad/m: mass times distance of the contact, divided by a third of the trace of the inertia
constexpr double kLeverMax = 8.0;

struct Moment {
  Vector3d rate, force_at_centre;  // IMU axes; contact force at the centre of mass
  Phase phase;
};

Vector3d direction(oracles::Gaussian& noise) {
  return noise.vector().normalized();
}

// TumbleMotion is the whole motion at 2 kHz.
class TumbleMotion {
 public:
  explicit TumbleMotion(const TumbleOptions& options) : options_(options), noise_(options.seed) {
    oracles::Gaussian mounting(options.mounting_seed);
    const Vector3d axis = direction(mounting);
    R_IB_ = Eigen::AngleAxisd(3.0 * mounting.uniform(), axis).toRotationMatrix();
    still(0.6);
    Vector3d rate = within(options.speed_low_rad_s, options.speed_high_rad_s);
    blend(Vector3d::Zero(), rate, 0.2, Phase::push, 8.0 * direction(noise_));
    for (int i = 0; i < options.flights; ++i) {
      rate = fly(rate, noise_.uniform(0.2, 0.5));
      if (i + 1 == options.flights) break;
      Vector3d force;
      const Vector3d next = after_impact(rate, force);
      blend(rate, next, kImpactTime, Phase::impact, force);
      rate = next;
    }
    if (options.roll) blend(rate, Vector3d::Zero(), 1.0, Phase::roll, Vector3d::Zero());
    if (options.roll) still(0.5);
  }

  const std::vector<Moment>& moments() const { return moments_; }
  Eigen::Matrix3d inertia() const { return R_IB_ * options_.moments.asDiagonal() * R_IB_.transpose(); }

 private:
  static constexpr double kGravity = 9.81;

  // Returns a vector of random direction and of a length between two bounds. The direction is drawn first, in a
  // separate statement, because compilers evaluate the factors of a product in different orders.
  Vector3d within(double low, double high, double unit = 1.0) {
    const Vector3d towards = direction(noise_);
    return noise_.uniform(low, high) * unit * towards;
  }
  void add(const Vector3d& rate, const Vector3d& force, Phase phase) {
    moments_.push_back({rate, force, phase});
    const Vector3d turn = kStep_s * rate;
    if (turn.norm() > 0.0) q_WI_ = q_WI_ * Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  }
  Vector3d support() const { return q_WI_.conjugate() * Vector3d(0.0, 0.0, kGravity); }

  // Simulates a force through one point of the body, a half sine in time; the rate after it is within the range of the
  // options.
  Vector3d after_impact(const Vector3d& rate, Vector3d& peak_force) {
    Vector3d next;
    do {
      peak_force = within(0.33, 1.0, options_.impact_m_s2);
      const Vector3d lever = within(0.0, kLeverMax);
      // the trace of the inertia over three is the unit of the lever arm
      const Eigen::Matrix3d J = inertia() * 3.0 / options_.moments.sum();
      next = rate + J.inverse() * lever.cross(peak_force) * kImpactTime * 2.0 / std::numbers::pi;
    } while (next.norm() < options_.speed_low_rad_s || next.norm() > options_.speed_high_rad_s);
    return next;
  }

  void still(double duration) {
    for (int k = 0; k < static_cast<int>(duration / kStep_s); ++k) add(Vector3d::Zero(), support(), Phase::rest);
  }
  Vector3d fly(const Vector3d& rate, double duration) {
    const oracles::TorqueFreeRotation body(options_.moments, R_IB_.transpose() * rate);
    const int count = static_cast<int>(duration / kStep_s);
    for (int k = 1; k <= count; ++k) add(R_IB_ * body.rate(k * kStep_s), Vector3d::Zero(), Phase::flight);
    return R_IB_ * body.rate(count * kStep_s);
  }
  void blend(const Vector3d& from, const Vector3d& to, double duration, Phase phase, const Vector3d& peak) {
    const int count = static_cast<int>(duration / kStep_s);
    for (int k = 1; k <= count; ++k) {
      const double s = static_cast<double>(k) / count;
      const Vector3d hold = phase == Phase::impact ? Vector3d::Zero() : support();
      // the rate follows from the integral of a half sine of torque, the force from the half sine
      const double share = 0.5 * (1.0 - std::cos(std::numbers::pi * s));
      add(from + share * (to - from), hold + std::sin(std::numbers::pi * s) * peak, phase);
    }
  }

  TumbleOptions options_;
  oracles::Gaussian noise_;
  Eigen::Matrix3d R_IB_;
  Quaterniond q_WI_ = Quaterniond::Identity();
  std::vector<Moment> moments_;
};

}  // namespace

TumbleRecording make_tumble(const TumbleOptions& options) {
  const TumbleMotion motion(options);
  const std::vector<Moment>& moments = motion.moments();
  oracles::Gaussian noise(options.seed + 1000003);
  const std::size_t window = static_cast<std::size_t>(2000 / options.rate_hz);
  TumbleRecording out;
  out.inertia = motion.inertia();
  const Eigen::Matrix3d to_axes = options.gyro_rows.inverse();
  for (std::size_t k = 0; (k + 1) * window < moments.size(); ++k) {
    Vector3d rate = Vector3d::Zero(), force = Vector3d::Zero();
    Phase phase = moments[k * window].phase;
    for (std::size_t i = k * window; i < (k + 1) * window; ++i) {
      const Vector3d& w = moments[i].rate;
      const Vector3d alpha =
          (moments[i + 1].rate - moments[i == 0 ? 0 : i - 1].rate) / (i == 0 ? kStep_s : 2 * kStep_s);
      rate += w;
      force += moments[i].force_at_centre + alpha.cross(options.lever_arm_m) + w.cross(w.cross(options.lever_arm_m));
      if (moments[i].phase == Phase::impact) phase = Phase::impact;
    }
    rate /= static_cast<double>(window);
    force /= static_cast<double>(window);
    const Vector3d gyro_noise = noise.vector(), accel_noise = noise.vector();
    ImuSample sample;
    sample.time_ns = static_cast<TimeNs>(k + 1) * (1'000'000'000 / options.rate_hz);
    const Vector3d free_reading =
        rate + options.gyro_error * rate + options.gyro_bias_rad_s + options.gyro_sigma_rad_s * gyro_noise;
    const Vector3d sensed = options.gyro_rows * free_reading + options.gyro_offset_rad_s;
    const Vector3d delivered = sensed.cwiseMin(options.gyro_rail_rad_s).cwiseMax(-options.gyro_rail_rad_s);
    sample.angular_velocity_rad_s = to_axes * (delivered - options.gyro_offset_rad_s);
    out.hidden.push_back(sensed - delivered);
    sample.specific_force_m_s2 =
        (force + options.accel_error * force + options.accel_bias_m_s2 + options.accel_sigma_m_s2 * accel_noise)
            .cwiseMin(options.accel_rail_m_s2)
            .cwiseMax(-options.accel_rail_m_s2);
    out.samples.push_back(sample);
    out.truth.push_back(rate);
    out.phase.push_back(phase);
  }
  return out;
}

ClippedErrors clipped_errors(const TumbleRecording& recording, const std::vector<Vector3d>& rates, double rail) {
  std::vector<double> errors;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (recording.samples[k].angular_velocity_rad_s.cwiseAbs().maxCoeff() < rail) continue;
    errors.push_back((rates[k] - recording.truth[k]).norm());
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto quantile = [&](double share) {
    return errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  return {errors.size(), quantile(0.5), quantile(0.99), errors.back()};
}

std::vector<Vector3d> rates_of(const std::vector<AngularRateState>& states) {
  std::vector<Vector3d> rates;
  for (const AngularRateState& state : states) rates.push_back(state.w_WI_I_rad_s);
  return rates;
}

std::vector<Vector3d> readings_of(const std::vector<ImuSample>& samples) {
  std::vector<Vector3d> rates;
  for (const ImuSample& sample : samples) rates.push_back(sample.angular_velocity_rad_s);
  return rates;
}

}  // namespace tumble
