// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tumble/common/detail/arrow_system.hpp"

namespace tumble {

namespace arrow {

inline constexpr int kBlockSize = 6;    ///< unknowns per sample: rate and scaled angular acceleration
inline constexpr int kBorderSize = 20;  ///< unknowns that all samples share: BodyImuConstants

using System = BlockArrowSystem<kBlockSize, kBorderSize>;
using StateMatrix = System::StateMatrix;
using StateVector = System::StateVector;
using CrossMatrix = System::CrossMatrix;
using BorderMatrix = System::BorderMatrix;
using BorderVector = System::BorderVector;
using Block = System::StateBlock;
using Corner = System::BorderBlock;
using Conditional = System::StateGivenNextState;

inline constexpr int kErrorCount = 29;  ///< number of sensor errors: SensorErrors

/// Derivative of a block's gradient with respect to the sensor errors; after back-substitution, derivative of the
/// block's Gauss-Newton step.
using ErrorMatrix = Eigen::Matrix<double, kBlockSize, kErrorCount>;
using BorderErrors = Eigen::Matrix<double, kBorderSize, kErrorCount>;

/// Eliminates a block from the derivatives with respect to the sensor errors. Call System::eliminate() for `block`
/// first. `next` is null for the last block.
void eliminate_sensor_errors(const Block& block, ErrorMatrix& errors, ErrorMatrix* next, BorderErrors& border);

/// Returns the derivative of a block's Gauss-Newton step with respect to each sensor error. `next_moved` (null for the
/// last block) and `border_moved` are the same derivatives of the next block and of the border.
ErrorMatrix back_substitute_errors(const Block& block, const ErrorMatrix& errors, const ErrorMatrix* next_moved,
                                   const BorderErrors& border_moved);

/// Returns the covariance of a sample's angular rate, including the uncertainty of the border (BodyImuConstants).
Eigen::Matrix3d rate_covariance(const Conditional& conditional, const BorderMatrix& border_covariance);

}  // namespace arrow

extern template struct BlockArrowSystem<arrow::kBlockSize, arrow::kBorderSize>;  // rate_descent.cpp
}  // namespace tumble
