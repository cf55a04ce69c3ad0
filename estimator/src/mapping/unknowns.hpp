// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/mapping/detail/registration.hpp"

/// Names the registration's unknowns (docs/maths/mapping.md), as in `rows(F, velocity)` and `segment(step, velocity)`.
namespace tumble::mapping::unknowns {

template <int First, int Size>
struct Block {};

inline constexpr Block<0, 3> position;  ///< position in W
inline constexpr Block<3, 3> attitude;  ///< left perturbation in W
inline constexpr Block<3, 2> tilt;      ///< attitude about W's horizontal axes
inline constexpr Block<6, 3> velocity;  ///< velocity in W
inline constexpr Block<0, 6> pose;      ///< position, attitude
inline constexpr Block<0, Registration::kMotionSize> motion;
inline constexpr Block<Registration::kDeficitStart, SweepTrajectory::kDeficitSize> deficit;
inline constexpr Block<0, Registration::kCalibrationStart> moving;  ///< motion and deficit
inline constexpr Block<Registration::kCalibrationStart, SweepCalibration::kErrorCount> calibration;
inline constexpr Block<Registration::kCalibrationStart, 6> mounting;  ///< rotation and translation of T_IL
inline constexpr Block<Registration::kCalibrationStart, 3> mounting_rotation;
inline constexpr Block<Registration::kCalibrationStart + 3, 3> mounting_translation;
inline constexpr Block<Registration::kCalibrationStart + 6, 1> clock;
inline constexpr Block<Registration::kCalibrationStart + 7, 3> gravity;

/// A prior variance above 0 keeps the prior covariance invertible.
inline constexpr double kMinVariance = 1e-12;
/// 95 % quantile of the chi-square distribution with nine degrees of freedom, used in mapping.md (R25), (R67)
inline constexpr double kAgreementChi2Max = 16.9;
static_assert(SweepUnknowns::kMotionSize == 9);

/// Returns the index of an axis' saturation deficit at a knot, in the vector of all unknowns.
constexpr int deficit_at(int axis, int knot) {
  return Registration::kDeficitStart + 3 * knot + axis;
}

template <class Vector, int First, int Size>
auto segment(Vector& v, Block<First, Size>) {
  return v.template segment<Size>(First);
}

template <class Matrix, int First, int Size>
auto rows(Matrix& m, Block<First, Size>) {
  return m.template middleRows<Size>(First);
}

template <class Matrix, int First, int Size>
auto columns(Matrix& m, Block<First, Size>) {
  return m.template middleCols<Size>(First);
}

template <class Matrix, int Row, int Rows, int Column, int Columns>
auto block(Matrix& m, Block<Row, Rows>, Block<Column, Columns>) {
  return m.template block<Rows, Columns>(Row, Column);
}

template <class Matrix, int First, int Size>
auto block(Matrix& m, Block<First, Size> of) {
  return block(m, of, of);
}

template <class Matrix, int First, int Size>
auto variances(Matrix& m, Block<First, Size>) {
  return m.diagonal().template segment<Size>(First);
}

}  // namespace tumble::mapping::unknowns
