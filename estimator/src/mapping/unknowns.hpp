// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "tumble/mapping/detail/registration.hpp"

/// Defines names for ranges of the registration's unknowns (docs/maths/mapping.md), for example `row_range(F,
/// velocity)` and `segment(step, velocity)`.

namespace tumble::mapping::unknowns {

template <int First, int Size>
struct UnknownRange {};

inline constexpr UnknownRange<0, 3> position;  ///< position in W
inline constexpr UnknownRange<3, 3> attitude;  ///< left perturbation in W
inline constexpr UnknownRange<3, 2> tilt;      ///< attitude about W's horizontal axes
inline constexpr UnknownRange<6, 3> velocity;  ///< velocity in W
inline constexpr UnknownRange<0, 6> pose;      ///< position, attitude
inline constexpr UnknownRange<0, Registration::kMotionSize> motion;
inline constexpr UnknownRange<Registration::kFirstDeficitUnknown, SweepTrajectory::kDeficitUnknowns> deficit;
inline constexpr UnknownRange<0, Registration::kFirstCalibrationUnknown> moving;  ///< motion and deficit
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown, LidarImuCalibration::kErrorCount> calibration;
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown, 6>
    mounting;  ///< rotation and translation of T_IL
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown, 3> mounting_rotation;
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown + 3, 3> mounting_translation;
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown + 6, 1> clock;
inline constexpr UnknownRange<Registration::kFirstCalibrationUnknown + 7, 3> gravity;

/// kMinVariance is added to the variance of each unknown, so that the prior covariance is invertible.
inline constexpr double kMinVariance = 1e-12;
/// 95 % quantile of the chi-square distribution with nine degrees of freedom, used in mapping.md (R25), (R67)
inline constexpr double kAgreementChi2Max = 16.9;
static_assert(RegistrationUnknowns::kMotionSize == 9);

/// Returns the index of a gyro axis' saturation deficit in the vector of all unknowns. The instants (knots) 0, 1 and 2
/// are start, middle and end of the sweep.
constexpr int saturation_deficit_index(int axis, int knot) {
  return Registration::kFirstDeficitUnknown + 3 * knot + axis;
}

template <class Vector, int First, int Size>
auto segment(Vector& v, UnknownRange<First, Size>) {
  return v.template segment<Size>(First);
}

template <class Matrix, int First, int Size>
auto row_range(Matrix& m, UnknownRange<First, Size>) {
  return m.template middleRows<Size>(First);
}

template <class Matrix, int First, int Size>
auto columns(Matrix& m, UnknownRange<First, Size>) {
  return m.template middleCols<Size>(First);
}

template <class Matrix, int Row, int Rows, int Column, int Columns>
auto sub_block(Matrix& m, UnknownRange<Row, Rows>, UnknownRange<Column, Columns>) {
  return m.template block<Rows, Columns>(Row, Column);
}

template <class Matrix, int First, int Size>
auto sub_block(Matrix& m, UnknownRange<First, Size> of) {
  return sub_block(m, of, of);
}

template <class Matrix, int First, int Size>
auto variances(Matrix& m, UnknownRange<First, Size>) {
  return m.diagonal().template segment<Size>(First);
}

}  // namespace tumble::mapping::unknowns

namespace tumble {

struct Registration::Unknowns {
  std::array<int, kUnknowns> free_unknowns{};  ///< indices of the free unknowns, ascending
  int count = 0;
  bool deficit_free = false, calibration_free = false;

  /// The unknowns of the motion (position, attitude, velocity) are always free. A saturation deficit or calibration
  /// constant is free if its prior variance is above 0.
  explicit Unknowns(const Matrix& covariance);

  /// Expands vectors and matrices over the free unknowns to all unknowns, with zeros for fixed unknowns.
  void expand_to_all_unknowns(const Sums& sum, Matrix& H, Vector& g) const;
  /// Changes the normal equations such that the solution for each fixed unknown is 0.
  void fix_constrained_unknowns(Matrix& H, Vector& g) const;
  void clear_fixed_blocks(Matrix& M) const;
  void clear_fixed(Matrix& covariance) const;

 private:
  bool is_free_unknown(int unknown) const {
    return std::find(free_unknowns.begin(), free_unknowns.begin() + count, unknown) != free_unknowns.begin() + count;
  }
};

}  // namespace tumble
