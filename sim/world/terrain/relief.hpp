// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/random/stream.hpp"
#include "sim/world/terrain/ground.hpp"

namespace tumble::sim {

/// ReliefSpectrum is the spectrum of a rough surface. The power per wave number k, summed over all directions, is
/// proportional to k^-exponent for wavelengths from shortest_m to longest_m, and zero otherwise.
struct ReliefSpectrum {
  double rms_m = 0.1;
  double shortest_m = 1.0;  ///< above 0
  double longest_m = 9.0;   ///< at least shortest_m
  double exponent = 3.0;    ///< 3: amplitude proportional to wavelength
  bool ruled = false;       ///< the height depends only on x
};

/// Relief is a random surface: a sum of plane waves with random phases and directions, and log-uniform wavelengths.
class Relief {
 public:
  Relief(Stream& stream, const ReliefSpectrum& spectrum);
  double height_m(double x_m, double y_m) const;

 private:
  struct Wave {
    double kx, ky, phase, amplitude_m;
  };
  std::vector<Wave> waves_;
};

/// Adds Gaussian bumps with random sizes. The heights of the bumps are uniform in +-height_m, and the widths (standard
/// deviations) are uniform in [0.2, 0.7] m.
void add_bumps(Ground& ground, Stream& stream, int count, double height_m);

}  // namespace tumble::sim
