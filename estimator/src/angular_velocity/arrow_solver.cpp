// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/arrow_solver.hpp"

namespace tumble {

// See rate_smoother.md (R27), (R28), (R29), (R33), (R34).
template struct BlockArrowSystem<arrow::kBlockSize, arrow::kBorderSize>;

namespace arrow {

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

}  // namespace arrow

}  // namespace tumble
