// SPDX-License-Identifier: BSD-3-Clause
#include "oracles/gaussian.hpp"
#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

// compares the reported covariance with true errors, over tumbles with different spin, path and accelerometer bias
namespace tumble {
namespace {

using Odometry = LidarInertialOdometry;

using test::kSamplesPerSweep;

constexpr int kRuns = 16, kSweepsOfRun = 16, kColumns = 300;
constexpr double kRs16Noise_m = 0.02;  // noise of the RS-16

/// BelievedImu adds IMU errors as the mapper assumes them: constant over a sweep and independent between sweeps, as
/// large as the parameters state (mapping.md, R39 to R41). At rest, which the mapper detects, there are no errors.
class BelievedImu {
 public:
  BelievedImu(const Odometry::Params& params, std::uint64_t seed) : params_(params), noise_(seed) {}

  /// Returns the constant bias of the run, which tilts the start by as much as the prior assumes.
  Eigen::Vector3d accel_bias_m_s2() {
    return params_.expert.gravity_m_s2 * params_.expert.world_covariance.tilt_sigma_rad * noise_.vector();
  }

  /// Adds the errors of a sweep to its samples.
  void err(std::span<ImuSample> sweep) {
    const double span_s = 1e-9 * static_cast<double>(test::kSweep_ns);
    double pushed_m_s = 0.0, rotated_rad = 0.0;
    for (const ImuSample& sample : sweep) {
      pushed_m_s += span_s / static_cast<double>(sweep.size()) * sample.specific_force_m_s2.norm();
      rotated_rad += span_s / static_cast<double>(sweep.size()) * sample.angular_velocity_rad_s.norm();
    }
    const Eigen::Vector3d velocity_m_s =
        std::hypot(params_.expert.prior.kSigma_m_s, params_.expert.prior.kForceShare * pushed_m_s) * noise_.vector();
    const Eigen::Vector3d rotation_rad =
        std::hypot(params_.expert.prior.sigma_rad, params_.expert.prior.kRotationNoiseRatio * rotated_rad) *
        noise_.vector();
    for (ImuSample& sample : sweep) {
      sample.specific_force_m_s2 += velocity_m_s / span_s;
      sample.angular_velocity_rad_s += rotation_rad / span_s;
    }
  }

 private:
  const Odometry::Params& params_;
  oracles::Gaussian noise_;
};

/// Returns the normalised squared error of the last pose, per degree of freedom. Position and yaw of the first pose fix
/// the world and are exact; its tilt error comes from the accelerometer's bias. The ranges have the noise of the RS-16.
double nees_of_run(int run) {
  const auto draw = [&](int k) { return test::uniform(static_cast<std::uint64_t>(1000 + 16 * run + k)); };
  test::Motion motion;
  motion.spin_rad_s = 4.0 + 6.0 * draw(0);
  motion.second_spin_rad_s = 1.0 + 3.0 * draw(1);
  motion.swing = 0.4 + 0.6 * draw(2);
  Odometry::Params params;
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  Odometry odometry(params);
  std::vector<ImuSample> imu = test::make_imu(motion, 0.1 * kSweepsOfRun);
  BelievedImu believed(params, static_cast<std::uint64_t>(run));
  const Eigen::Vector3d bias = believed.accel_bias_m_s2();
  Odometry::SweepResult report;
  for (int k = 0; k < kSweepsOfRun; ++k) {
    const std::span<ImuSample> sweep =
        std::span(imu).subspan(static_cast<std::size_t>(k * kSamplesPerSweep), kSamplesPerSweep);
    if (k * 0.1 >= motion.rest_s - 1e-9) believed.err(sweep);
    for (ImuSample& sample : sweep) {
      sample.specific_force_m_s2 += bias;
      EXPECT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    const auto points =
        test::make_sweep(test::Room::box_with_pillars(), motion, params.T_IL, k, kRs16Noise_m, kColumns);
    EXPECT_TRUE(odometry.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, report).ok());
    EXPECT_NE(report.verdict, SweepVerdict::rejected) << "run " << run << " sweep " << k;
  }
  const double end_s = 0.1 * kSweepsOfRun;
  Eigen::Matrix<double, 6, 1> error;
  error << motion.p_m(end_s) - report.pose.position_W_m,
      so3::logarithm(motion.q(end_s) * report.pose.orientation_W.conjugate());
  return error.dot(report.pose.covariance.llt().solve(error)) / 6.0;
}

/// Returns whether a mean of normalised errors is within the 95 % range of a correct covariance: chi-square over 16
/// runs of six degrees of freedom each, 70.8 to 125.0 of 96 (Wilson-Hilferty agrees to 0.1).
bool is_consistent(double mean_nees) {
  static_assert(6 * kRuns == 96);
  return mean_nees > 70.8 / 96.0 && mean_nees < 125.0 / 96.0;
}

TEST(Covariance, HoldsOverTumbles) {
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) sum += nees_of_run(run);
  const double mean = sum / kRuns;
  EXPECT_TRUE(is_consistent(mean)) << mean;  // measured: 0.77
  // negative controls: the same errors with twice and half the covariance
  EXPECT_FALSE(is_consistent(mean / 2.0)) << mean;
  EXPECT_FALSE(is_consistent(mean / 0.5)) << mean;
}

/// Returns the error along a corridor, which its walls do not constrain, in reported standard deviations, a quarter of
/// a second after an impact of which one reading lost 1 m/s. `flags` are the flags of this reading, `noise_m` is the
/// noise of the ranges.
double deviations_after_a_knock(std::uint8_t flags, double noise_m) {
  constexpr int kKnocked = 25, kEnd = 5;  // number of the sample; number of sweeps
  test::Motion still;
  still.rest_s = 1e9;
  Odometry odometry{Odometry::Params()};
  std::vector<ImuSample> imu = test::make_imu(still, 0.1 * kEnd);
  imu[kKnocked].specific_force_m_s2.x() -= 100.0;
  imu[kKnocked].device_clip_flags = flags;
  Odometry::SweepResult report;
  for (int k = 0; k < kEnd; ++k) {
    for (int j = k * kSamplesPerSweep; j < (k + 1) * kSamplesPerSweep; ++j) {
      const ImuSample& sample = imu[static_cast<std::size_t>(j)];
      EXPECT_TRUE(odometry.add_imu(sample, test::believe(sample)).ok());
    }
    const auto points =
        test::make_sweep(test::Room::corridor(), still, Eigen::Isometry3d::Identity(), k, noise_m, kColumns);
    EXPECT_TRUE(odometry.add_sweep(k * test::kSweep_ns, (k + 1) * test::kSweep_ns, points, report).ok());
  }
  EXPECT_GT(std::abs(report.pose.position_W_m.x()), 0.1);  // no measurement stops the sensor
  return report.pose.position_W_m.x() / std::sqrt(report.pose.covariance(0, 0));
}

TEST(Covariance, CountsWhatTheSaturatedAccelerometerHides) {
  EXPECT_LT(std::abs(deviations_after_a_knock(kClipAccelX, 0.0)), 3.0);
  EXPECT_GT(std::abs(deviations_after_a_knock(0, 0.0)), 3.0);  // a knock that nobody owns up to
  // wrong normals look like surfaces across the corridor
  EXPECT_LT(std::abs(deviations_after_a_knock(kClipAccelX, kRs16Noise_m)), 3.0);
}

}  // namespace
}  // namespace tumble
