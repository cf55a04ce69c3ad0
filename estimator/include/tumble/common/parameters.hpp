// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "tumble/common/status.hpp"

/// What there is to know of each number of a `Params`, stated once: checks, tables, reading and comparing are visitors.
///
/// A `Params` has `template <class Self, class Visitor> static void fields(Self& p, Visitor& visit)`, which calls
/// `visit(p.member, Field)` for each double, int, std::size_t, bool, enumeration (by its number) and Vector3d, and
/// `visit.group("prefix_", p.member)` for each `Params` within. Self may be const. What is no number that a user sets
/// (poses, planes, what was learnt before) is no field. Relations between fields are checked beside: a Field's bounds
/// are numbers.
namespace tumble {

/// Which numbers a listing shows first: those that a user sets before others.
enum class Rank : std::uint8_t { first, further };

/// One number of a `Params`. All texts are static.
struct Field {
  const char* name;     ///< ends in its unit where it has one; stands in tables, suites and messages
  const char* unit;     ///< "1" when dimensionless
  double low, high;     ///< bounds, both included; of a vector: of each coordinate
  const char* meaning;  ///< one sentence: effect, source
  Rank rank = Rank::further;
};

/// Of a Field that is on or off.
inline Field on_off(const char* name, const char* meaning, Rank rank = Rank::further) {
  return {name, "1", 0.0, 1.0, meaning, rank};
}

/// Where no bound is known beside that of being finite.
inline constexpr double kUnbounded = std::numeric_limits<double>::max();

/// What a visitor is given as a number: not a vector, not a `Params`.
template <class T>
concept Number = std::is_arithmetic_v<std::remove_cvref_t<T>> || std::is_enum_v<std::remove_cvref_t<T>>;

namespace detail {

/// The first field that is out of its bounds. `names` are the prefixes of the groups about it and its own.
struct OutOfBounds {
  std::array<const char*, 8> names{};
  std::size_t depth = 0;
  double low = 0.0, high = 0.0;  ///< the bounds that it broke
  Status status;
};

/// Visits until a field is out of its bounds (NaN is). Does not allocate.
class FindOutOfBounds {
 public:
  explicit FindOutOfBounds(OutOfBounds& out) : out_(out) {}

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

/// Throws InvalidParams, with the field's whole name, unless `found` is empty.
void throw_if(const OutOfBounds& found);

}  // namespace detail

/// `out_of_range` with name, value and bound of the first field of `params` that is out of its bounds; `ok` when none
/// is. Of a field of a group the name is without the group's prefix. Does not allocate.
template <class Params>
Status check_fields(const Params& params) {
  detail::OutOfBounds found;
  detail::FindOutOfBounds visitor(found);
  Params::fields(params, visitor);
  return found.status;
}

/// Throws InvalidParams for the first field of `params` that is out of its bounds.
template <class Params>
void require_fields(const Params& params) {
  detail::OutOfBounds found;
  detail::FindOutOfBounds visitor(found);
  Params::fields(params, visitor);
  detail::throw_if(found);
}

}  // namespace tumble
