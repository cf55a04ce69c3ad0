// SPDX-License-Identifier: BSD-3-Clause
// See mapping.md, heading "Prediction from sweep to sweep".

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>

#include "../common/dense.hpp"
#include "prediction.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

namespace u = unknowns;
using Matrix = Registration::Matrix;
constexpr int kUnknowns = Registration::kUnknowns, kMotionSize = Registration::kMotionSize, kMost = 6;

template <int Columns>
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Columns, 0, kMost, Columns>;
using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
using Covariance = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
template <int Values>
using MotionJacobian = Eigen::Matrix<double, Values, kMotionSize>;

constexpr int kIterations = 6;              // two or three iterations are usually enough
constexpr double kConvergenceLimit = 1e-9;  // convergence limit [m, rad, m/s, rad/s]

struct StateOffsets {
  Registration::Vector start = Registration::Vector::Zero();
  Eigen::Matrix<double, kMotionSize, 1> noise = Eigen::Matrix<double, kMotionSize, 1>::Zero();
};

struct PredictedReading {
  Rows<kUnknowns> jacobian_start;
  Rows<kMotionSize> noise_jacobian;
  Values residual;  ///< innovation: the reading minus its prediction
  Covariance innovation_variance;
};

struct MotionInstant {
  double sweep_noise_fraction = 0.0;  ///< fraction of the sweep's process noise up to this instant
  Eigen::Quaterniond q_WI;
  Eigen::Vector3d p_WI_m, v_WI_m_s;
  Eigen::Matrix<double, kMotionSize, kUnknowns> jacobian_start;
};

class SweepMotion {
 public:
  SweepMotion(const Registration::Estimate& predicted, const MotionWindow& window)
      : predicted_estimate_(predicted), window_(window) {}

  bool holds(TimeNs time_ns) const {
    const auto beyond_ns = static_cast<TimeNs>(1e9 * SweepTrajectory::kExtrapolation_s);
    return time_ns >= predicted_estimate_.state.time_ns - beyond_ns && time_ns <= window_.end_ns + beyond_ns;
  }

  /// The effect of the process noise on the state is assumed to grow linearly with the time since the start of the
  /// sweep: mapping.md (R34).
  MotionInstant at(TimeNs time_ns, const StateOffsets& offsets) const {
    MotionInstant out;
    const double t_s = seconds(time_ns - predicted_estimate_.state.time_ns);
    const double length_s = seconds(window_.end_ns - predicted_estimate_.state.time_ns);
    const double inside_s = std::clamp(t_s, 0.0, length_s);
    out.sweep_noise_fraction = length_s > 0.0 ? inside_s / length_s : 0.0;
    Registration::Vector moved = offsets.start;
    u::segment(moved, u::motion) += out.sweep_noise_fraction * offsets.noise;
    Registration::Estimate start = predicted_estimate_;
    start.add(moved);
    SweepTrajectory trajectory;
    // add_sweep() ensures that the IMU samples cover the sweep, so build() cannot fail.
    (void)trajectory.build(start.state, window_.samples, window_.end_ns, start.calibration.gravity_W_m_s2,
                           start.saturation_deficit_rad_s);
    std::size_t hint = 0;
    const SweepTrajectory::PreintegratedMotion instant =
        trajectory.at(t_s, Eigen::Vector3d::Zero(), hint, out.v_WI_m_s);
    out.q_WI = instant.q_WI;
    out.p_WI_m = trajectory.gravity_free_position_m(t_s) + instant.preintegrated_position_m;
    const SweepTrajectory::Transition step = trajectory.transition(inside_s);
    out.jacobian_start.setZero();
    u::columns(out.jacobian_start, u::motion) = step.jacobian_start;
    u::columns(out.jacobian_start, u::deficit) = step.jacobian_saturation_deficit_s;
    u::columns(out.jacobian_start, u::gravity) = step.jacobian_gravity;
    return out;
  }

 private:
  const Registration::Estimate& predicted_estimate_;
  const MotionWindow& window_;
};

