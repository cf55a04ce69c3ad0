// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "tumble/rolling/rolling_filter.hpp"

namespace online {

/// The pose of a rolling sphere, one line of text out for each line in. All memory is set aside by the constructor;
/// `take` allocates nothing.
class Online {
 public:
  static constexpr std::size_t kLineMax = 512;  ///< of either kind, without its end

  /// Throws tumble::InvalidParams.
  explicit Online(const tumble::RollingParams& params);

  /// Takes a line "time_ns wx wy wz fx fy fz" (rad/s, m/s^2, sensor axes) and gives "time_ns x y z qx qy qz qw mode
  /// sigma_m [uncertain]" (centre of the sphere in W, sensor axes to W, horizontal sigma), or what was wrong with the
  /// line, when ok() is false: then the sample is left out and the next may follow. Empty for an empty line and for a
  /// comment (#). The view is into this object and good until the next call.
  std::string_view take(std::string_view line);
  bool ok() const { return ok_; }
  std::uint64_t samples() const { return samples_; }

 private:
  std::string_view pose();
  std::string_view trouble(std::string_view what);

  tumble::RollingFilter filter_;
  std::unique_ptr<tumble::RollingFilter::State> state_;
  char text_[kLineMax];
  bool ok_ = true;
  std::uint64_t samples_ = 0;
};

}  // namespace online
