// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "state_visitor.hpp"
#include "tumble/common/status.hpp"

/// state_bytes.hpp serialises an estimator's state as numbers of fixed width, little-endian on every machine. The bytes
/// of a sequence start with its length (8 bytes), followed by its elements.
namespace tumble {

/// Returns the 64-bit checksum FNV-1a (Fowler, Noll and Vo, RFC 9923), which changes if a single byte changes. The
/// checksum detects accidental damage, not manipulation.
std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t before = 0xcbf29ce484222325u);

namespace detail {

static_assert(sizeof(std::size_t) == 8 && sizeof(int) == 4, "saved states need a 64-bit machine");

/// Converts numbers between memory order and little-endian, in either direction.
void copy_little_endian(const std::byte* from, std::byte* to, std::size_t count, std::size_t width);

}  // namespace detail

class StateWriter : public StateVisitor<StateWriter> {
 public:
  static constexpr bool kReads = false;
  static constexpr bool kDescribes = false;

  explicit StateWriter(std::vector<std::byte>& out) : out_(out) {}

  template <class N>
  void numbers(const char* /*name*/, const N* data, std::size_t count) {
    const std::size_t at = out_.size();
    out_.resize(at + count * sizeof(N));
    detail::copy_little_endian(reinterpret_cast<const std::byte*>(data), out_.data() + at, count, sizeof(N));
  }
  std::size_t length(const char* name, std::size_t count) {
    const std::uint64_t written = count;
    numbers(name, &written, 1);
    return count;
  }
  void bounded(const char*, double, double, double) {}
  static constexpr bool going() { return true; }
  template <class T>
  requires requires(const T& value, StateWriter& out) { value.save(out); }
  void whole(const char* /*name*/, const T& value) { value.save(*this); }

 private:
  std::vector<std::byte>& out_;
};

/// StateReader reads states from untrusted bytes. After the first error, StateReader stops reading, and status()
/// returns the error. The values read so far are then invalid. The possible errors are `too_few` (the bytes end within
/// `field`), `non_finite` and `out_of_range` (index, count, enumeration or length).
class StateReader : public StateVisitor<StateReader> {
 public:
  static constexpr bool kReads = true;
  static constexpr bool kDescribes = false;
  static constexpr double kCountMax = 1e9;    ///< largest count that fits into an int
  static constexpr double kTimeMax = 4.6e18;  ///< half of the range of 64 bits, so that differences do not overflow

  explicit StateReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class N>
  void numbers(const char* name, N* data, std::size_t count) {
    if (!take(name, reinterpret_cast<std::byte*>(data), count, sizeof(N), std::is_same_v<N, bool>)) return;
    for (std::size_t k = 0; k < count && going(); ++k) check(name, data[k]);
  }
  std::size_t length(const char* name, std::size_t /*of what is replaced*/);
  void bounded(const char* name, double value, double low, double high) {
    if (going() && !(value >= low && value <= high))
      status_ = {ErrorCode::out_of_range, name, value, value > high ? high : low};
  }
  bool going() const { return status_.ok(); }
  template <class T>
  requires requires(T& value, StateReader& in) { value.load(in); }
  void whole(const char* /*name*/, T& value) { value.load(*this); }

  /// Reports an error if `holds` is false, for a relation between members that is true in every saved state.
  void require(const char* name, bool holds, double value = 0.0, double bound = 1.0) {
    if (going() && !holds) status_ = {ErrorCode::out_of_range, name, value, bound};
  }
  void refuse(const Status& status) {
    if (going()) status_ = status;
  }

  std::span<const std::byte> left() const { return left_; }
  const Status& status() const { return status_; }

 private:
  bool take(const char* name, std::byte* to, std::size_t count, std::size_t width, bool are_bools);

  template <class N>
  void check(const char* name, N value) {
    if constexpr (std::is_floating_point_v<N>) {
      if (!nan_allowed() && !std::isfinite(value))
        status_ = {ErrorCode::non_finite, name, static_cast<double>(value), std::numeric_limits<double>::max()};
    } else if constexpr (std::is_same_v<N, int>) {
      bounded(name, value, -kCountMax, kCountMax);
    } else if constexpr (std::is_same_v<N, std::int64_t>) {
      bounded(name, static_cast<double>(value), -kTimeMax, kTimeMax);
    }
  }

  std::span<const std::byte> left_;
  Status status_;
};

}  // namespace tumble
