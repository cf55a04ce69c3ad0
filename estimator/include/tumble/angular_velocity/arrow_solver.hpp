// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>

namespace tumble {

/// Normal equations H d = g of a chain of blocks that are each coupled to the next and to one common border (an
/// arrow matrix), factorised in place. O(N) for N blocks: one block Cholesky sweep, the border by Schur complement.
///
///     | D0  E0          B0 |
///     | E0' D1  E1      B1 |
///     |     E1' D2 ...  B2 |
///     | B0' B1' B2' ..  C  |
namespace arrow {

inline constexpr int kState = 6;    ///< size of a block: rate and scaled angular acceleration
inline constexpr int kBorder = 20;  ///< size of the border: see RigConstants

using StateMatrix = Eigen::Matrix<double, kState, kState>;
using StateVector = Eigen::Matrix<double, kState, 1>;
using CrossMatrix = Eigen::Matrix<double, kState, kBorder>;
using BorderMatrix = Eigen::Matrix<double, kBorder, kBorder>;
using BorderVector = Eigen::Matrix<double, kBorder, 1>;

/// One block row: before elimination D, E, B, g; afterwards L^-1, L^-1 E, L^-1 B, L^-1 g with D = L L' (lower).
struct Block {
  StateMatrix diagonal = StateMatrix::Zero();
  StateMatrix coupling = StateMatrix::Zero();  ///< to the next block, as (this, next)
  CrossMatrix border = CrossMatrix::Zero();
  StateVector gradient = StateVector::Zero();
};

/// The border: before elimination C and its gradient; afterwards their Schur complement.
struct Corner {
  BorderMatrix matrix = BorderMatrix::Zero();
  BorderVector gradient = BorderVector::Zero();
};

inline constexpr int kErrors = 9;  ///< errors considered at once: the entries of a matrix of scale and misalignment

/// What each of kErrors common errors adds to the gradient of a block, of the border; once solved, to their steps.
using ErrorMatrix = Eigen::Matrix<double, kState, kErrors>;
using BorderErrors = Eigen::Matrix<double, kBorder, kErrors>;

/// A block given the border: its covariance, and how far its mean moves with the border.
struct Conditional {
  StateMatrix state;
  CrossMatrix by_border;
};

/// Posterior covariance of a block and of its product with the border.
struct Marginal {
  StateMatrix state;
  CrossMatrix cross;
};

/// Eliminates `block`, passing what it knows on to `next` (which may be null for the last) and to the corner. Also the
/// marginalisation of the oldest block of a window. False when the block is not positive definite.
bool eliminate(Block& block, Block* next, Corner& corner);

/// Step of the border after all blocks are eliminated, and its covariance. False when not positive definite.
bool solve_corner(const Corner& corner, BorderVector& step, BorderMatrix& covariance);

/// Step of an eliminated block, given those of the next block (null for the last) and of the border.
StateVector back_substitute(const Block& block, const StateVector* next_step, const BorderVector& border_step);

/// The same for errors: takes those of an eliminated `block` forward, to the next (null for the last) and the border.
void eliminate_errors(const Block& block, ErrorMatrix& errors, ErrorMatrix* next, BorderErrors& border);

/// How an eliminated block moves with each error, from eliminate_errors(), given the same of the next block (null for
/// the last) and of the border.
ErrorMatrix back_substitute_errors(const Block& block, const ErrorMatrix& errors, const ErrorMatrix* next_moved,
                                   const BorderErrors& border_moved);

/// Conditional of an eliminated block, given that of the next block (null for the last).
Conditional back_conditional(const Block& block, const Conditional* next);

/// The border's own uncertainty brought in.
Marginal marginal(const Conditional& conditional, const BorderMatrix& border_covariance);
/// The rates' part (the first three rows and columns) of marginal().state, at less cost.
Eigen::Matrix3d rate_covariance(const Conditional& conditional, const BorderMatrix& border_covariance);

}  // namespace arrow
}  // namespace tumble
