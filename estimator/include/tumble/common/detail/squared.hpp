// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

inline double squared(double x) {
  return x * x;
}

}  // namespace tumble
