// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <deque>
#include <optional>
#include <type_traits>
#include <vector>

/// state_kinds.hpp defines the kinds of state members that a StateVisitor (state_visitor.hpp) distinguishes.
namespace tumble {

/// StateOf is true if T is `Of` or const `Of`; the functions `members` and `others` constrain their first argument with
/// it.
template <class T, class Of>
concept StateOf = std::same_as<std::remove_const_t<T>, Of>;

namespace detail {

template <class T>
inline constexpr bool is_fixed_matrix = false;
template <class S, int R, int C, int O, int MR, int MC>
inline constexpr bool is_fixed_matrix<Eigen::Matrix<S, R, C, O, MR, MC>> = R > 0 && C > 0;

template <class T>
inline constexpr bool is_sequence = false;
template <class T, class A>
inline constexpr bool is_sequence<std::vector<T, A>> = true;
template <class T, class A>
inline constexpr bool is_sequence<std::deque<T, A>> = true;

template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

}  // namespace detail

}  // namespace tumble
