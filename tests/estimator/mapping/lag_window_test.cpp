// SPDX-License-Identifier: BSD-3-Clause
// Compares the window's backward pass with the dense least squares of all its sweeps.
#include "estimator/src/mapping/lag_window.hpp"

#include "tests/testing.hpp"

namespace tumble::mapping {
namespace {

using Matrix = Registration::Matrix;
using Vector = Registration::Vector;
using Dense = Eigen::MatrixXd;

constexpr int kSweeps = 4, kMeasured = 6;
/// All unknowns except the two rotations: an estimate is linear in them, so first order is exact.
constexpr std::array kLinear = {0, 1, 2, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 21, 22, 23, 24, 25, 26, 27};
constexpr int kFree = kLinear.size();

class Numbers {
 public:
  Dense matrix(int rows, int columns) {
    Dense out(rows, columns);
    for (double& value : out.reshaped()) value = normal_(engine_);
    return out;
  }

 private:
  std::mt19937 engine_{1};
  std::normal_distribution<double> normal_;
};

Matrix in_unknowns(const Dense& free) {
  Matrix out = Matrix::Zero();
  out(kLinear, kLinear) = free;
  return out;
}

EstimatedSweep estimated(const Dense& mean, const Dense& errors) {
  Vector error = Vector::Zero();
  error(kLinear) = mean;
  EstimatedSweep out{{}, in_unknowns(errors)};
  out.mean.add(error);
  return out;
}

Dense mean_of(const EstimatedSweep& estimate) {
  return estimate.mean.minus({})(kLinear);
}

Dense inverse(const Dense& matrix) {
  return matrix.ldlt().solve(Dense::Identity(matrix.rows(), matrix.cols()));
}

/// System is a linear system of sweeps, each measured in some directions: through a Kalman filter into a window, and
/// all at once.
struct System {
  LagWindow window{kSweeps};
  Dense information = Dense::Zero(kSweeps * kFree, kSweeps* kFree);
  Dense pull = Dense::Zero(kSweeps * kFree, 1);

  /// `transition_error` changes the transitions that the window receives, not the system.
  explicit System(double transition_error = 0.0) {
    Numbers numbers;
    Dense x = Dense::Zero(kFree, 1), P = Dense::Identity(kFree, kFree);
    for (int k = 0; k < kSweeps; ++k) {
      const Dense jacobian_previous = Dense::Identity(kFree, kFree) + 0.2 * numbers.matrix(kFree, kFree);
      const Dense noise = 0.3 * Dense::Identity(kFree, kFree);
      const int at = k * kFree;
      Dense rows = Dense::Zero(kFree, kSweeps * kFree);
      rows.middleCols(at, kFree).setIdentity();
      if (k > 0) {
        x = jacobian_previous * x;
        P = jacobian_previous * P * jacobian_previous.transpose() + noise;
        rows.middleCols(at - kFree, kFree) = -jacobian_previous;
      }
      information += rows.transpose() * inverse(k > 0 ? noise : P) * rows;
      WindowSweep sweep;
      sweep.predicted = estimated(x, P);
      sweep.jacobian_previous = in_unknowns(jacobian_previous * (1.0 + transition_error));

      const Dense H = numbers.matrix(kMeasured, kFree), z = numbers.matrix(kMeasured, 1);
      const Dense R = 0.1 * Dense::Identity(kMeasured, kMeasured);
      information.block(at, at, kFree, kFree) += H.transpose() * inverse(R) * H;
      pull.middleRows(at, kFree) += H.transpose() * inverse(R) * z;
      const Dense gain = P * H.transpose() * inverse(H * P * H.transpose() + R);
      x = x + gain * (z - H * x);
      P = P - gain * H * P;
      P = Dense(0.5 * (P + P.transpose()));
      sweep.filtered = sweep.smoothed = estimated(x, P);
      EXPECT_FALSE(window.is_full());
      window.append_sweep() = std::move(sweep);
    }
    window.smooth();
  }

  /// Returns the largest difference from the batch, over means and covariances of all sweeps.
  double difference(EstimatedSweep WindowSweep::*which) const {
    const Dense covariance = inverse(information), mean = covariance * pull;
    double largest = 0.0;
    for (int k = 0; k < kSweeps; ++k) {
      const EstimatedSweep& estimate = window.sweeps()[static_cast<std::size_t>(k)].*which;
      const Dense errors = estimate.error_covariance(kLinear, kLinear);
      largest = std::max({largest, (mean_of(estimate) - mean.middleRows(k * kFree, kFree)).cwiseAbs().maxCoeff(),
                          (errors - covariance.block(k * kFree, k * kFree, kFree, kFree)).cwiseAbs().maxCoeff()});
    }
    return largest;
  }
};

// The window adds 1e-12 to variances so that it can invert them; the remaining difference is rounding.
TEST(LagWindow, SmoothsToTheBatchSolutionOfAllSweeps) {
  EXPECT_LT(System().difference(&WindowSweep::smoothed), 1e-8);
}

TEST(LagWindow, WhatIsNotSmoothedOrWronglyTiedIsNotTheBatchSolution) {
  EXPECT_GT(System().difference(&WindowSweep::filtered), 0.1);
  EXPECT_GT(System(0.01).difference(&WindowSweep::smoothed), 1e-3);
}

TEST(LagWindow, TheOldestLeavesOnceItIsFull) {
  LagWindow window(2);
  const auto ending_at = [](TimeNs end_ns) {
    WindowSweep sweep;
    sweep.end_ns = end_ns;
    return sweep;
  };
  window.smooth();
  window.append_sweep() = ending_at(1);
  EXPECT_FALSE(window.is_full());
  window.append_sweep() = ending_at(2);
  EXPECT_TRUE(window.is_full());
  EXPECT_EQ(window.sweeps().front().end_ns, 1);
  window.append_sweep() = ending_at(3);
  EXPECT_EQ(window.sweeps().size(), 2u);
  EXPECT_EQ(window.sweeps().front().end_ns, 2);
}

}  // namespace
}  // namespace tumble::mapping
