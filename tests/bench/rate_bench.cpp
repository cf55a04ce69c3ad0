// SPDX-License-Identifier: BSD-3-Clause
// Measures the rate smoother on one core, next to a general sparse solver on the same normal equations. Times are per
// sample and iteration (batch, solvers), or per sample (streaming, 0.2 s of lag at 100 Hz).
#include <benchmark/benchmark.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstddef>
#include <optional>
#include <vector>

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace {

namespace arrow = tumble::arrow;

tumble::TumbleRecording recording(int flights) {
  tumble::TumbleOptions options;
  options.seed = 3;
  options.flights = flights;
  return tumble::make_tumble(options);
}

void batch(benchmark::State& state) {
  const tumble::TumbleRecording tumbling = recording(static_cast<int>(state.range(0)));
  const tumble::AngularRateSmoother smoother(tumble::with_lever_arm<tumble::AngularRateSmoother::Params>());
  std::vector<tumble::AngularRateState> out;
  tumble::AngularRateReport report;
  double iterations = 0.0;
  for (auto _ : state) {
    if (!smoother.estimate(tumbling.samples, out, report).ok()) state.SkipWithError("not estimated");
    iterations += report.iterations;
  }
  const double samples = static_cast<double>(tumbling.samples.size());
  state.counters["samples"] = samples;
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["per_sample_iteration"] =
      benchmark::Counter(samples * iterations, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(batch)->Arg(8)->Arg(80)->Arg(800)->Unit(benchmark::kMillisecond);

void streaming(benchmark::State& state) {
  const tumble::TumbleRecording tumbling = recording(8);
  auto params = tumble::with_lever_arm<tumble::AngularRateStream::Params>();
  params.saturation_detector.stated_gyro_range_rad_s = 10.5;
  const tumble::AngularRateStream stream(params);
  std::optional<tumble::AngularRateState> out;
  for (auto _ : state) {
    tumble::AngularRateStream::State hand_held = stream.start();
    for (const tumble::ImuSample& sample : tumbling.samples) {
      if (!stream.push(sample, hand_held, out).ok()) state.SkipWithError("not estimated");
    }
    benchmark::DoNotOptimize(hand_held);
  }
  state.counters["per_sample"] =
      benchmark::Counter(static_cast<double>(tumbling.samples.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(streaming)->Unit(benchmark::kMillisecond);

// Problem is a chain of positive definite blocks with a border, as in one iteration.
struct Problem {
  std::vector<arrow::Block> blocks;
  arrow::Corner corner;

  explicit Problem(std::size_t count) : blocks(count) {
    tumble::oracles::Gaussian noise(7);
    const auto fill = [&](auto& matrix) {
      for (Eigen::Index i = 0; i < matrix.size(); ++i) matrix.data()[i] = noise.uniform(-1.0, 1.0);
    };
    for (arrow::Block& block : blocks) {
      arrow::StateMatrix root;
      fill(root);
      block.diagonal = root * root.transpose() + 30.0 * arrow::StateMatrix::Identity();
      fill(block.coupling_to_next_state);
      fill(block.border_coupling);
      fill(block.gradient);
    }
    blocks.back().coupling_to_next_state.setZero();
    corner.matrix = (10.0 * static_cast<double>(count)) * arrow::BorderMatrix::Identity();
    fill(corner.gradient);
  }

  Eigen::Index size() const {
    return static_cast<Eigen::Index>(blocks.size()) * arrow::kBlockSize + arrow::kBorderSize;
  }

  // upper triangle
  Eigen::SparseMatrix<double> matrix() const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Eigen::Index row, Eigen::Index column, const auto& part) {
      for (Eigen::Index i = 0; i < part.rows(); ++i) {
        for (Eigen::Index j = 0; j < part.cols(); ++j) {
          if (row + i <= column + j) entries.emplace_back(row + i, column + j, part(i, j));
        }
      }
    };
    const Eigen::Index border = size() - arrow::kBorderSize;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Eigen::Index at = static_cast<Eigen::Index>(k) * arrow::kBlockSize;
      add(at, at, blocks[k].diagonal);
      if (k + 1 < blocks.size()) add(at, at + arrow::kBlockSize, blocks[k].coupling_to_next_state);
      add(at, border, blocks[k].border_coupling);
    }
    add(border, border, corner.matrix);
    Eigen::SparseMatrix<double> out(size(), size());
    out.setFromTriplets(entries.begin(), entries.end());
    return out;
  }

  Eigen::VectorXd gradient() const {
    Eigen::VectorXd out(size());
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      out.segment<arrow::kBlockSize>(static_cast<Eigen::Index>(k) * arrow::kBlockSize) = blocks[k].gradient;
    }
    out.tail<arrow::kBorderSize>() = corner.gradient;
    return out;
  }
};

constexpr std::size_t kSamples = 2000;

void per_sample(benchmark::State& state) {
  state.counters["per_sample"] = benchmark::Counter(
      static_cast<double>(kSamples), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Measures factorisation and solution in place, including a copy of the blocks.
void solve_arrow(benchmark::State& state) {
  const Problem problem(kSamples);
  const Eigen::VectorXd want =
      Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper>(problem.matrix()).solve(problem.gradient());
  std::vector<arrow::Block> blocks;
  arrow::BorderVector border;
  arrow::BorderMatrix covariance;
  arrow::StateVector step;
  for (auto _ : state) {
    blocks = problem.blocks;
    arrow::Corner corner = problem.corner;
    bool good = true;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      good = good && arrow::System::eliminate(blocks[k], k + 1 < blocks.size() ? &blocks[k + 1] : nullptr, corner);
    }
    good = good && arrow::System::solve_border_block(corner, border, covariance);
    for (std::size_t k = blocks.size(); k-- > 0;) {
      step = arrow::System::back_substitute(blocks[k], k + 1 < blocks.size() ? &step : nullptr, border);
    }
    benchmark::DoNotOptimize(step);
    // both solvers must solve the same problem
    if (!good || (step - want.head<arrow::kBlockSize>()).norm() > 1e-9 * want.norm()) state.SkipWithError("wrong");
  }
  per_sample(state);
}
BENCHMARK(solve_arrow)->Unit(benchmark::kMillisecond);

// Measures Eigen's sparse Cholesky with its own ordering; the pattern analysis runs once, outside of the measured time.
void solve_sparse(benchmark::State& state) {
  const Problem problem(kSamples);
  const Eigen::SparseMatrix<double> matrix = problem.matrix();
  const Eigen::VectorXd gradient = problem.gradient();
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Upper> solver;
  solver.analyzePattern(matrix);
  Eigen::VectorXd step;
  for (auto _ : state) {
    solver.factorize(matrix);
    step = solver.solve(gradient);
    benchmark::DoNotOptimize(step.data());
  }
  per_sample(state);
}
BENCHMARK(solve_sparse)->Unit(benchmark::kMillisecond);

}  // namespace
