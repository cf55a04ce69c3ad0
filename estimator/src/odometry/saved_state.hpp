// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "../common/state_bytes.hpp"
#include "../common/state_layout.hpp"
#include "../common/state_params.hpp"

/// saved_state.hpp saves and loads odometry objects and states of streams. All saved numbers are little-endian.
///
/// The bytes are:
///
/// | bytes | |
/// | --- | --- |
/// | 0 | "tumblest" |
/// | 8 | version of the format, 4 bytes |
/// | 12 | class: SavedKind, 4 bytes |
/// | 16 | digest of names, widths and order of all members (StateLayout) |
/// | 24 | number of bytes from 40 on |
/// | 32 | checksum of all other bytes |
/// | 40 | the parameters, then the state, as StateWriter writes them |
///
/// A library can load a saved state only if its members have the same names, widths and order. A new member therefore
/// changes the digest. If the meaning of a member changes without a change of layout, the version of the format must
/// change.
namespace tumble::odometry {

enum class SavedKind : std::uint32_t {
  tumbling = 1,
  rolling,
  rate_stream,
  regime_stream,
  carried_stream,
  carried_live,
  rolling_filter,
  rolling_smoother,
  map
};
inline constexpr std::uint32_t kSavedVersion = 1;
inline constexpr std::size_t kSavedHeader = 40;

/// Writes the header to the first kSavedHeader bytes of `bytes`, which are reserved for it.
void seal(SavedKind kind, std::uint64_t layout, std::vector<std::byte>& bytes);
/// Checks the header of a saved state and returns the bytes after it.
Status open(SavedKind kind, std::uint64_t layout, std::span<const std::byte> bytes,
            std::span<const std::byte>& payload);

/// Saves the object `whole`, an odometry object or the state of a stream, with its parameters.
template <class Whole, class Params>
std::uint64_t layout_of(const Whole& whole, const Params& params) {
  StateLayout layout;
  visit_params(params, layout);
  layout("state", whole);
  return layout.digest();
}

template <class Whole, class Params>
std::vector<std::byte> save(SavedKind kind, const Whole& whole, const Params& params) {
  std::vector<std::byte> bytes(kSavedHeader);
  StateWriter out(bytes);
  visit_params(params, out);
  out("state", whole);
  seal(kind, layout_of(whole, params), bytes);
  return bytes;
}

/// Loads a saved state into an object that was created with the saved parameters. After an error, the caller must
/// discard the object.
template <class Whole, class Params>
Status load(SavedKind kind, std::span<const std::byte> bytes, const Params& params, Whole& whole) {
  std::span<const std::byte> payload;
  const Status opened = open(kind, layout_of(std::as_const(whole), params), bytes, payload);
  if (!opened.ok()) return opened;
  StateMatcher given(payload);
  visit_params(params, given);
  if (!given.status().ok()) return given.status();
  StateReader in(given.left());
  in("state", whole);
  in.require("number of bytes after the saved state", in.left().empty(), double(in.left().size()), 0.0);
  return in.status();
}

/// Reads only the parameters of a saved state. `params` may have any valid values; `whole` must have been created with
/// `params`. On error, `params` is unchanged.
template <class Whole, class Params>
Status load_params(SavedKind kind, std::span<const std::byte> bytes, const Whole& whole, Params& params) {
  std::span<const std::byte> payload;
  const Status opened = open(kind, layout_of(whole, std::as_const(params)), bytes, payload);
  if (!opened.ok()) return opened;
  StateReader in(payload);
  Params read = params;
  visit_params(read, in);
  if (in.status().ok()) params = read;
  return in.status();
}

}  // namespace tumble::odometry