/// `by_moment` is the derivative of the predicted odometer reading with respect to position, attitude and velocity at
/// the time `moment`.
template <int Size>
void add(const MotionJacobian<Size>& by_moment, const MotionInstant& moment, PredictedReading& out) {
  const Eigen::Matrix<double, Size, kUnknowns> jacobian_start = by_moment * moment.jacobian_start;
  out.jacobian_start += jacobian_start;
  out.noise_jacobian += moment.sweep_noise_fraction * jacobian_start.template leftCols<kMotionSize>();
}

template <int Size>
PredictedReading zero_innovation() {
  return {Rows<kUnknowns>::Zero(Size, kUnknowns), Rows<kMotionSize>::Zero(Size, kMotionSize), Values::Zero(Size),
          Covariance::Zero(Size, Size)};
}

/// See mapping.md (R35).
PredictedReading predict_reading(const VelocityReading& reading, const SweepMotion& sweep,
                                 const StateOffsets& offsets) {
  PredictedReading out = zero_innovation<3>();
  const MotionInstant now = sweep.at(reading.time_ns, offsets);
  const Eigen::Matrix3d to_I = now.q_WI.toRotationMatrix().transpose();
  MotionJacobian<3> by_moment = MotionJacobian<3>::Zero();
  u::columns(by_moment, u::attitude) = to_I * so3::hat(now.v_WI_m_s);
  u::columns(by_moment, u::velocity) = to_I;
  add(by_moment, now, out);
  out.residual = reading.v_WI_I_m_s - to_I * now.v_WI_m_s;
  out.innovation_variance.diagonal().setConstant(reading.sigma_m_s * reading.sigma_m_s);
  return out;
}

/// See mapping.md (R36).
PredictedReading predict_reading(const RelativePoseReading& reading, const SweepMotion& sweep,
                                 const StateOffsets& offsets) {
  PredictedReading out = zero_innovation<kMost>();
  const MotionInstant from = sweep.at(reading.from_ns, offsets), to = sweep.at(reading.to_ns, offsets);
  const Eigen::Matrix3d to_I = from.q_WI.toRotationMatrix().transpose();
  const Eigen::Vector3d moved_W_m = to.p_WI_m - from.p_WI_m;
  const Eigen::Quaterniond turned = from.q_WI.conjugate() * to.q_WI;
  const Eigen::Quaterniond read(Eigen::Matrix3d(reading.imu_T_from_to.linear()));
  const Eigen::Vector3d mean_force_tilt_rad = so3::logarithm((read * turned.conjugate()).normalized());
  const Eigen::Matrix3d by_turn = so3::left_jacobian_inverse(mean_force_tilt_rad).transpose() * to_I;
  out.residual.head<3>() = reading.imu_T_from_to.translation() - to_I * moved_W_m;
  out.residual.tail<3>() = mean_force_tilt_rad;
  MotionJacobian<kMost> by_from = MotionJacobian<kMost>::Zero(), by_to = by_from;
  by_to.topLeftCorner<3, 3>() = to_I;
  by_to.block<3, 3>(3, 3) = by_turn;
  by_from.topLeftCorner<3, 3>() = -to_I;
  by_from.block<3, 3>(0, 3) = to_I * so3::hat(moved_W_m);
  by_from.block<3, 3>(3, 3) = -by_turn;
  add(by_from, from, out);
  add(by_to, to, out);
  out.innovation_variance = reading.covariance;
  return out;
}

bool holds(const SweepMotion& sweep, const OdometerReading& reading) {
  return sweep.holds(reading_start_ns(reading)) && sweep.holds(reading_end_ns(reading));
}

template <int Size>
using Gain = Eigen::Matrix<double, Size, Eigen::Dynamic, 0, Size, kMost>;

/// UpdateWorkspace keeps large matrices on the heap, because propagate_covariance() needs 32 KiB of stack.
struct UpdateWorkspace {
  Matrix start_covariance, noise_covariance,
      remaining_error_factor;  ///< covariance at the start, its process noise part, and factor of the remaining errors
  StateOffsets state_offsets;
  PredictedReading predicted_reading;
  Gain<kUnknowns> jacobian_start;  ///< Kalman gain of the unknowns at the boundary
  Gain<kMotionSize> noise_gain;    ///< Kalman gain of the process noise since the boundary
};

