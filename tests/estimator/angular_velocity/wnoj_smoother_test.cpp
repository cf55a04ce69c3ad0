// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saave.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using Measurement = WnojSmoother::Measurement;
using Smoothed = WnojSmoother::Smoothed;

constexpr TimeNs kAnchored_ns = 10'000'000;  // 100 Hz; the reference values apply to this rate
constexpr double kMeasured = 2.741e-5, kEstimated = 0.2741, kAsPrinted = 3.648, kRejected = 1e6;

std::vector<Measurement> constant_run(std::size_t count, double variance, TimeNs period_ns = kAnchored_ns) {
  std::vector<Measurement> run(count);
  for (std::size_t k = 0; k < count; ++k) {
    run[k] = {static_cast<TimeNs>(k) * period_ns, Vector3d::Zero(), Vector3d::Constant(variance)};
  }
  return run;
}

std::vector<Smoothed> smooth(const std::vector<Measurement>& run, double psd = 1e6) {
  std::vector<Smoothed> out;
  const Status status = WnojSmoother({psd}).smooth(run, out);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(out.size(), run.size());
  return out;
}

// Dense is an independent reference: the full problem with the angle, as published (3 states per knot, angle fixed at
// the first knot), with dense normal equations in long double.
struct Dense {
  Eigen::Matrix<long double, Eigen::Dynamic, 1> rate, acceleration, variance;
};

Dense dense_reference(const std::vector<Measurement>& run, double psd, int axis) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index n = static_cast<Eigen::Index>(run.size());
  Matrix H = Matrix::Zero(3 * n, 3 * n);
  Eigen::Matrix<Real, Eigen::Dynamic, 1> g = Eigen::Matrix<Real, Eigen::Dynamic, 1>::Zero(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Real info = 1 / static_cast<Real>(run[k].variance_rad2_s2[axis]);
    H(3 * k + 1, 3 * k + 1) += info;
    g[3 * k + 1] += info * static_cast<Real>(run[k].rate_rad_s[axis]);
    if (k + 1 == n) break;
    const Real t = static_cast<Real>(run[k + 1].time_ns - run[k].time_ns) * 1e-9L;
    const Real t2 = t * t, t3 = t2 * t, t4 = t3 * t, t5 = t4 * t;
    Eigen::Matrix<Real, 3, 3> Qi, Phi;
    Qi << 720 / t5, -360 / t4, 60 / t3, -360 / t4, 192 / t3, -36 / t2, 60 / t3, -36 / t2, 9 / t;
    Qi /= static_cast<Real>(psd);
    Phi << 1, t, t2 / 2, 0, 1, t, 0, 0, 1;
    H.block(3 * k, 3 * k, 3, 3) += Phi.transpose() * Qi * Phi;
    H.block(3 * k, 3 * k + 3, 3, 3) -= Phi.transpose() * Qi;
    H.block(3 * k + 3, 3 * k, 3, 3) -= Qi * Phi;
    H.block(3 * k + 3, 3 * k + 3, 3, 3) += Qi;
  }
  const Matrix free = H.bottomRightCorner(3 * n - 1, 3 * n - 1);
  // symmetric scaling, because angle, rate and acceleration differ by many orders of magnitude
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> scale = free.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * free * scale.asDiagonal();
  const Matrix covariance =
      scale.asDiagonal() * scaled.ldlt().solve(Matrix::Identity(3 * n - 1, 3 * n - 1)).eval() * scale.asDiagonal();
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> x = covariance * g.tail(3 * n - 1);
  Dense out;
  out.rate.resize(n);
  out.acceleration.resize(n);
  out.variance.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    out.rate[k] = x[3 * k];
    out.acceleration[k] = x[3 * k + 1];
    out.variance[k] = covariance(3 * k, 3 * k);
  }
  return out;
}

