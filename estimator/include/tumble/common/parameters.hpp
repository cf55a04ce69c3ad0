// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "tumble/common/status.hpp"

/// Each `Params` struct describes its parameters once, in a static member function template `fields`. Range checks,
/// tables and file readers call `fields` with a visitor.
///
/// The declaration is `template <class Self, class Visitor> static void fields(Self& p, Visitor& visit)`. The template
/// argument `Self` may be a const type. `fields` calls `visit(p.member, ParameterInfo)` for each number, boolean,
/// enumeration and Vector3d of the struct. `fields` calls `visit.group("prefix_", p.member)` for each nested `Params`
/// struct. `fields` skips members that users do not enter as plain numbers, for example poses and calibrations.
namespace tumble {

/// Most users adapt only the parameters with the audience `common_use`.
enum class ParameterAudience : std::uint8_t { common_use, expert_use };

/// All strings in a ParameterInfo must have static lifetime.
struct ParameterInfo {
  const char* name;         ///< name with its unit as suffix, used in tables and messages
  const char* unit;         ///< unit; "1" if dimensionless
  double low, high;         ///< inclusive bounds; for a vector, of each coordinate
  const char* description;  ///< one sentence that states the parameter's effect and source
  ParameterAudience audience = ParameterAudience::expert_use;
};

inline ParameterInfo boolean_parameter(const char* name, const char* meaning,
                                       ParameterAudience audience = ParameterAudience::expert_use) {
  return {name, "1", 0.0, 1.0, meaning, audience};
}

/// Bound of a parameter without a limit: the largest finite number.
inline constexpr double kUnbounded = std::numeric_limits<double>::max();

/// The types of parameters that a visitor handles as numbers: arithmetic types and enumerations.
template <class T>
concept Number = std::is_arithmetic_v<std::remove_cvref_t<T>> || std::is_enum_v<std::remove_cvref_t<T>>;

namespace detail {

/// Describes the first invalid parameter of a struct. `names` contains the prefixes of the parameter's groups, and then
/// the name of the parameter.
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
  void operator()(const T& value, const ParameterInfo& field) {
    check(static_cast<double>(value), field);
  }
  void operator()(const Eigen::Vector3d& value, const ParameterInfo& field) {
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
  void check(double value, const ParameterInfo& field);

  OutOfBoundsParameter& out_;
};

void throw_if_out_of_bounds(const OutOfBoundsParameter& found);

}  // namespace detail

/// Throws InvalidParams with the name, value and bounds of the first invalid parameter of `params`.
template <class Params>
void require_valid_fields(const Params& params) {
  detail::OutOfBoundsParameter found;
  detail::BoundsChecker visitor(found);
  Params::fields(params, visitor);
  detail::throw_if_out_of_bounds(found);
}

namespace detail {

template <class Each>
class PrefixedNameVisitor {
 public:
  explicit PrefixedNameVisitor(Each& each) : callback_(each) {}

  template <class T>
  void operator()(T& value, const ParameterInfo& field) {
    callback_(prefix_ + field.name, value, field);
  }
  template <class Params>
  void group(const char* prefix, Params& params) {
    const std::string outer = prefix_;
    prefix_ += prefix;
    std::remove_cv_t<Params>::fields(params, *this);
    prefix_ = outer;
  }

 private:
  Each& callback_;
  std::string prefix_;
};

}  // namespace detail

/// Calls `each(name, value, field)` for each parameter in the struct `params`, in order of declaration. The argument
/// `name` of `each` is a std::string with the prefixes of the parameter's groups, followed by the parameter's name.
template <class Params, class Each>
void for_each_parameter(Params& params, Each each) {
  detail::PrefixedNameVisitor<Each> visitor(each);
  std::remove_cv_t<Params>::fields(params, visitor);
}

/// Returns true if `name` matches one of `patterns`. A pattern that ends in '*' matches every name that starts with the
/// text before the '*'. A pattern without '*' at its end matches only a name that is equal to the pattern.
template <class Text>
bool matches_any_pattern(std::string_view name, std::span<const Text> patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](std::string_view pattern) {
    if (!pattern.ends_with('*')) return name == pattern;
    return name.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

/// HeapValue stores a value on the heap. Copying a HeapValue copies the stored value, as for std::indirect of C++26. A
/// constant HeapValue gives only constant access to the stored value. A class can have a member HeapValue<T> for an
/// incomplete type T, if the header declares `extern template class HeapValue<T>`. Only the source file that
/// instantiates HeapValue<T> explicitly needs the complete type T. A moved-from HeapValue has no value until a new
/// value is assigned.
template <class T>
class HeapValue {
 public:
  HeapValue();
  explicit HeapValue(std::unique_ptr<T> value);
  HeapValue(const HeapValue& other);
  HeapValue(HeapValue&& other) noexcept;
  HeapValue& operator=(const HeapValue& other);
  HeapValue& operator=(HeapValue&& other) noexcept;
  ~HeapValue();

  T& operator*() { return *value_; }
  const T& operator*() const { return *value_; }
  T* operator->() { return value_.get(); }
  const T* operator->() const { return value_.get(); }

 private:
  std::unique_ptr<T> value_;
};

// The member functions of HeapValue are not inline, because an `extern template` declaration does not prevent the
// instantiation of inline functions. Instantiating the member functions of HeapValue<T> requires the complete type T.
template <class T>
HeapValue<T>::HeapValue() : value_(std::make_unique<T>()) {}
template <class T>
HeapValue<T>::HeapValue(std::unique_ptr<T> value) : value_(std::move(value)) {}
template <class T>
HeapValue<T>::HeapValue(const HeapValue& other) : value_(std::make_unique<T>(*other.value_)) {}
template <class T>
HeapValue<T>::HeapValue(HeapValue&& other) noexcept : value_(std::move(other.value_)) {}
template <class T>
HeapValue<T>& HeapValue<T>::operator=(const HeapValue& other) {
  return *this = HeapValue(other);
}
template <class T>
HeapValue<T>& HeapValue<T>::operator=(HeapValue&& other) noexcept {
  value_ = std::move(other.value_);
  return *this;
}
template <class T>
HeapValue<T>::~HeapValue() = default;

}  // namespace tumble
