// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/arrow_solver.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace tumble::arrow {

namespace {

// L^-1 of a = L L', lower, in place of a. Plain loops over columns: Eigen's general triangular solvers are several
// times slower at these sizes. One division a column.
bool invert_factor(StateMatrix& a) {
  StateMatrix L = a;
  StateVector over_pivot;
  for (int j = 0; j < kState; ++j) {
    double pivot = L(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    over_pivot[j] = 1.0 / std::sqrt(pivot);
    for (int i = j + 1; i < kState; ++i) {
      double sum = L(i, j);
      for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
      L(i, j) = sum * over_pivot[j];
    }
  }
  a.setZero();
  for (int j = 0; j < kState; ++j) {
    a(j, j) = over_pivot[j];
    for (int i = j + 1; i < kState; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum -= L(i, k) * a(k, j);
      a(i, j) = sum * over_pivot[i];
    }
  }
  return true;
}

// corner -= border' border, of which the upper right part is the mirror of the lower left
void subtract_square(const CrossMatrix& border, BorderMatrix& corner) {
  constexpr int kHead = 12, kTail = kBorder - kHead;
  const auto head = border.leftCols<kHead>();
  const auto tail = border.rightCols<kTail>();
  corner.topLeftCorner<kHead, kHead>().noalias() -= head.transpose().lazyProduct(head);
  corner.bottomRightCorner<kTail, kTail>().noalias() -= tail.transpose().lazyProduct(tail);
  corner.bottomLeftCorner<kTail, kHead>().noalias() -= tail.transpose().lazyProduct(head);
  corner.topRightCorner<kHead, kTail>() = corner.bottomLeftCorner<kTail, kHead>().transpose();
}

}  // namespace

bool eliminate(Block& block, Block* next, Corner& corner) {
  if (!invert_factor(block.diagonal)) return false;
  // products with the inverse factor: fixed sizes, which the compiler unrolls and vectorises
  const StateMatrix& L_inv = block.diagonal;
  block.border = (L_inv.lazyProduct(block.border)).eval();
  block.gradient = (L_inv.lazyProduct(block.gradient)).eval();
  subtract_square(block.border, corner.matrix);
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
  return block.diagonal.transpose().lazyProduct(right);
}

void eliminate_errors(const Block& block, ErrorMatrix& errors, ErrorMatrix* next, BorderErrors& border) {
  errors = (block.diagonal.lazyProduct(errors)).eval();
  border.noalias() -= block.border.transpose().lazyProduct(errors);
  if (next != nullptr) next->noalias() -= block.coupling.transpose().lazyProduct(errors);
}

ErrorMatrix back_substitute_errors(const Block& block, const ErrorMatrix& errors, const ErrorMatrix* next_moved,
                                   const BorderErrors& border_moved) {
  ErrorMatrix right = errors - block.border.lazyProduct(border_moved);
  if (next_moved != nullptr) right.noalias() -= block.coupling.lazyProduct(*next_moved);
  return block.diagonal.transpose().lazyProduct(right);
}

Conditional back_conditional(const Block& block, const Conditional* next) {
  const StateMatrix& L_inv = block.diagonal;
  Conditional out;
  out.state = L_inv.transpose().lazyProduct(L_inv);
  if (next == nullptr) {
    out.by_border = -L_inv.transpose().lazyProduct(block.border);
    return out;
  }
  CrossMatrix pull = block.border;
  pull.noalias() += block.coupling.lazyProduct(next->by_border);
  out.by_border = -L_inv.transpose().lazyProduct(pull);
  const StateMatrix A = L_inv.transpose().lazyProduct(block.coupling);
  const StateMatrix A_state = A.lazyProduct(next->state);
  out.state.noalias() += A_state.lazyProduct(A.transpose());
  return out;
}

Marginal marginal(const Conditional& conditional, const BorderMatrix& border_covariance) {
  Marginal out;
  out.cross = conditional.by_border.lazyProduct(border_covariance);
  out.state = conditional.state;
  out.state.noalias() += out.cross.lazyProduct(conditional.by_border.transpose());
  return out;
}

Eigen::Matrix3d rate_covariance(const Conditional& conditional, const BorderMatrix& border_covariance) {
  const Eigen::Matrix<double, 3, kBorder> rows = conditional.by_border.topRows<3>();
  const Eigen::Matrix<double, 3, kBorder> cross = rows.lazyProduct(border_covariance);
  Eigen::Matrix3d out = conditional.state.topLeftCorner<3, 3>();
  out.noalias() += cross.lazyProduct(rows.transpose());
  return out;
}

}  // namespace tumble::arrow
