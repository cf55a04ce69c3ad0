// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/arrow_solver.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"

namespace tumble::arrow {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct System {
  std::vector<Block> blocks;
  Corner corner;
};

// Returns blocks as sums of outer products of random rows, so that the whole matrix is positive definite.
System random_system(std::size_t count, std::uint64_t seed) {
  oracles::Gaussian noise(seed);
  System s;
  s.blocks.resize(count);
  const auto fill = [&](auto& m) {
    for (double& x : m.reshaped()) x = noise();
  };
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::Matrix<double, 8, kBlockSize> here, next;
    Eigen::Matrix<double, 8, kBorderSize> border;
    fill(here);
    fill(next);
    fill(border);
    s.blocks[k].diagonal += here.transpose() * here + 0.1 * StateMatrix::Identity();
    s.blocks[k].border_coupling += here.transpose() * border;
    s.corner.matrix += border.transpose() * border;
    if (k + 1 < count) {
      s.blocks[k].coupling_to_next_state += here.transpose() * next;
      s.blocks[k + 1].diagonal += next.transpose() * next;
      s.blocks[k + 1].border_coupling += next.transpose() * border;
    }
    fill(s.blocks[k].gradient);
  }
  s.corner.matrix += 0.1 * BorderMatrix::Identity();
  fill(s.corner.gradient);
  return s;
}

MatrixXd dense_matrix(const System& s) {
  const Index n = static_cast<Index>(s.blocks.size()) * kBlockSize;
  MatrixXd H = MatrixXd::Zero(n + kBorderSize, n + kBorderSize);
  for (std::size_t k = 0; k < s.blocks.size(); ++k) {
    const Index i = static_cast<Index>(k) * kBlockSize;
    H.block(i, i, kBlockSize, kBlockSize) = s.blocks[k].diagonal;
    H.block(i, n, kBlockSize, kBorderSize) = s.blocks[k].border_coupling;
    H.block(n, i, kBorderSize, kBlockSize) = s.blocks[k].border_coupling.transpose();
    if (k + 1 == s.blocks.size()) continue;
    H.block(i, i + kBlockSize, kBlockSize, kBlockSize) = s.blocks[k].coupling_to_next_state;
    H.block(i + kBlockSize, i, kBlockSize, kBlockSize) = s.blocks[k].coupling_to_next_state.transpose();
  }
  H.bottomRightCorner(kBorderSize, kBorderSize) = s.corner.matrix;
  return H;
}

VectorXd dense_gradient(const System& s) {
  const Index n = static_cast<Index>(s.blocks.size()) * kBlockSize;
  VectorXd g(n + kBorderSize);
  for (std::size_t k = 0; k < s.blocks.size(); ++k)
    g.segment(static_cast<Index>(k) * kBlockSize, kBlockSize) = s.blocks[k].gradient;
  g.tail(kBorderSize) = s.corner.gradient;
  return g;
}

TEST(ArrowSolver, SolutionAndCovarianceAreThoseOfTheDenseSystem) {
  for (std::size_t count : {1u, 2u, 3u, 17u}) {
    System s = random_system(count, count);
    const MatrixXd H = dense_matrix(s);
    const VectorXd want = H.ldlt().solve(dense_gradient(s));
    const MatrixXd covariance = H.inverse();

    for (std::size_t k = 0; k < count; ++k) {
      ASSERT_TRUE(arrow::System::eliminate(s.blocks[k], k + 1 < count ? &s.blocks[k + 1] : nullptr, s.corner));
    }
    BorderVector border;
    BorderMatrix border_covariance;
    ASSERT_TRUE(arrow::System::solve_border_block(s.corner, border, border_covariance));
    // condition numbers are below 1e5: rounding is at most 1e-11, measured 1e-13
    EXPECT_LE((border - want.tail(kBorderSize)).norm(), 1e-9 * want.norm());
    EXPECT_LE((border_covariance - covariance.bottomRightCorner(kBorderSize, kBorderSize)).norm(),
              1e-9 * covariance.norm());

    StateVector step;
    Conditional conditional;
    for (std::size_t k = count; k-- > 0;) {
      const Index i = static_cast<Index>(k) * kBlockSize;
      const bool last = k + 1 == count;
      step = arrow::System::back_substitute(s.blocks[k], last ? nullptr : &step, border);
      conditional = arrow::System::state_given_next_state(s.blocks[k], last ? nullptr : &conditional);
      EXPECT_LE((step - want.segment(i, kBlockSize)).norm(), 1e-9 * want.norm()) << k;
      const Eigen::Matrix3d expected = covariance.block<3, 3>(i, i);
      EXPECT_LE((rate_covariance(conditional, border_covariance) - expected).norm(), 1e-9 * covariance.norm()) << k;
    }
  }
}

