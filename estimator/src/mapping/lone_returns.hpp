// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/mapping/deskew.hpp"

namespace tumble {

/// RangeNoise is the standard deviation of a range: the larger of a length and a fraction of the range.
struct RangeNoise {
  double sigma_m, share;
};

/// Detects lone returns, which no neighbouring beam confirms: dust, rain, snow, blades of grass, birds.
///
/// A surface reflects many neighbouring beams. A neighbour on the same ring of the lidar confirms a return in one of
/// three ways. First, the range of one of the two returns before or after is equal within noise. Second, the line to an
/// adjacent return is steep enough against the beam to be a surface (Bogoslavskyi and Stachniss, IROS 2016). Third, the
/// return is on the line between a return before and a return after, as on ground at a grazing angle. See mapping.md
/// (R13), (R14), (R15). Neighbours are within the angular step of the sweep, so a return among misses is a lone return.
/// All returns are kept if successive returns are too far apart to be compared. All returns are also kept if the number
/// of lone returns is not larger than in clear air. Returns of larger moving objects (people, cars) are not lone
/// returns.
class LoneReturns {
 public:
  /// Removes the lone returns from `points` and returns their number. Cost: O(number of points). The remaining points
  /// are in firing order per ring. Memory is allocated only for a sweep larger than all earlier sweeps.
  std::size_t drop(const RangeNoise& noise, std::vector<SweepPoint>& points);

 private:
  /// Beam contains the data of a return for the comparison of neighbours; beams are contiguous per ring.
  struct Beam {
    Eigen::Vector3f point_L_m;
    float range_m;
    std::uint16_t ring;
  };
  struct Beside;

  static float sine2_between(const Beam& a, const Beam& b);
  static float variance_m2(const RangeNoise& noise, const Beam& beam);
  static bool same_range(const RangeNoise& noise, const Beam& a, const Beam& b);
  static bool is_steep_surface(float sine, const Beam& a, const Beam& b);
  static bool between(const RangeNoise& noise, const Beam& before, const Beam& beam, const Beam& after);
  void sort_by_ring(const std::vector<SweepPoint>& points);
  void measure_steps();
  float median_step2();
  bool is_neighbour(std::size_t at, std::size_t other, float reach2) const;
  bool is_confirmed(const RangeNoise& noise, std::size_t at, float reach2) const;

  std::vector<std::uint32_t> ring_next_, order_;
  std::vector<Beam> beams_;                    // beams ring by ring, in firing order
  std::vector<float> steps2_, sorted_steps2_;  // squared sines of the angle between successive beams on a ring
  std::vector<std::uint8_t> isolated_;
};

}  // namespace tumble
