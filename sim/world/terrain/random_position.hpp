// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "sim/parameters.hpp"
#include "sim/random/stream.hpp"

namespace tumble::sim {

struct Rectangle {
  double low_x_m = 0.0, high_x_m = 0.0, low_y_m = 0.0, high_y_m = 0.0;
};

struct Disc {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

template <typename Fits>
Eigen::Vector2d draw_position(Stream& stream, const Rectangle& area, const char* what, Fits fits) {
  constexpr int kAttempts = 1000;
  for (int i = 0; i < kAttempts; ++i) {
    const double x_m = stream.uniform(area.low_x_m, area.high_x_m);
    const Eigen::Vector2d at(x_m, stream.uniform(area.low_y_m, area.high_y_m));
    if (fits(at)) return at;
  }
  throw InvalidSituation(std::string("world: the area has no space left; reduce the number of objects of the kind ") +
                         what);
}

}  // namespace tumble::sim