TEST(ArrowSolver, ErrorsMoveTheSolutionAsInTheDenseSystem) {
  for (std::size_t count : {1u, 2u, 17u}) {
    System s = random_system(count, count);
    const Index n = static_cast<Index>(count) * kBlockSize;
    oracles::Gaussian noise(100 + count);
    MatrixXd gained(n + kBorderSize, kErrorCount);
    for (double& x : gained.reshaped()) x = noise();
    const MatrixXd want = dense_matrix(s).ldlt().solve(gained);

    BorderErrors border = gained.bottomRows(kBorderSize);
    std::vector<ErrorMatrix> errors(count);
    for (std::size_t k = 0; k < count; ++k)
      errors[k] = gained.middleRows<kBlockSize>(static_cast<Index>(k) * kBlockSize);
    for (std::size_t k = 0; k < count; ++k) {
      const bool last = k + 1 == count;
      ASSERT_TRUE(arrow::System::eliminate(s.blocks[k], last ? nullptr : &s.blocks[k + 1], s.corner));
      eliminate_sensor_errors(s.blocks[k], errors[k], last ? nullptr : &errors[k + 1], border);
    }
    BorderVector step;
    BorderMatrix border_covariance;
    ASSERT_TRUE(arrow::System::solve_border_block(s.corner, step, border_covariance));
    const BorderErrors border_moved = border_covariance * border;
    EXPECT_LE((border_moved - want.bottomRows(kBorderSize)).norm(), 1e-9 * want.norm());
    ErrorMatrix moved;
    for (std::size_t k = count; k-- > 0;) {
      moved = back_substitute_errors(s.blocks[k], errors[k], k + 1 == count ? nullptr : &moved, border_moved);
      EXPECT_LE((moved - want.middleRows<kBlockSize>(static_cast<Index>(k) * kBlockSize)).norm(), 1e-9 * want.norm())
          << k;
    }
  }
}

TEST(ArrowSolver, EliminatingTheFirstBlockIsItsMarginalisation) {
  System s = random_system(4, 9);
  const MatrixXd want =
      dense_matrix(s).inverse().bottomRightCorner(3 * kBlockSize + kBorderSize, 3 * kBlockSize + kBorderSize);
  ASSERT_TRUE(arrow::System::eliminate(s.blocks[0], &s.blocks[1], s.corner));
  System rest{{s.blocks.begin() + 1, s.blocks.end()}, s.corner};
  EXPECT_LE((dense_matrix(rest).inverse() - want).norm(), 1e-9 * want.norm());
}

TEST(ArrowSolver, RefusesWhatIsNotPositiveDefinite) {
  System s = random_system(2, 3);
  s.blocks[0].diagonal(5, 5) = -1.0;
  EXPECT_FALSE(arrow::System::eliminate(s.blocks[0], &s.blocks[1], s.corner));
  s = random_system(1, 4);
  s.blocks[0].diagonal(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(arrow::System::eliminate(s.blocks[0], nullptr, s.corner));
  Corner corner;
  BorderVector step;
  BorderMatrix covariance;
  EXPECT_FALSE(arrow::System::solve_border_block(corner, step, covariance));
}

}  // namespace
}  // namespace tumble::arrow
