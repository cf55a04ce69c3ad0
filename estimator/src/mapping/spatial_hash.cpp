// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/spatial_hash.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

namespace tumble {

SpatialHash::SpatialHash(std::size_t expected) {
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(2 * expected, 16));
  keys_.assign(slots, kFree);
  values_.assign(slots, 0);
  mask_ = slots - 1;
  hash_shift_bits_ = 64 - std::countr_zero(slots);
}

std::uint32_t SpatialHash::insert(std::uint64_t key, std::uint32_t value) {
  // The hash table is at most half full, because a fuller table would have longer chains of collisions.
  if (2 * (size_ + 1) > keys_.size()) grow_table();
  std::size_t slot = table_slot_of(key);
  for (; keys_[slot] != kFree; slot = (slot + 1) & mask_) {
    if (keys_[slot] == key) return values_[slot];
  }
  keys_[slot] = key;
  values_[slot] = value;
  ++size_;
  return value;
}

bool SpatialHash::add(std::uint64_t key) {
  if (2 * (size_ + 1) > keys_.size()) grow_table();
  std::size_t slot = table_slot_of(key);
  for (; keys_[slot] != kFree; slot = (slot + 1) & mask_) {
    if (keys_[slot] == key) return false;
  }
  keys_[slot] = key;
  values_[slot] = 0;
  ++size_;
  return true;
}

void SpatialHash::clear() {
  std::fill(keys_.begin(), keys_.end(), kFree);
  size_ = 0;
}

void SpatialHash::grow_table() {
  SpatialHash larger(keys_.size());
  for (std::size_t slot = 0; slot < keys_.size(); ++slot) {
    if (keys_[slot] != kFree) larger.insert(keys_[slot], values_[slot]);
  }
  *this = std::move(larger);
}

}  // namespace tumble