/// See mapping.md (R37).
bool compute_gains(const MotionNoise& within, UpdateWorkspace& work) {
  const PredictedReading& expected = work.predicted_reading;
  work.jacobian_start = work.start_covariance * expected.jacobian_start.transpose();
  work.noise_gain = within * expected.noise_jacobian.transpose();
  Covariance S = expected.jacobian_start * work.jacobian_start + expected.noise_jacobian * work.noise_gain +
                 expected.innovation_variance;
  make_symmetric(S);
  const Eigen::LLT<Covariance> factors(S);
  if (factors.info() != Eigen::Success) return false;
  work.jacobian_start = factors.solve(work.jacobian_start.transpose()).transpose();
  work.noise_gain = factors.solve(work.noise_gain.transpose()).transpose();
  return true;
}

[[gnu::noinline]] bool iterate_to_convergence(const OdometerReading& reading, const SweepMotion& sweep,
                                              const MotionNoise& within, UpdateWorkspace& work) {
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    work.predicted_reading =
        std::visit([&](const auto& kind) { return predict_reading(kind, sweep, work.state_offsets); }, reading);
    if (!compute_gains(within, work)) return false;
    const Values innovation = work.predicted_reading.residual +
                              work.predicted_reading.jacobian_start * work.state_offsets.start +
                              work.predicted_reading.noise_jacobian * work.state_offsets.noise;
    const StateOffsets next{work.jacobian_start * innovation, work.noise_gain * innovation};
    if (!next.start.allFinite() || !next.noise.allFinite()) return false;
    const double change = std::max((next.start - work.state_offsets.start).cwiseAbs().maxCoeff(),
                                   (next.noise - work.state_offsets.noise).cwiseAbs().maxCoeff());
    work.state_offsets = next;
    if (change < kConvergenceLimit) return true;
  }
  return true;
}

/// See mapping.md (R38).
[[gnu::noinline]] void move(UpdateWorkspace& work, Prediction& prediction) {
  Registration::Vector moved = work.state_offsets.start;
  u::segment(moved, u::motion) += work.state_offsets.noise;
  prediction.prior.mean.add(moved);
  work.jacobian_start.topRows<kMotionSize>() += work.noise_gain;  // sum of the two Kalman gains
  const Rows<kUnknowns> jacobian_boundary = work.predicted_reading.jacobian_start * prediction.boundary_jacobian;
  prediction.boundary_jacobian.noalias() -= work.jacobian_start * jacobian_boundary;
  work.remaining_error_factor.setIdentity();
  work.remaining_error_factor.noalias() -= work.jacobian_start * work.predicted_reading.jacobian_start;
}

/// See mapping.md (R38).
[[gnu::noinline]] void add_noise(const MotionNoise& within, UpdateWorkspace& work, Prediction& prediction) {
  const Gain<kUnknowns>& K = work.jacobian_start;
  Eigen::Matrix<double, kUnknowns, kMotionSize> left = -K * work.predicted_reading.noise_jacobian;
  left.topRows<kMotionSize>().diagonal().array() += 1.0;
  const Eigen::Matrix<double, kUnknowns, kMotionSize> spread = left * within;
  prediction.noise.noalias() += spread * left.transpose();
  const Gain<kUnknowns> read = K * work.predicted_reading.innovation_variance;
  prediction.noise.noalias() += read * K.transpose();
  make_symmetric(prediction.noise);
}

}  // namespace

void fuse_reading(const OdometerReading& reading, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction) {
  const SweepMotion sweep(prediction.prior.mean, window);
  if (!holds(sweep, reading)) return;
  const auto work = std::make_unique<UpdateWorkspace>();
  // The Kalman gains are computed from prior_weight_covariance, which also weights the prediction in the registration:
  // mapping.md (R37).
  propagate_covariance(prediction.boundary_jacobian, boundary.state_estimate.prior_weight_covariance,
                       work->start_covariance);
  Matrix& before = work->noise_covariance;  // noise at the start, due to gyro and accelerometer saturation
  before = prediction.noise;
  u::sub_block(before, u::motion) -= within;
  work->start_covariance += before;
  if (!iterate_to_convergence(reading, sweep, within, *work)) return;
  move(*work, prediction);
  propagate_covariance(work->remaining_error_factor, before, prediction.noise);
  add_noise(within, *work, prediction);
}

}  // namespace tumble::mapping