TEST(WnojSmoother, AgreesWithTheDenseProblemThatKeepsTheAngle) {
  oracles::Gaussian noise(1);
  for (TimeNs period : {TimeNs{2'500'000}, TimeNs{10'000'000}}) {
    std::vector<Measurement> run = constant_run(60, kMeasured, period);
    for (std::size_t k = 0; k < run.size(); ++k) {
      run[k].time_ns += static_cast<TimeNs>(noise.uniform(0.0, 0.8) * static_cast<double>(period));
      run[k].rate_rad_s = 10.0 * noise.vector();
      if (k >= 20 && k < 30) run[k].variance_rad2_s2.y() = kEstimated;
      if (k >= 40 && k < 50) run[k].variance_rad2_s2.y() = kRejected;
    }
    const std::vector<Smoothed> got = smooth(run);
    for (int axis = 0; axis < 3; ++axis) {
      const Dense want = dense_reference(run, 1e6, axis);
      for (std::size_t k = 0; k < run.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        // relative to the size of the readings; the reference itself is accurate to about 1e-10 in long double
        EXPECT_NEAR(got[k].rate_rad_s[axis], static_cast<double>(want.rate[i]), 1e-8) << k;
        EXPECT_NEAR(got[k].acceleration_rad_s2[axis], static_cast<double>(want.acceleration[i]), 1e-5) << k;
        EXPECT_NEAR(got[k].variance_rad2_s2[axis] / static_cast<double>(want.variance[i]), 1.0, 1e-7) << k;
      }
    }
  }
}

// returns the weight of the reading `offset` samples away on the smoothed rate in the middle of a long run
double weight(double variance, int offset) {
  std::vector<Measurement> run = constant_run(201, variance);
  run[static_cast<std::size_t>(100 + offset)].rate_rad_s.setOnes();
  return smooth(run)[100].rate_rad_s.z();
}

TEST(WnojSmoother, WeightsAndDeviationAtTheVarianceOfTheCode) {
  const double want[] = {0.484, 0.255, 0.039, -0.020, -0.014};
  for (int offset = 0; offset < 5; ++offset) {
    EXPECT_NEAR(weight(kEstimated, offset), want[offset], 5e-4) << offset;  // the publication states three decimals
    EXPECT_NEAR(weight(kEstimated, -offset), want[offset], 5e-4) << offset;
  }
  EXPECT_NEAR(std::sqrt(smooth(constant_run(201, kEstimated))[100].variance_rad2_s2.x()), 0.364, 5e-4);
}

TEST(WnojSmoother, WeightsAndDeviationAtTheVarianceOfThePaper) {
  const double want[] = {0.256, 0.209, 0.126, 0.057, 0.014};
  for (int offset = 0; offset < 5; ++offset) EXPECT_NEAR(weight(kAsPrinted, offset), want[offset], 5e-4) << offset;
  EXPECT_NEAR(std::sqrt(smooth(constant_run(201, kAsPrinted))[100].variance_rad2_s2.x()), 0.966, 5e-4);
}

TEST(WnojSmoother, ReturnsUnclippedReadingsUnchanged) {
  EXPECT_NEAR(weight(kMeasured, 0), 0.9996, 1e-4);
  std::vector<Measurement> run = constant_run(100, kMeasured);
  oracles::Gaussian noise(2);
  for (std::size_t k = 0; k < run.size(); ++k) {
    run[k].rate_rad_s = 8.0 * Vector3d(std::sin(0.1 * k), std::cos(0.2 * k), 1.0) + 0.005 * noise.vector();
  }
  const std::vector<Smoothed> got = smooth(run);
  // (1 - 0.9996) of a noise of 0.005 rad/s and of the curvature; measured 1.1e-5
  for (std::size_t k = 0; k < run.size(); ++k) EXPECT_LE((got[k].rate_rad_s - run[k].rate_rad_s).norm(), 5e-5) << k;
}

TEST(WnojSmoother, DeviationInTheMiddleOfRejectedGaps) {
  const struct {
    std::size_t length;
    double deviation;
  } anchors[] = {{5, 1.2}, {20, 7.2}, {50, 26.5}, {100, 67.0}};
  for (const auto& anchor : anchors) {
    std::vector<Measurement> run = constant_run(anchor.length + 200, kMeasured);
    for (std::size_t k = 100; k < 100 + anchor.length; ++k) run[k].variance_rad2_s2.setConstant(kRejected);
    const std::vector<Smoothed> got = smooth(run);
    // published with two digits; for an even length the middle is between two samples
    EXPECT_NEAR(std::sqrt(got[100 + anchor.length / 2].variance_rad2_s2.x()) / anchor.deviation, 1.0, 0.03)
        << anchor.length;
  }
}

