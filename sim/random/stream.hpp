// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tumble::sim {

/// An independent stream of random numbers, named: `Stream(seed, "imu.noise")`. Counter-based (Philox 4x32-10, Salmon
/// et al., SC 2011), so the n-th number can be had without the ones before it, and results depend neither on threads
/// nor on order. Distributions are our own: the standard library's differ between vendors.
class Stream {
 public:
  Stream(std::uint64_t seed, std::string_view name);

  /// 128 bits that belong to (seed, name, index). Pure.
  std::array<std::uint32_t, 4> block(std::uint64_t index) const;
  /// Two standard normal numbers that belong to (seed, name, index). Pure.
  std::array<double, 2> normal_pair(std::uint64_t index) const;

  /// Next number of the sequence.
  std::uint64_t bits();
  double uniform();  ///< in [0, 1)
  double uniform(double low, double high);
  double normal();  ///< mean 0, standard deviation 1

 private:
  std::uint32_t key_[2];
  std::uint64_t next_ = 0;
  std::array<std::uint32_t, 4> buffer_{};
  int left_ = 0;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace tumble::sim
