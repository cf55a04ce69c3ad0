// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/range_errors.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::sim {

namespace {

constexpr double kTurn_rad = 6.283185307179586;
constexpr double kWord = 1.0 / 4294967296.0;
// a return whose uniform number lies below this is kept from the signal sure_signal_ on, without a power to compute
constexpr double kSure = 0.99;

/// In (0, 1): the middle of the 2^-32 wide cell that the word names.
double uniform_of(std::uint32_t word) {
  return (word + 0.5) * kWord;
}

double rounded(double value, double quantum) {
  return quantum > 0.0 ? quantum * std::nearbyint(value / quantum) : value;
}

}  // namespace

RangeErrors::RangeErrors(const Values& values, std::uint64_t seed, std::string_view stream_name)
    : stream_(seed, stream_name),
      noise_m_(values.at("range_noise_m")),
      quantum_m_(values.at("range_quantum_m")),
      min_m_(values.at("range_min_m")),
      max_m_(values.at("range_max_m")),
      detection2_m2_(values.at("detection_range_m") * values.at("detection_range_m")),
      reference_reflectivity_(values.at("detection_reflectivity")),
      steepness_(values.at("detection_steepness")),
      kept_share_(1.0 - values.at("dropout_share")),
      intensity_quantum_(values.at("intensity_quantum")),
      sure_signal_(std::pow(kSure / (1.0 - kSure), 1.0 / steepness_)) {}

bool RangeErrors::is_detected(const RayPacket& hits, int lane, double uniform) const {
  if (uniform >= kept_share_) return false;
  if (detection2_m2_ == 0.0) return true;
  // what is left of the uniform number after the random loss is uniform again
  const double u = uniform / kept_share_;
  const double range = hits.range[lane];
  const double signal =
      hits.reflectivity[lane] * hits.cosine[lane] / reference_reflectivity_ * detection2_m2_ / (range * range);
  if (u < kSure && signal >= sure_signal_) return true;
  const double odds = std::pow(signal, steepness_);
  return u * (1.0 + odds) < odds;
}

Returns RangeErrors::apply(const RayPacket& hits, std::int64_t slot) const {
  Returns out;
  for (int pair = 0; 2 * pair < hits.count; ++pair) {
    const int lane = 2 * pair;
    const bool any =
        hits.surface_id[lane] != kNothing || (lane + 1 < hits.count && hits.surface_id[lane + 1] != kNothing);
    out.kept[lane] = out.kept[lane + 1] = false;
    if (!any) continue;
    // slots start batches at most once, so that (slot, pair) names the block uniquely
    const auto block =
        stream_.block(static_cast<std::uint64_t>(slot) * (kLanes / 2) + static_cast<std::uint64_t>(pair));
    // Box and Muller 1958
    const double radius = noise_m_ * std::sqrt(-2.0 * std::log(uniform_of(block[0])));
    const double angle = kTurn_rad * uniform_of(block[1]);
    const double noise_m[2] = {radius * std::cos(angle), radius * std::sin(angle)};
    for (int i = 0; i < 2 && lane + i < hits.count; ++i) {
      const int at = lane + i;
      if (hits.surface_id[at] == kNothing || !is_detected(hits, at, uniform_of(block[2 + i]))) continue;
      const double measured = rounded(hits.range[at] + noise_m[i], quantum_m_);
      out.kept[at] = measured >= min_m_ && measured <= max_m_;
      out.range_m[at] = static_cast<float>(measured);
      const double strength = std::clamp<double>(hits.reflectivity[at] * hits.cosine[at], 0.0, 1.0);
      out.intensity[at] = static_cast<float>(rounded(strength, intensity_quantum_));
    }
  }
  return out;
}

}  // namespace tumble::sim
