// SPDX-License-Identifier: BSD-3-Clause
// Compares odometer readings with Kalman's closed form, and with an update of everything at once with numerical
// derivatives.
#include "estimator/src/mapping/prediction.hpp"
#include "estimator/src/mapping/unknowns.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"

namespace tumble::mapping {
namespace {

namespace u = unknowns;
using Matrix = Registration::Matrix;

constexpr int kUnknowns = Registration::kUnknowns, kMotionSize = Registration::kMotionSize;
constexpr TimeNs kStart_ns = 3'000'000'000, kEnd_ns = 3'100'000'000;

/// Returns a tenth of a second of rotation and acceleration, half of it with a clipped axis.
std::vector<MotionSample> tumbling(double turn_rad_s = 4.0) {
  std::vector<MotionSample> samples;
  for (int k = 0; k < 12; ++k) {
    MotionSample& sample = samples.emplace_back();
    sample.from_ns = kStart_ns + (k - 1) * 10'000'000;
    sample.time_ns = sample.from_ns + 10'000'000;
    sample.w_WI_I_rad_s = turn_rad_s * Eigen::Vector3d(1.0, -0.5 + 0.1 * k, 0.3);
    sample.f_I_m_s2 = {4.0 - k, 9.0, 2.0 + 0.5 * k};
    if (k > 5) sample.clipped_axes = 1;
  }
  return samples;
}

Matrix spread(double scale, double phase) {
  Matrix root;
  for (int i = 0; i < root.size(); ++i) root(i) = std::sin(phase + 0.7 * i);
  Matrix out = scale * scale * (root * root.transpose() / kUnknowns + Matrix::Identity());
  return 0.5 * (out + out.transpose());
}

struct Case {
  std::vector<MotionSample> samples = tumbling();
  SweepBoundary boundary;
  MotionNoise within = MotionNoise::Zero();
  Prediction prediction;
  MotionWindow window{samples, kEnd_ns, 0};

  /// Creates a case that is uncertain by about `scale` in all unknowns.
  explicit Case(double scale) {
    MotionState& state = prediction.prior.mean.state;
    state.time_ns = kStart_ns;
    state.p_WI_m = {3.0, -1.0, 0.5};
    state.q_WI = so3::exp({0.3, -0.8, 1.1});
    state.v_WI_m_s = {1.5, 0.7, -2.0};
    prediction.prior.mean.calibration.gravity_W_m_s2 = {0.1, -0.2, -9.8};
    boundary.state_estimate.prior_weight_covariance = spread(scale, 0.3);
    boundary.state_estimate.state_error_covariance = spread(0.5 * scale, 1.9);
    within = spread(scale, 4.0).topLeftCorner<kMotionSize, kMotionSize>();
    prediction.boundary_jacobian += 0.2 * spread(1.0, 2.2);
    prediction.noise = spread(scale, 5.1);
    prediction.noise.topLeftCorner<kMotionSize, kMotionSize>() += within;
  }
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;
};

/// Read returns the reading if the start were wrong by `start` and the noise within the sweep were `noise`: nonlinear.
using Read = std::function<Eigen::VectorXd(const Registration::Vector& start, const Eigen::VectorXd& noise)>;

MotionState moved(const Case& c, TimeNs time_ns, const Registration::Vector& start, const Eigen::VectorXd& noise) {
  const double share = double(time_ns - kStart_ns) / double(kEnd_ns - kStart_ns);
  Registration::Vector off = start;
  off.head<kMotionSize>() += share * noise;
  Registration::Estimate at = c.prediction.prior.mean;
  at.add(off);
  SweepTrajectory trajectory;
  EXPECT_TRUE(
      trajectory.build(at.state, c.samples, kEnd_ns, at.calibration.gravity_W_m_s2, at.saturation_deficit_rad_s).ok());
  return trajectory.state(seconds(time_ns - kStart_ns));
}

Eigen::Vector3d read_velocity(const Case& c, TimeNs time_ns, const Registration::Vector& start,
                              const Eigen::VectorXd& noise) {
  const MotionState at = moved(c, time_ns, start, noise);
  return at.q_WI.conjugate() * at.v_WI_m_s;
}

Eigen::Isometry3d read_motion(const Case& c, TimeNs from_ns, TimeNs to_ns, const Registration::Vector& start,
                              const Eigen::VectorXd& noise) {
  const auto pose = [&](TimeNs time_ns) {
    const MotionState at = moved(c, time_ns, start, noise);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = at.q_WI.toRotationMatrix();
    T.translation() = at.p_WI_m;
    return T;
  };
  return pose(from_ns).inverse() * pose(to_ns);
}

/// Joint is the estimate after the reading, from the boundary, the noise at the start and within, all at once: 28 + 28
/// + 9 unknowns, x = G x_last + n_0 + n.
struct Joint {
  Eigen::MatrixXd covariance, errors, of_x;  ///< by the gains and by the errors, and x from the joint update
  Eigen::VectorXd mean;
};

Joint update_jointly(const Case& c, const Read& off, const Eigen::MatrixXd& R) {
  const int all = 2 * kUnknowns + kMotionSize;
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(all, all), errors;
  Matrix before = c.prediction.noise;
  before.topLeftCorner<kMotionSize, kMotionSize>() -= c.within;
  prior.block(kUnknowns, kUnknowns, kUnknowns, kUnknowns) = before;
  prior.bottomRightCorner(kMotionSize, kMotionSize) = c.within;
  errors = prior;
  prior.topLeftCorner(kUnknowns, kUnknowns) = c.boundary.state_estimate.prior_weight_covariance;
  errors.topLeftCorner(kUnknowns, kUnknowns) = c.boundary.state_estimate.state_error_covariance;
  const auto read = [&](const Eigen::VectorXd& joint) {
    const Registration::Vector start =
        c.prediction.boundary_jacobian * joint.head(kUnknowns) + joint.segment(kUnknowns, kUnknowns);
    return off(start, joint.tail(kMotionSize));
  };
  const Eigen::VectorXd at = Eigen::VectorXd::Zero(all);
  const Eigen::VectorXd residual = -read(at);
  Eigen::MatrixXd H(residual.size(), all);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < all; ++k) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(all, k);
    H.col(k) = (read(step) - read(-step)) / (2.0 * kStep);
  }
  Joint out;
  const Eigen::MatrixXd S = H * prior * H.transpose() + R;
  const Eigen::MatrixXd K = prior * H.transpose() * S.inverse();
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(all, all) - K * H;
  out.covariance = left * prior * left.transpose() + K * R * K.transpose();
  out.errors = left * errors * left.transpose() + K * R * K.transpose();
  out.mean = K * residual;
  out.of_x = Eigen::MatrixXd::Zero(kUnknowns, all);
  out.of_x.leftCols(kUnknowns) = c.prediction.boundary_jacobian;
  out.of_x.middleCols(kUnknowns, kUnknowns).setIdentity();
  out.of_x.topRightCorner(kMotionSize, kMotionSize).setIdentity();
  return out;
}

