// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tumble::sim {

/// Stream is a counter-based stream of random numbers (Philox 4x32-10, Salmon et al., SC 2011). Each number depends
/// only on its index in the stream, and not on threads or order. Distributions are implemented here, because the
/// distributions of different standard libraries give different numbers.
class Stream {
 public:
  Stream(std::uint64_t seed, std::string_view name);

  std::array<std::uint32_t, 4> block(std::uint64_t index) const;
  std::array<double, 2> normal_pair(std::uint64_t index) const;

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
