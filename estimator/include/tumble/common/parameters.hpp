// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "tumble/common/status.hpp"

/// A `Params` struct describes each of its numbers in one place, the function `fields`. Range checks, tables, readers
/// and comparisons are visitors of the function `fields`.
///
/// A `Params` struct has `template <class Self, class Visitor> static void fields(Self& p, Visitor& visit)`. The
/// function `fields` calls `visit(p.member, Field)` for each double, int, std::size_t, bool, enumeration (by its
/// number) and Vector3d. For each nested `Params`, the function `fields` calls `visit.group("prefix_", p.member)`. The
/// type `Self` may be const.
///
/// Poses, planes and earlier calibrations are not fields, because users do not set poses, planes and calibrations as
/// numbers. The bounds of a Field are plain numbers, so constructors check relations between fields separately.
namespace tumble {

/// FieldRank determines the order of fields in a listing. The rank `basic` marks the numbers that users usually set
/// before any others.
enum class FieldRank : std::uint8_t { basic, advanced };

/// Field describes one number of a `Params` struct. All strings are static.
struct Field {
  const char* name;     ///< with its unit as suffix; used in tables, suites and messages
  const char* unit;     ///< "1" if dimensionless
  double low, high;     ///< inclusive bounds; for a vector, the bounds of each coordinate
  const char* meaning;  ///< one sentence: effect and source
  FieldRank rank = FieldRank::advanced;
};

/// Returns a Field for a boolean switch.
inline Field switch_field(const char* name, const char* meaning, FieldRank rank = FieldRank::advanced) {
  return {name, "1", 0.0, 1.0, meaning, rank};
}

/// Limit of a field whose value only needs to be finite.
inline constexpr double kUnbounded = std::numeric_limits<double>::max();

/// Number is satisfied by the types that a visitor receives as a number, as opposed to a vector or a nested `Params`.
template <class T>
concept Number = std::is_arithmetic_v<std::remove_cvref_t<T>> || std::is_enum_v<std::remove_cvref_t<T>>;

namespace detail {

/// OutOfBounds describes the first field whose value is not allowed. `names` contains the prefixes of the field's
/// groups, followed by the field's name.
struct OutOfBounds {
  std::array<const char*, 8> names{};
  std::size_t depth = 0;
  double low = 0.0, high = 0.0;  ///< violated bounds
  Status status;
};

/// BoundsChecker is a visitor that finds the first field whose value is not allowed; NaN is never allowed. The
/// visitor does not allocate.
class BoundsChecker {
 public:
  explicit BoundsChecker(OutOfBounds& out) : out_(out) {}

  template <Number T>
  void operator()(const T& value, const Field& field) {
    check(static_cast<double>(value), field);
  }
  void operator()(const Eigen::Vector3d& value, const Field& field) {
    for (const double coordinate : value) check(coordinate, field);
  }
  template <class Params>
  void group(const char* prefix, const Params& params) {
    if (!out_.status.ok()) return;
    out_.names.at(out_.depth++) = prefix;
    Params::fields(params, *this);
    if (out_.status.ok()) --out_.depth;
  }

 private:
  void check(double value, const Field& field);

  OutOfBounds& out_;
};

/// Throws InvalidParams with the full name of the found field, unless `found` is empty.
void throw_if_out_of_bounds(const OutOfBounds& found);

}  // namespace detail

/// Checks the bounds of all fields of `params`. Returns `out_of_range` with name, value and bound of the first
/// violation, or `ok`. The returned name of a nested field lacks the prefix of the field's group. The function does not
/// allocate.
template <class Params>
Status check_fields(const Params& params) {
  detail::OutOfBounds found;
  detail::BoundsChecker visitor(found);
  Params::fields(params, visitor);
  return found.status;
}

/// Throws InvalidParams for the first field of `params` that is out of its bounds.
template <class Params>
void require_valid_fields(const Params& params) {
  detail::OutOfBounds found;
  detail::BoundsChecker visitor(found);
  Params::fields(params, visitor);
  detail::throw_if_out_of_bounds(found);
}

}  // namespace tumble