/// Compares the update with the joint one; `scale` makes the deviations so small that both are linear.
void expect_joint(Case& c, const OdometerReading& reading, const Read& off, const Eigen::MatrixXd& R, double scale) {
  const Joint joint = update_jointly(c, off, R);
  const Registration::Estimate before = c.prediction.prior.mean;
  const Matrix last = c.boundary.state_estimate.prior_weight_covariance;
  fuse_reading(reading, c.boundary, c.window, c.within, c.prediction);
  c.prediction.compose_with_boundary(c.boundary.state_estimate);
  const double far = scale * scale;
  const Eigen::MatrixXd expected = joint.of_x * joint.covariance * joint.of_x.transpose();
  EXPECT_LT((c.prediction.prior.covariance - expected).cwiseAbs().maxCoeff(), 1e-4 * far);
  const Eigen::MatrixXd errors = joint.of_x * joint.errors * joint.of_x.transpose();
  EXPECT_LT((c.prediction.motion_error_covariance - errors).cwiseAbs().maxCoeff(), 1e-4 * far);
  // with the state at the boundary, which the window smooths by
  const Eigen::MatrixXd with_last = joint.of_x * joint.covariance.leftCols(kUnknowns);
  EXPECT_LT((c.prediction.boundary_jacobian * last - with_last).cwiseAbs().maxCoeff(), 1e-4 * far);
  const Registration::Vector step = c.prediction.prior.mean.minus(before);
  EXPECT_LT((step - joint.of_x * joint.mean).cwiseAbs().maxCoeff(), 1e-3 * scale);
  EXPECT_GT(step.norm(), 0.1 * scale) << "else this asks nothing";
}

TEST(OdometerReading, OfAVelocityIsTheJointUpdateByDifferences) {
  constexpr double kScale = 1e-6;
  for (const TimeNs time_ns : {kStart_ns, kStart_ns + 37'000'000, kEnd_ns}) {
    SCOPED_TRACE(time_ns);
    Case c(kScale);
    const Eigen::Vector3d expected = read_velocity(c, time_ns, Registration::Vector::Zero(), Eigen::VectorXd::Zero(9));
    const VelocityReading reading{time_ns, expected + kScale * Eigen::Vector3d(1.0, -2.0, 0.5), 0.7 * kScale};
    const Read off = [&](const Registration::Vector& start, const Eigen::VectorXd& noise) {
      return Eigen::VectorXd(read_velocity(c, time_ns, start, noise) - reading.v_WI_I_m_s);
    };
    expect_joint(c, reading, off, Eigen::Matrix3d::Identity() * std::pow(reading.sigma_m_s, 2), kScale);
  }
}

