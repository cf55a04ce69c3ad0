// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tumble/mapping/deskew.hpp"

namespace tumble {

/// Standard deviation of a range: the larger of a length and a share of the range.
struct RangeNoise {
  double sigma_m, share;
};

/// Returns of a sweep that nothing beside them bears out: dust, rain, snow, blades of grass, birds.
///
/// A surface returns many neighbouring beams. A return is borne out where one of the two before or after it on its ring
/// lies at the same range within the noise; or the next one so that the line between both stands steeply enough against
/// the beam to be a surface (I. Bogoslavskyi, C. Stachniss, IROS 2016); or where it lies on the line between one before
/// and one after it, as on ground seen at a grazing angle: mapping.md (R56), (R57), (R58). Neighbours are those within
/// the angular step of the sweep itself, so that a return amid misses stands alone. A sweep whose successive returns
/// are too far apart to say anything of each other keeps all, and so does one of which no more than a share are alone
/// that clear air has as well. What moves as a whole (people, cars) is no lone return.
class LoneReturns {
 public:
  /// Drops the lone ones from `points`, which keep their order: per ring that of firing. Returns how many there were.
  /// O(number of points); allocates only while a sweep is larger than those before.
  std::size_t drop(const RangeNoise& noise, std::vector<SweepPoint>& points);

 private:
  /// What is asked of a return; of a ring they lie side by side.
  struct Beam {
    Eigen::Vector3f x_L_m;
    float range_m;
    std::uint16_t ring;
  };
  struct Beside;

  static float sine2_between(const Beam& a, const Beam& b);
  static float variance_m2(const RangeNoise& noise, const Beam& beam);
  static bool same_range(const RangeNoise& noise, const Beam& a, const Beam& b);
  static bool stands(float sine, const Beam& a, const Beam& b);
  static bool between(const RangeNoise& noise, const Beam& before, const Beam& beam, const Beam& after);
  void sort_by_ring(const std::vector<SweepPoint>& points);
  void measure_steps();
  float median_step2();
  bool is_neighbour(std::size_t at, std::size_t other, float reach2) const;
  bool is_borne_out(const RangeNoise& noise, std::size_t at, float reach2) const;

  std::vector<std::uint32_t> ring_next_, order_;
  std::vector<Beam> beams_;                    // ring after ring, in order inside of each
  std::vector<float> steps2_, sorted_steps2_;  // squared sines from the beam before on the ring
  std::vector<std::uint8_t> alone_;
};

}  // namespace tumble
