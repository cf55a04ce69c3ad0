// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>

#include "state_bytes.hpp"
#include "state_visitor.hpp"
#include "tumble/common/status.hpp"

/// state_layout.hpp checks that saved bytes match given parameters and a given layout of the state.
namespace tumble {

/// StateMatcher compares the visited members of a state with saved bytes. At the first difference, StateMatcher reports
/// `out_of_range` with the member's name, the saved number and the member's number. StateMatcher reports `too_few` if
/// the bytes end early.
class StateMatcher : public StateVisitor<StateMatcher> {
 public:
  static constexpr bool kReads = false;
  static constexpr bool kDescribes = false;

  explicit StateMatcher(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class N>
  void numbers(const char* name, const N* data, std::size_t count) {
    for (std::size_t k = 0; k < count && going(); ++k) match(name, data[k]);
  }
  std::size_t length(const char* name, std::size_t count) {
    match(name, static_cast<std::uint64_t>(count));
    return going() ? count : 0;
  }
  void bounded(const char*, double, double, double) {}
  bool going() const { return status_.ok(); }

  std::span<const std::byte> left() const { return left_; }
  const Status& status() const { return status_; }

 private:
  template <class N>
  void match(const char* name, N own) {
    using Saved = std::conditional_t<std::is_same_v<N, bool>, std::uint8_t, N>;
    Saved saved{};
    if (left_.size() < sizeof(N)) {
      status_ = {ErrorCode::too_few, name, static_cast<double>(left_.size()), static_cast<double>(sizeof(N))};
      return;
    }
    detail::copy_little_endian(left_.data(), reinterpret_cast<std::byte*>(&saved), 1, sizeof(N));
    left_ = left_.subspan(sizeof(N));
    if (std::memcmp(&saved, &own, sizeof(N)) != 0)
      status_ = {ErrorCode::out_of_range, name, static_cast<double>(saved), static_cast<double>(own)};
  }

  std::span<const std::byte> left_;
  Status status_;
};

/// StateLayout computes a 64-bit digest of the names, widths and order of a state's members. A reader rejects saved
/// bytes whose digest differs.
class StateLayout : public StateVisitor<StateLayout> {
 public:
  static constexpr bool kReads = false;
  static constexpr bool kDescribes = true;

  template <class N>
  void numbers(const char* name, const N* /*data*/, std::size_t count) {
    mix(name, sizeof(N) + (std::is_floating_point_v<N> ? 16 : 0), count);
  }
  std::size_t length(const char* name, std::size_t /*count*/) {
    mix(name, 0, 0);
    return 1;
  }
  void bounded(const char*, double, double, double) {}
  static constexpr bool going() { return true; }
  template <class T>
  requires requires(const T& value, StateLayout& out) { value.describe(out); }
  void whole(const char* name, const T& value) {
    mix(name, 0, 0);
    value.describe(*this);
  }

  std::uint64_t digest() const { return digest_; }

 private:
  void mix(std::string_view name, std::uint64_t kind, std::uint64_t count);

  std::uint64_t digest_ = 0xcbf29ce484222325u;
};

}  // namespace tumble