TEST(WnojSmoother, HugeGapsKeepAFiniteVarianceBelowThatOfTheReadings) {
  std::vector<Measurement> run = constant_run(20000, kRejected, 2'500'000);
  for (std::size_t k = 0; k < 100; ++k) run[k].variance_rad2_s2.setConstant(kMeasured);
  for (const Smoothed& s : smooth(run)) {
    ASSERT_TRUE(s.rate_rad_s.allFinite());
    ASSERT_GT(s.variance_rad2_s2.minCoeff(), 0.0);
    ASSERT_LE(s.variance_rad2_s2.maxCoeff(), kRejected);
  }
}

TEST(WnojSmoother, FollowsAStraightRampExactly) {
  std::vector<Measurement> run = constant_run(50, kEstimated, 2'500'000);
  for (auto& m : run) m.rate_rad_s = Vector3d(1.0, -2.0, 3.0) * seconds(m.time_ns) + Vector3d(5.0, 0.0, -1.0);
  const std::vector<Smoothed> got = smooth(run);
  for (std::size_t k = 0; k < run.size(); ++k) {
    EXPECT_LE((got[k].rate_rad_s - run[k].rate_rad_s).norm(), 1e-10) << k;  // a linear rate needs no jerk
    EXPECT_LE((got[k].acceleration_rad_s2 - Vector3d(1.0, -2.0, 3.0)).norm(), 1e-7) << k;
  }
}

TEST(WnojSmoother, ShortRuns) {
  std::vector<Measurement> run = constant_run(1, kEstimated);
  run[0].rate_rad_s = {1.0, 2.0, 3.0};
  EXPECT_EQ(smooth(run)[0].rate_rad_s, run[0].rate_rad_s);
  EXPECT_EQ(smooth(run)[0].variance_rad2_s2, run[0].variance_rad2_s2);
  run = constant_run(2, kEstimated);
  run[1].rate_rad_s.setOnes();
  // two readings determine rate and acceleration
  EXPECT_LE((smooth(run)[0].rate_rad_s - run[0].rate_rad_s).norm(), 1e-12);
  EXPECT_NEAR(smooth(run)[1].variance_rad2_s2.x(), kEstimated, 1e-12);
}

TEST(WnojSmoother, BadInputGivesAStatusAndWritesNothing) {
  const WnojSmoother smoother({1e6});
  std::vector<Smoothed> out(3, Smoothed{Vector3d::Ones(), Vector3d::Ones(), Vector3d::Ones()});
  const auto expect = [&](const std::vector<Measurement>& run, ErrorCode error_code, const std::string& field) {
    const Status status = smoother.smooth(run, out);
    EXPECT_EQ(status.error_code, error_code) << status.message();
    EXPECT_EQ(status.field, field);
    EXPECT_EQ(out.size(), 3u);
    EXPECT_EQ(out.at(2).rate_rad_s, Vector3d::Ones());
    return status;
  };
  expect({}, ErrorCode::empty, "measurements");
  std::vector<Measurement> run = constant_run(5, kMeasured);
  run[3].time_ns = run[2].time_ns;
  EXPECT_EQ(expect(run, ErrorCode::time_order, "time_ns").bound, 2e7);
  run[3].time_ns = run[1].time_ns;
  EXPECT_EQ(expect(run, ErrorCode::time_order, "time_ns").value, 1e7);
  run = constant_run(5, kMeasured);
  run[4].rate_rad_s.y() = std::nan("");
  EXPECT_TRUE(std::isnan(expect(run, ErrorCode::non_finite, "rate_rad_s").value));
  run = constant_run(5, kMeasured);
  run[0].variance_rad2_s2.x() = std::numeric_limits<double>::infinity();
  expect(run, ErrorCode::non_finite, "variance_rad2_s2");
  run[0].variance_rad2_s2.x() = 0.0;
  expect(run, ErrorCode::out_of_range, "variance_rad2_s2");
  run[0].variance_rad2_s2.x() = -1.0;
  EXPECT_EQ(expect(run, ErrorCode::out_of_range, "variance_rad2_s2").value, -1.0);
}

TEST(WnojSmoother, RefusesADensityOutsideOfItsBound) {
  EXPECT_THROW(WnojSmoother({0.0}), InvalidParams);
  EXPECT_THROW(WnojSmoother({-1.0}), InvalidParams);
  EXPECT_THROW(WnojSmoother({2e12}), InvalidParams);
  EXPECT_THROW(WnojSmoother({std::nan("")}), InvalidParams);
}

}  // namespace
}  // namespace tumble
