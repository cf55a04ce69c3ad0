// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Hash table from integer coordinates of a cube to a number; single keys cannot be removed.
class SpatialHash {
 public:
  static constexpr std::uint32_t kAbsentEntry = 0xffffffffu;
  static constexpr int kCoordinateLimit = 1 << 20;  ///< coordinates c: -kCoordinateLimit <= c < kCoordinateLimit

  static std::uint64_t key(const Eigen::Vector3i& cube) {
    const auto part = [](int v) { return static_cast<std::uint64_t>(v + kCoordinateLimit) & 0x1fffffu; };
    return part(cube.x()) | (part(cube.y()) << 21) | (part(cube.z()) << 42);
  }

  explicit SpatialHash(std::size_t expected = 64);

  /// Returns kAbsentEntry if the key is not stored.
  std::uint32_t find(std::uint64_t key) const {
    for (std::size_t slot = table_slot_of(key);; slot = (slot + 1) & mask_) {
      if (keys_[slot] == key) return values_[slot];
      if (keys_[slot] == kFree) return kAbsentEntry;
    }
  }

  /// Inserts a key if the key is new, and returns the stored value. Cost: amortised O(1).
  std::uint32_t insert(std::uint64_t key, std::uint32_t value);

  /// Inserts a key, and returns true if the key was new.
  bool add(std::uint64_t key);

  /// Removes all keys without freeing memory.
  void clear();
  std::size_t size() const { return size_; }
  std::size_t bytes() const {
    return keys_.capacity() * sizeof(std::uint64_t) + values_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};

  std::size_t table_slot_of(std::uint64_t key) const {
    // The eight cubes of a 2 x 2 x 2 block share a cache line, because successive queries are usually close together.
    constexpr std::uint64_t kInside = 1 | (std::uint64_t{1} << 21) | (std::uint64_t{1} << 42);
    const std::uint64_t block = key & ~kInside;
    const std::uint64_t hash = (block ^ (block >> 29)) * 0x9e3779b97f4a7c15u;
    const std::uint64_t inside = (key & 1) | ((key >> 20) & 2) | ((key >> 40) & 4);
    return static_cast<std::size_t>((hash >> hash_shift_bits_) ^ inside) & mask_;
  }
  void grow_table();

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
  std::size_t mask_ = 0;
  int hash_shift_bits_ = 0;
  std::size_t size_ = 0;
};

}  // namespace tumble

namespace tumble::mapping {

inline Eigen::Vector3i voxel_cube_of(const Eigen::Vector3f& p, float cubes_per_m) {
  return (p * cubes_per_m).array().floor().cast<int>();
}

}  // namespace tumble::mapping
