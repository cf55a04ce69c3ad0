// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/arrow_solver.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace tumble::arrow {

namespace {

// Plain loops over columns: Eigen's general triangular solvers are several times slower at these sizes.
bool cholesky(StateMatrix& a) {
  for (int j = 0; j < kState; ++j) {
    double pivot = a(j, j);
    for (int k = 0; k < j; ++k) pivot -= a(j, k) * a(j, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    pivot = std::sqrt(pivot);
    a(j, j) = pivot;
    for (int i = j + 1; i < kState; ++i) {
      double sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= a(i, k) * a(j, k);
      a(i, j) = sum / pivot;
    }
    for (int i = 0; i < j; ++i) a(i, j) = 0.0;
  }
  return true;
}

StateMatrix inverse_lower(const StateMatrix& L) {
  StateMatrix inverse = StateMatrix::Zero();
  for (int j = 0; j < kState; ++j) {
    inverse(j, j) = 1.0 / L(j, j);
    for (int i = j + 1; i < kState; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum -= L(i, k) * inverse(k, j);
      inverse(i, j) = sum / L(i, i);
    }
  }
  return inverse;
}

}  // namespace

bool eliminate(Block& block, Block* next, Corner& corner) {
  if (!cholesky(block.diagonal)) return false;
  // products with the inverse factor: fixed sizes, which the compiler unrolls and vectorises
  const StateMatrix L_inv = inverse_lower(block.diagonal);
  block.border = (L_inv.lazyProduct(block.border)).eval();
  block.gradient = (L_inv.lazyProduct(block.gradient)).eval();
  corner.matrix.noalias() -= block.border.transpose().lazyProduct(block.border);
  corner.gradient.noalias() -= block.border.transpose().lazyProduct(block.gradient);
  if (next == nullptr) {
    block.coupling.setZero();
    return true;
  }
  block.coupling = (L_inv.lazyProduct(block.coupling)).eval();
  next->diagonal.noalias() -= block.coupling.transpose().lazyProduct(block.coupling);
  next->border.noalias() -= block.coupling.transpose().lazyProduct(block.border);
  next->gradient.noalias() -= block.coupling.transpose().lazyProduct(block.gradient);
  return true;
}

bool solve_corner(const Corner& corner, BorderVector& step, BorderMatrix& covariance) {
  const Eigen::LLT<BorderMatrix> factor(corner.matrix);
  if (factor.info() != Eigen::Success) return false;
  covariance = factor.solve(BorderMatrix::Identity());
  step = factor.solve(corner.gradient);
  return covariance.allFinite() && step.allFinite();
}

StateVector back_substitute(const Block& block, const StateVector* next_step, const BorderVector& border_step) {
  StateVector right = block.gradient - block.border.lazyProduct(border_step);
  if (next_step != nullptr) right.noalias() -= block.coupling.lazyProduct(*next_step);
  for (int i = kState - 1; i >= 0; --i) {
    for (int k = i + 1; k < kState; ++k) right[i] -= block.diagonal(k, i) * right[k];
    right[i] /= block.diagonal(i, i);
  }
  return right;
}

Marginal back_covariance(const Block& block, const Marginal* next, const BorderMatrix& border_covariance) {
  const StateMatrix L_inv = inverse_lower(block.diagonal);
  const CrossMatrix G = L_inv.transpose().lazyProduct(block.border);
  Marginal out;
  const CrossMatrix G_covariance = G.lazyProduct(border_covariance);
  out.cross = -G_covariance;
  out.state = L_inv.transpose().lazyProduct(L_inv);
  out.state.noalias() += G_covariance.lazyProduct(G.transpose());
  if (next == nullptr) return out;
  const StateMatrix A = L_inv.transpose().lazyProduct(block.coupling);
  const CrossMatrix A_cross = A.lazyProduct(next->cross);
  out.cross -= A_cross;
  const StateMatrix mixed = A_cross.lazyProduct(G.transpose());
  const StateMatrix A_state = A.lazyProduct(next->state);
  out.state.noalias() += A_state.lazyProduct(A.transpose());
  out.state += mixed + mixed.transpose();
  return out;
}

}  // namespace tumble::arrow