TEST(OdometerReading, OfAMotionIsTheJointUpdateByDifferences) {
  constexpr double kScale = 1e-6;
  using Span = std::pair<TimeNs, TimeNs>;
  for (const Span& span : {Span(kStart_ns, kEnd_ns), Span(kStart_ns + 21'000'000, kStart_ns + 64'000'000)}) {
    const TimeNs from_ns = span.first, to_ns = span.second;
    SCOPED_TRACE(from_ns);
    Case c(kScale);
    RelativePoseReading reading;
    reading.from_ns = from_ns;
    reading.to_ns = to_ns;
    reading.imu_T_from_to = read_motion(c, from_ns, to_ns, Registration::Vector::Zero(), Eigen::VectorXd::Zero(9));
    reading.imu_T_from_to.linear() =
        so3::exp(kScale * Eigen::Vector3d(1.0, 0.5, -1.5)).toRotationMatrix() * reading.imu_T_from_to.linear();
    reading.imu_T_from_to.translation() += kScale * Eigen::Vector3d(-1.0, 0.3, 0.8);
    reading.covariance = spread(0.6 * kScale, 0.9).topLeftCorner<6, 6>();
    const Read off = [&](const Registration::Vector& start, const Eigen::VectorXd& noise) {
      const Eigen::Isometry3d expected = read_motion(c, from_ns, to_ns, start, noise);
      Eigen::VectorXd out(6);
      out.head<3>() = expected.translation() - reading.imu_T_from_to.translation();
      out.tail<3>() = so3::logarithm(
          Eigen::Quaterniond(Eigen::Matrix3d(expected.linear() * reading.imu_T_from_to.linear().transpose())));
      return out;
    };
    expect_joint(c, reading, off, reading.covariance, kScale);
  }
}

/// Along one axis of a body that does not turn, at the start: the mean of two values, weighted by their variances.
TEST(OdometerReading, OfAVelocityAtTheStartIsTheMeanByTheVariances) {
  Case c(1e-3);
  for (MotionSample& sample : c.samples) sample.w_WI_I_rad_s.setZero();
  c.prediction = Prediction();
  c.prediction.prior.mean.state.time_ns = kStart_ns;
  c.boundary.state_estimate = StateEstimate();
  u::variances(c.boundary.state_estimate.prior_weight_covariance, u::velocity).setConstant(0.09);
  u::variances(c.boundary.state_estimate.state_error_covariance, u::velocity).setConstant(0.04);
  c.within.setZero();
  fuse_reading(VelocityReading{kStart_ns, {1.0, 0.0, -2.0}, 0.1}, c.boundary, c.window, c.within, c.prediction);
  c.prediction.compose_with_boundary(c.boundary.state_estimate);
  const double gain = 0.09 / (0.09 + 0.01);
  EXPECT_LT((c.prediction.prior.mean.state.v_WI_m_s - gain * Eigen::Vector3d(1.0, 0.0, -2.0)).norm(), 1e-12);
  const Eigen::Vector3d weight(u::variances(c.prediction.prior.covariance, u::velocity));
  EXPECT_LT((weight - Eigen::Vector3d::Constant(0.09 * 0.01 / 0.1)).norm(), 1e-12);
  const Eigen::Vector3d error(u::variances(c.prediction.motion_error_covariance, u::velocity));
  EXPECT_LT((error - Eigen::Vector3d::Constant(0.01 * 0.04 + 0.81 * 0.01)).norm(), 1e-12);
  EXPECT_EQ(u::variances(c.prediction.prior.covariance, u::position).maxCoeff(), 0.0) << "as sure as it was";
}

