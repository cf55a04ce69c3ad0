// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/arrow_solver.hpp"

namespace tumble::arrow {

// See rate_smoother.md (R27).
bool eliminate(Block& block, Block* next, Corner& corner) {
  return System::eliminate(block, next, corner);
}

// See rate_smoother.md (R28).
bool solve_border_block(const Corner& corner, BorderVector& step, BorderMatrix& covariance) {
  return System::solve_border_block(corner, step, covariance);
}

// See rate_smoother.md (R29).
StateVector back_substitute(const Block& block, const StateVector* next_step, const BorderVector& border_step) {
  return System::back_substitute(block, next_step, border_step);
}

// See rate_smoother.md (R33), (R34).
Conditional state_given_next_state(const Block& block, const Conditional* next) {
  return System::state_given_next_state(block, next);
}

// See rate_smoother.md (R27).
void eliminate_sensor_errors(const Block& block, ErrorMatrix& errors, ErrorMatrix* next, BorderErrors& border) {
  errors = (block.diagonal.lazyProduct(errors)).eval();
  border.noalias() -= block.border_coupling.transpose().lazyProduct(errors);
  if (next != nullptr) next->noalias() -= block.coupling_to_next_state.transpose().lazyProduct(errors);
}

// See rate_smoother.md (R37).
ErrorMatrix back_substitute_errors(const Block& block, const ErrorMatrix& errors, const ErrorMatrix* next_moved,
                                   const BorderErrors& border_moved) {
  ErrorMatrix right = errors - block.border_coupling.lazyProduct(border_moved);
  if (next_moved != nullptr) right.noalias() -= block.coupling_to_next_state.lazyProduct(*next_moved);
  return block.diagonal.transpose().lazyProduct(right);
}

// See rate_smoother.md (R35).
Eigen::Matrix3d rate_covariance(const Conditional& conditional, const BorderMatrix& border_covariance) {
  const Eigen::Matrix<double, 3, kBorderSize> rows = conditional.border_jacobian.topRows<3>();
  const Eigen::Matrix<double, 3, kBorderSize> cross = rows.lazyProduct(border_covariance);
  Eigen::Matrix3d out = conditional.state.topLeftCorner<3, 3>();
  out.noalias() += cross.lazyProduct(rows.transpose());
  return out;
}

}  // namespace tumble::arrow
