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
  void sort_by_ring(const std::vector<SweepPoint>& points);
  float median_step2(const std::vector<SweepPoint>& points);

  std::vector<std::uint32_t> ring_next_, order_;
  std::vector<float> steps2_;
  std::vector<std::uint8_t> alone_;
};

}  // namespace tumble