/// A reading without information changes nothing, up to rounding; a reading from another time changes nothing at all.
TEST(OdometerReading, ThatKnowsNothingOrIsOfAnotherTimeChangesNothing) {
  Case c(0.1), same(0.1);
  fuse_reading(VelocityReading{kEnd_ns, {5.0, 5.0, 5.0}, 1e6}, c.boundary, c.window, c.within, c.prediction);
  EXPECT_LT(c.prediction.prior.mean.minus(same.prediction.prior.mean).norm(), 1e-9);
  EXPECT_LT((c.prediction.noise - same.prediction.noise).norm(), 1e-9);
  for (const TimeNs time_ns : {kStart_ns - 21'000'000, kEnd_ns + 21'000'000}) {
    Case other(0.1);
    fuse_reading(VelocityReading{time_ns, {5.0, 5.0, 5.0}, 0.1}, other.boundary, other.window, other.within,
                 other.prediction);
    EXPECT_EQ(other.prediction.prior.mean.state.v_WI_m_s, same.prediction.prior.mean.state.v_WI_m_s);
    EXPECT_EQ(other.prediction.noise, same.prediction.noise);
    EXPECT_EQ(other.prediction.boundary_jacobian, same.prediction.boundary_jacobian);
  }
  fuse_reading(VelocityReading{kEnd_ns + 19'000'000, {5.0, 5.0, 5.0}, 0.1}, c.boundary, c.window, c.within,
               c.prediction);
  EXPECT_GT(c.prediction.prior.mean.minus(same.prediction.prior.mean).norm(), 0.01) << "negative control";
}

/// A clipped axis hides half a radian of the sweep, which a camera measured. One Gauss-Newton step would be
/// insufficient.
TEST(OdometerReading, OfAMotionFindsWhatASaturationLimitHid) {
  Case c(1e-3);
  for (MotionSample& sample : c.samples) sample.clipped_axes = 1;
  u::variances(c.boundary.state_estimate.prior_weight_covariance, u::deficit).setConstant(25.0);
  c.prediction.boundary_jacobian.setIdentity();
  RelativePoseReading reading;
  reading.from_ns = kStart_ns;
  reading.to_ns = kEnd_ns;
  Registration::Vector hidden = Registration::Vector::Zero();
  for (int knot = 0; knot < SweepTrajectory::kKnots; ++knot) hidden[u::saturation_deficit_index(0, knot)] = 5.0;
  reading.imu_T_from_to = read_motion(c, kStart_ns, kEnd_ns, hidden, Eigen::VectorXd::Zero(9));
  reading.covariance.diagonal().setConstant(1e-6);
  fuse_reading(reading, c.boundary, c.window, c.within, c.prediction);
  const Registration::Vector none = Registration::Vector::Zero();
  const Eigen::Isometry3d found = read_motion(c, kStart_ns, kEnd_ns, none, Eigen::VectorXd::Zero(9));
  const Eigen::Isometry3d off = found.inverse() * reading.imu_T_from_to;
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01);
  EXPECT_GT(c.prediction.prior.mean.saturation_deficit_rad_s.row(0).mean(), 4.0);
}

TEST(OdometerReading, IsCheckedByItself) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(check_odometer_reading(VelocityReading{0, {1.0, 0.0, 0.0}, 0.1}).ok());
  EXPECT_EQ(check_odometer_reading(VelocityReading{0, {nan, 0.0, 0.0}, 0.1}).error_code, ErrorCode::non_finite);
  EXPECT_EQ(check_odometer_reading(VelocityReading{0, {1.0, 0.0, 0.0}, nan}).error_code, ErrorCode::non_finite);
  EXPECT_EQ(check_odometer_reading(VelocityReading{0, {1.0, 0.0, 0.0}, 0.0}).error_code, ErrorCode::out_of_range);
  RelativePoseReading good{0, 1, Eigen::Isometry3d::Identity(), Eigen::Matrix<double, 6, 6>::Identity()};
  EXPECT_TRUE(check_odometer_reading(good).ok());
  const auto refusal = [&](const auto& change) {
    RelativePoseReading reading = good;
    change(reading);
    return check_odometer_reading(reading);
  };
  EXPECT_EQ(refusal([](RelativePoseReading& r) { r.to_ns = 0; }).error_code, ErrorCode::time_order);
  EXPECT_EQ(refusal([&](RelativePoseReading& r) { r.imu_T_from_to.translation().y() = nan; }).error_code,
            ErrorCode::non_finite);
  EXPECT_EQ(refusal([&](RelativePoseReading& r) { r.covariance(0, 4) = nan; }).error_code, ErrorCode::non_finite);
  EXPECT_STREQ(refusal([](RelativePoseReading& r) { r.imu_T_from_to.linear() *= 1.001; }).field, "imu_T_from_to");
  EXPECT_STREQ(refusal([](RelativePoseReading& r) { r.imu_T_from_to.linear() *= -1.0; }).field, "imu_T_from_to");
  EXPECT_STREQ(refusal([](RelativePoseReading& r) { r.covariance(2, 2) = 0.0; }).field, "covariance");
  EXPECT_STREQ(refusal([](RelativePoseReading& r) { r.covariance(1, 0) = r.covariance(0, 1) = 1.5; }).field,
               "covariance");
}

}  // namespace
}  // namespace tumble::mapping
