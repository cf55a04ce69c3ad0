// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>

namespace tumble {

/// Normal equations H d = g of a chain of blocks of `State` unknowns. Each block is coupled to the next block and to a
/// common border of `Border` unknowns (arrow matrix). The cost of a solution is O(N) for N blocks.
///
///     | D0  E0          B0 |
///     | E0' D1  E1      B1 |
///     |     E1' D2 ...  B2 |
///     | B0' B1' B2' ..  C  |
template <int State, int Border>
struct BlockArrowSystem {
  using StateMatrix = Eigen::Matrix<double, State, State>;
  using StateVector = Eigen::Matrix<double, State, 1>;
  using CrossMatrix = Eigen::Matrix<double, State, Border>;
  using BorderMatrix = Eigen::Matrix<double, Border, Border>;
  using BorderVector = Eigen::Matrix<double, Border, 1>;

  /// Row of blocks D, E, B and g of the normal equations. After elimination, the row contains L^-1, L^-1 E, L^-1 B and
  /// L^-1 g, with the Cholesky factor L of D.
  struct StateBlock {
    StateMatrix diagonal = StateMatrix::Zero();
    StateMatrix coupling_to_next_state = StateMatrix::Zero();
    CrossMatrix border_coupling = CrossMatrix::Zero();
    StateVector gradient = StateVector::Zero();
  };

  /// Border block C and its gradient; after elimination, the Schur complements of both.
  struct BorderBlock {
    BorderMatrix matrix = BorderMatrix::Zero();
    BorderVector gradient = BorderVector::Zero();
  };

  /// Normal distribution of a block for a known border: covariance, and derivative of the mean with respect to the
  /// border.
  struct StateGivenNextState {
    StateMatrix state;
    CrossMatrix border_jacobian;
  };

  /// Eliminates `block`, and adds its Schur complement to the corner and to `next` (null for the last block). Returns
  /// false if the block is not positive definite.
  static bool eliminate(StateBlock& block, StateBlock* next, BorderBlock& corner);

  /// Computes the solution for the border and its covariance, after all blocks are eliminated. Returns false if the
  /// corner is not positive definite.
  static bool solve_border_block(const BorderBlock& corner, BorderVector& step, BorderMatrix& covariance);

  /// Returns the solution for an eliminated block, from the solutions for the next block (null for the last block) and
  /// for the border.
  static StateVector back_substitute(const StateBlock& block, const StateVector* next_step,
                                     const BorderVector& border_step);

  /// Returns the distribution of an eliminated block. `next` is null for the last block.
  static StateGivenNextState state_given_next_state(const StateBlock& block, const StateGivenNextState* next);

