// SPDX-License-Identifier: BSD-3-Clause
// CMakeLists.txt adds precompiled.hpp to each source to reduce the compile time (docs/figures.md).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

namespace tumble::precompiled {

/// `known` is always true. To compute `known`, the compiler must instantiate the given Eigen expressions and their
/// evaluators.
template <class... Expressions>
constexpr bool known = (... && (sizeof(std::remove_cvref_t<Expressions>) > 0 &&
                                sizeof(Eigen::internal::evaluator<std::remove_cvref_t<Expressions>>) > 0));

template <class... Matrices>
constexpr bool known_matrices = (... && known<Matrices, decltype(Matrices::Zero()), const Matrices>);
template <class... Matrices>
constexpr bool known_squares = known_matrices<Matrices...>&& known<decltype(Matrices::Identity())...>;

template <int rows, int columns = 1>
using Real = Eigen::Matrix<double, rows, columns>;

// The vectors and matrices below are declared without definition, because expressions with them are never evaluated.
extern const Eigen::Vector3d a, b;
extern Eigen::Vector3d c;
extern const Eigen::Matrix3d R;
extern Eigen::Matrix3d Q;
extern const Eigen::Map<Eigen::VectorXd, Eigen::Aligned16> part;
extern const double s;

static_assert(known_matrices<Real<2>, Real<3>, Real<4>, Real<5>, Real<6>, Real<9>, Real<Eigen::Dynamic>, Real<3, 6>>);
static_assert(known_squares<Real<2, 2>, Real<3, 3>, Real<4, 4>, Real<6, 6>, Real<9, 9>>);
static_assert(known_matrices<Real<20>, Real<29>, Real<3, 20>, Real<29, 29>> && known_squares<Real<20, 20>>);
static_assert(known<decltype(a + b), decltype(a - b), decltype(s * a), decltype(a / s), decltype(a + s * b),
                    decltype(s * (a - b)), decltype(a.cwiseAbs()), decltype(a.cwiseAbs2()),
                    decltype(a.conjugate().cwiseProduct(b)), decltype(R * a), decltype(R.lazyProduct(a)),
                    decltype(a.transpose()), decltype(s * part)>);
static_assert(known<decltype((a - a).array()), decltype((a - a).array() == (a - a).array()), decltype(a.cwiseEqual(b)),
                    decltype(R.cwiseNotEqual(Q.Identity()))>);
static_assert(
    known<decltype(R.row(0)), decltype(R.col(0)), decltype(Q.row(0)), decltype(R.row(0).transpose()),
          decltype(Q.row(0).transpose()), decltype(a.col(0)), decltype(R.row(0).transpose().cwiseProduct(a.col(0)))>);

}  // namespace tumble::precompiled
