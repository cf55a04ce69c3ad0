// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::sim {

/// Long undulation of the ground: a sum of plane waves in random directions, wavelengths log-uniform between the two
/// given, amplitude in proportion to the wavelength, scaled to the given root mean square (over phases).
class Undulation {
 public:
  Undulation(Stream& stream, double rms_m, double shortest_m, double longest_m);
  double height_m(double x_m, double y_m) const;

 private:
  struct Wave {
    double kx, ky, phase, amplitude_m;
  };
  std::vector<Wave> waves_;
};

/// Bumps and hollows of Gaussian shape, strewn evenly over the square |x|, |y| < half_extent_m.
class Bumps {
 public:
  /// Heights uniform in +-height_m, standard deviations of the shape uniform in [0.2, 0.7] m (0.5 to 1.6 m wide at half
  /// height).
  Bumps(Stream& stream, int count, double height_m, double half_extent_m);
  /// Adds the bumps to a grid of `side` by `side` heights, `cell_m` apart, centred on the origin, rows along y.
  void add_to(std::vector<double>& grid_m, int side, double cell_m) const;

 private:
  struct Bump {
    double x_m, y_m, height_m, sigma_m;
  };
  std::vector<Bump> bumps_;
};

}  // namespace tumble::sim
