// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// What the rails of an IMU are known to be.
struct KnownRails {
  RailDetector::State upright_rails;  ///< levels of equal readings, stated ranges
  RailPlanes planes;                  ///< of the gyro's elements, where they were seen
  RailPlanes accel_planes;            ///< of the accelerometer's
  bool upright = false;               ///< the device clips what it delivers: nothing is off on the axes beside
  bool accel_upright = false;         ///< the same of the accelerometer

  /// The planes by which readings are judged: where rails are upright equal readings tell them to the bit, and planes
  /// what else there is.
  RailPlanes planes_in_use(Triad triad = Triad::gyro) const;
  /// Along what the elements sense; `unknown_sigma` is the deviation of slopes that no rail has told.
  ElementRows rows(Triad triad, double unknown_sigma) const;
  bool operator==(const KnownRails&) const = default;
};

/// What the reading of one element is worth.
enum class ElementReading : std::uint8_t {
  measured,
  clipped_high,  ///< a bound: the truth along the element's row lies there or beyond
  clipped_low,
  unreadable  ///< says nothing
};
/// Of element `axis` of a judged sample.
ElementReading element_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis);

/// Flags of a judged sample, ClipFlag bits: what readings the device itself should have flagged.
std::uint8_t clip_flags(const Clipping& clipping);

/// The rails of a unit that may freeze, as those beside it have to hear of them. Equal readings alone are no rail: flat
/// tops of a slow motion far below a stated range are not heard, nor what repeats where none is stated. Planes are,
/// which know neither.
struct HeardRails {
  RailPlanes gyro, accel;                                 ///< in use
  double gyro_range_rad_s = 0.0, accel_range_m_s2 = 0.0;  ///< stated; 0: not
  /// Of a judged sample, beside the flags of its own.
  std::uint8_t flags(const ImuSample& sample, const Clipping& judged) const;
};

/// Finds which readings of a recording are clipped: the one judgement for all that reads recordings, from what the
/// device flags, levels of equal readings (RailDetector) and tilted planes (RailPlaneFinder), of gyro and
/// accelerometer. RateStream judges its window by the same rails and rules (RailWatch).
class ClippingFinder {
 public:
  struct Params {
    RailDetector::Params upright_rails = {};
    RailPlaneFinder::Params planes = {};  ///< without a stated range of its own: that of `upright_rails`
    RailPlaneFinder::Params accel_planes = RailPlaneFinder::Params::for_accelerometer();  ///< likewise
    /// False: by flags and upright rails alone, as methods were published that know no other rail.
    bool tilted = true;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.upright_rails);
      visit.group("planes_", p.planes);
      visit.group("accel_planes_", p.accel_planes);
      visit(
          p.tilted,
          on_off("tilted",
                 "0: search upright rails and device flags only, for methods that were published without other rails"));
    }
  };
  struct Found {
    KnownRails rails;
    std::vector<Clipping> clippings;  ///< one per sample
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit ClippingFinder(const Params& params);

  /// Samples must be finite and in order of time. O(N) apart from the search of RailPlaneFinder.
  Found find(std::span<const ImuSample> samples) const;

  const RailDetector& upright_rails() const { return upright_rails_; }

 private:
  RailPlanes find_planes(std::span<const ImuSample> samples, Triad triad, const RailDetector::State& upright_rails,
                         bool& upright) const;

  RailDetector upright_rails_;
  // of gyro and accelerometer; the second of each where readings contradict the stated range
  std::array<std::array<RailPlaneFinder, 2>, 2> planes_;
  bool tilted_;
};

}  // namespace tumble
