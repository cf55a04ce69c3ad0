// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <concepts>
#include <cstddef>
#include <type_traits>

#include "state_kinds.hpp"

/// One function lists the members of an estimator's state. Visitors of this list save, load and compare states.
///
/// The function is `members(Self& s, Visitor& visit)`, in the state's namespace or, for private members, a static
/// function of the class. `members` calls `visit("name", s.member)` for each member: numbers, fixed-size Eigen types,
/// arrays, vectors, deques, optionals and nested states. `members` visits indices and counts with their bounds, and
/// enumerations with their last value. `members` visits values that may be NaN by `with_nan`, and buffers by `scratch`.
/// The type `Self` may be const. The function `visit_params` visits a `Params` structure that is part of a state. The
/// function `others(Self& p, Visitor& visit)` visits the members of a `Params` structure that are not Fields.
namespace tumble {

/// StateVisitor visits the members of an estimator's state. A derived class must define the following members. The
/// function numbers(name, data, count) processes contiguous numbers. The function length(name, count) processes the
/// size of a sequence or an optional (0 or 1), and returns the size to use. The function bounded(name, value, low,
/// high) checks a number against its bounds. The function going() returns false to stop the visit. The optional
/// function whole(name, value) processes a member that serialises itself. The constant kReads is true if the visitor
/// overwrites the members. The constant kDescribes is true if a sequence is visited as one element in its initial
/// state.
template <class Derived>
class StateVisitor {
 public:
  template <class T>
  void operator()(const char* name, T& value) {
    if (!self().going()) return;
    using V = std::remove_const_t<T>;
    if constexpr (std::is_arithmetic_v<V>) {
      self().numbers(name, &value, 1);
    } else if constexpr (detail::is_fixed_matrix<V>) {
      self().numbers(name, value.data(), static_cast<std::size_t>(V::SizeAtCompileTime));
    } else if constexpr (std::same_as<V, Eigen::Quaterniond>) {
      self().numbers(name, value.coeffs().data(), 4);
    } else if constexpr (std::same_as<V, Eigen::Isometry3d>) {
      self().numbers(name, value.matrix().data(), 16);
    } else if constexpr (std::same_as<V, Eigen::AlignedBox3d>) {
      (*this)(name, value.min());
      (*this)(name, value.max());
    } else if constexpr (detail::is_array<V>) {
      for (auto& element : value) (*this)(name, element);
    } else if constexpr (detail::is_sequence<V>) {
      sequence(name, value);
    } else if constexpr (detail::is_optional<V>) {
      optional(name, value);
    } else if constexpr (requires { self().whole(name, value); }) {
      self().whole(name, value);
    } else if constexpr (requires { V::members(value, self()); }) {
      V::members(value, self());
    } else {
      static_assert(!std::is_enum_v<V>, "visit an enumeration together with its last value");
      members(value, self());
    }
  }

  /// Visits a member that is an index or a count, with its bounds.
  template <class T>
  void operator()(const char* name, T& value, double low, double high) {
    (*this)(name, value);
    self().bounded(name, static_cast<double>(value), low, high);
  }

  template <class T>
  requires std::is_enum_v<std::remove_const_t<T>>
  void operator()(const char* name, T& value, std::remove_const_t<T> last) {
    auto number = static_cast<std::underlying_type_t<std::remove_const_t<T>>>(value);
    (*this)(name, number, 0.0, static_cast<double>(last));
    if constexpr (Derived::kReads) value = static_cast<T>(number);
  }

  /// Visits the first `count` elements of an array. The remaining elements of the array keep their initial state.
  template <class Array>
  void leading(const char* name, Array& array, std::size_t count) {
    if (Derived::kDescribes) count = 1;
    for (std::size_t k = 0; k < count && k < array.size(); ++k) (*this)(name, array[k]);
  }

  /// Visits a floating-point value that may be NaN.
  template <class T>
  void with_nan(const char* name, T& value) {
    const bool before = nan_allowed_;
    nan_allowed_ = true;
    (*this)(name, value);
    nan_allowed_ = before;
  }

  /// Ignores a buffer, which is not part of the state.
  template <class T>
  void scratch(T& /*value*/) {}

 protected:
  bool nan_allowed() const { return nan_allowed_; }

 private:
  Derived& self() { return static_cast<Derived&>(*this); }

  template <class T>
  void sequence(const char* name, T& value) {
    using Element = typename std::remove_const_t<T>::value_type;
    const std::size_t count = self().length(name, value.size());
    if constexpr (Derived::kDescribes) {
      const Element element{};
      (*this)(name, element);
    } else if constexpr (!Derived::kReads) {
      for (const Element& element : value) (*this)(name, element);
    } else {
      value.clear();
      // visits elements one by one, so that no more memory is allocated than the saved bytes justify
      for (std::size_t k = 0; k < count && self().going(); ++k) (*this)(name, value.emplace_back());
    }
  }

  template <class T>
  void optional(const char* name, T& value) {
    const std::size_t held = self().length(name, value ? 1 : 0);
    self().bounded(name, static_cast<double>(held), 0.0, 1.0);
    const bool there = held == 1;
    if constexpr (Derived::kDescribes) {
      const typename std::remove_const_t<T>::value_type element{};
      (*this)(name, element);
    } else {
      if constexpr (Derived::kReads) {
        value.reset();
        if (there) value.emplace();
      }
      if (there) (*this)(name, *value);
    }
  }

  bool nan_allowed_ = false;
};

}  // namespace tumble
