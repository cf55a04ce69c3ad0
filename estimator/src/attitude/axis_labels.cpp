// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/axis_labels.hpp"

#include <cstddef>

namespace tumble {

namespace {

constexpr std::array<std::array<int, 3>, 6> kOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

constexpr std::array<AxisLabels, kAxisLabels> all() {
  std::array<AxisLabels, kAxisLabels> out;
  std::size_t k = 0;
  for (const bool gyro_flipped : {false, true}) {
    for (const std::array<int, 3>& order : kOrders) {
      for (const double second : {1.0, -1.0}) {
        for (const double third : {1.0, -1.0}) out[k++] = {order, {1.0, second, third}, gyro_flipped};
      }
    }
  }
  return out;
}

constexpr std::array<AxisLabels, kAxisLabels> kAll = all();

}  // namespace

const std::array<AxisLabels, kAxisLabels>& axis_labels() {
  return kAll;
}

}  // namespace tumble