 private:
  static bool invert_cholesky_factor(StateMatrix& a);
  static void subtract_squared_coupling(const CrossMatrix& border, BorderMatrix& corner);
};

// Replaces `a` by the inverse of its Cholesky factor. For small blocks, plain loops over columns are several times
// faster than Eigen's general triangular solvers.
template <int State, int Border>
bool BlockArrowSystem<State, Border>::invert_cholesky_factor(StateMatrix& a) {
  StateMatrix L = a;
  StateVector over_pivot;
  for (int j = 0; j < State; ++j) {
    double pivot = L(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    over_pivot[j] = 1.0 / std::sqrt(pivot);
    for (int i = j + 1; i < State; ++i) {
      double sum = L(i, j);
      for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
      L(i, j) = sum * over_pivot[j];
    }
  }
  a.setZero();
  for (int j = 0; j < State; ++j) {
    a(j, j) = over_pivot[j];
    for (int i = j + 1; i < State; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum -= L(i, k) * a(k, j);
      a(i, j) = sum * over_pivot[i];
    }
  }
  return true;
}

template <int State, int Border>
void BlockArrowSystem<State, Border>::subtract_squared_coupling(const CrossMatrix& border, BorderMatrix& corner) {
  constexpr int kHead = Border > 16 ? 12 : Border > 8 ? 8 : Border - 1, kTail = Border - kHead;
  const auto head = border.template leftCols<kHead>();
  const auto tail = border.template rightCols<kTail>();
  corner.template topLeftCorner<kHead, kHead>().noalias() -= head.transpose().lazyProduct(head);
  corner.template bottomRightCorner<kTail, kTail>().noalias() -= tail.transpose().lazyProduct(tail);
  corner.template bottomLeftCorner<kTail, kHead>().noalias() -= tail.transpose().lazyProduct(head);
  corner.template topRightCorner<kHead, kTail>() = corner.template bottomLeftCorner<kTail, kHead>().transpose();
}

template <int State, int Border>
bool BlockArrowSystem<State, Border>::eliminate(StateBlock& block, StateBlock* next, BorderBlock& corner) {
  if (!invert_cholesky_factor(block.diagonal)) return false;
  // Fixed sizes let the compiler unroll and vectorise products with the inverse factor.
  const StateMatrix& L_inv = block.diagonal;
  block.border_coupling = (L_inv.lazyProduct(block.border_coupling)).eval();
  block.gradient = (L_inv.lazyProduct(block.gradient)).eval();
  subtract_squared_coupling(block.border_coupling, corner.matrix);
  corner.gradient.noalias() -= block.border_coupling.transpose().lazyProduct(block.gradient);
  if (next == nullptr) {
    block.coupling_to_next_state.setZero();
    return true;
  }
  block.coupling_to_next_state = (L_inv.lazyProduct(block.coupling_to_next_state)).eval();
  next->diagonal.noalias() -= block.coupling_to_next_state.transpose().lazyProduct(block.coupling_to_next_state);
  next->border_coupling.noalias() -= block.coupling_to_next_state.transpose().lazyProduct(block.border_coupling);
  next->gradient.noalias() -= block.coupling_to_next_state.transpose().lazyProduct(block.gradient);
  return true;
}

template <int State, int Border>
bool BlockArrowSystem<State, Border>::solve_border_block(const BorderBlock& corner, BorderVector& step,
                                                         BorderMatrix& covariance) {
  const Eigen::LLT<BorderMatrix> factor(corner.matrix);
  if (factor.info() != Eigen::Success) return false;
  covariance = factor.solve(BorderMatrix::Identity());
  step = factor.solve(corner.gradient);
  return covariance.allFinite() && step.allFinite();
}

template <int State, int Border>
auto BlockArrowSystem<State, Border>::back_substitute(const StateBlock& block, const StateVector* next_step,
                                                      const BorderVector& border_step) -> StateVector {
  StateVector right = block.gradient - block.border_coupling.lazyProduct(border_step);
  if (next_step != nullptr) right.noalias() -= block.coupling_to_next_state.lazyProduct(*next_step);
  return block.diagonal.transpose().lazyProduct(right);
}

template <int State, int Border>
auto BlockArrowSystem<State, Border>::state_given_next_state(const StateBlock& block, const StateGivenNextState* next)
    -> StateGivenNextState {
  const StateMatrix& L_inv = block.diagonal;
  StateGivenNextState out;
  out.state = L_inv.transpose().lazyProduct(L_inv);
  if (next == nullptr) {
    out.border_jacobian = -L_inv.transpose().lazyProduct(block.border_coupling);
    return out;
  }
  CrossMatrix pull = block.border_coupling;
  pull.noalias() += block.coupling_to_next_state.lazyProduct(next->border_jacobian);
  out.border_jacobian = -L_inv.transpose().lazyProduct(pull);
  const StateMatrix A = L_inv.transpose().lazyProduct(block.coupling_to_next_state);
  const StateMatrix A_state = A.lazyProduct(next->state);
  out.state.noalias() += A_state.lazyProduct(A.transpose());
  return out;
}

}  // namespace tumble
