// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "tumble/common/status.hpp"

/// Each `Params` struct describes its parameters once, in a static member function template `fields`. Range checks,
/// tables and file readers call `fields` with a visitor.
///
/// The signature is `template <class Self, class Visitor> static void fields(Self& p, Visitor& visit)`, and `Self` may
/// be const. `fields` calls `visit(p.member, Field)` for each number, boolean, enumeration and Vector3d of the struct.
/// `fields` calls `visit.group("prefix_", p.member)` for each nested `Params` struct. Poses, planes and calibrations
/// are not visited, because users do not enter them as plain numbers.
namespace tumble {

/// Most users adapt only the parameters of rank `common_use`.
enum class ParameterRank : std::uint8_t { common_use, expert_use };

/// All strings in a Field must have static lifetime.
struct Field {
  const char* name;         ///< name with its unit as suffix, used in tables and messages
  const char* unit;         ///< unit; "1" if dimensionless
  double low, high;         ///< inclusive bounds; for a vector, of each coordinate
  const char* description;  ///< one sentence that states the parameter's effect and source
  ParameterRank audience = ParameterRank::expert_use;
};

inline Field boolean_field(const char* name, const char* meaning, ParameterRank rank = ParameterRank::expert_use) {
  return {name, "1", 0.0, 1.0, meaning, rank};
}

/// bound for parameters without a limit: the largest finite number
inline constexpr double kUnbounded = std::numeric_limits<double>::max();

/// arithmetic and enumeration types, which a visitor receives as numbers
template <class T>
concept Number = std::is_arithmetic_v<std::remove_cvref_t<T>> || std::is_enum_v<std::remove_cvref_t<T>>;

namespace detail {

/// `names` contains the prefixes of the invalid parameter's groups, followed by its name.
struct OutOfBoundsParameter {
  std::array<const char*, 8> names{};
  std::size_t prefix_count = 0;
  double low = 0.0, high = 0.0;  ///< violated bounds
  Status status;
};

/// Finds the first parameter whose value is out of bounds or NaN, without allocating memory.
class BoundsChecker {
 public:
  explicit BoundsChecker(OutOfBoundsParameter& out) : out_(out) {}

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
    out_.names.at(out_.prefix_count++) = prefix;
    Params::fields(params, *this);
    if (out_.status.ok()) --out_.prefix_count;
  }

 private:
  void check(double value, const Field& field);

  OutOfBoundsParameter& out_;
};

void throw_if_out_of_bounds(const OutOfBoundsParameter& found);

}  // namespace detail

/// Returns `out_of_range` with the name, value and bound of the first invalid parameter of `params`, or `ok`. The
/// returned name of a nested parameter lacks the prefix of its group. No memory is allocated.
template <class Params>
Status check_fields(const Params& params) {
  detail::OutOfBoundsParameter found;
  detail::BoundsChecker visitor(found);
  Params::fields(params, visitor);
  return found.status;
}

template <class Params>
void require_valid_fields(const Params& params) {
  detail::OutOfBoundsParameter found;
  detail::BoundsChecker visitor(found);
  Params::fields(params, visitor);
  detail::throw_if_out_of_bounds(found);
}

}  // namespace tumble
