// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "tumble/rolling/rolling_filter.hpp"

namespace online {

/// Online estimates the pose of a rolling sphere, with one line of text out for each line in. The constructor allocates
/// all memory; `take` allocates nothing.
class Online {
 public:
  static constexpr std::size_t kLineMax = 512;  ///< of either kind, without its end

  /// Throws tumble::InvalidParams.
  explicit Online(const tumble::RollingParams& params);

  /// Processes a line "time_ns wx wy wz fx fy fz" (rad/s, m/s^2, sensor axes) and returns "time_ns x y z qx qy qz qw
  /// mode sigma_m [uncertain]" (centre of the sphere in W, sensor axes to W, horizontal sigma). If ok() is false, the
  /// sample is left out and the result is the error message; the next sample may follow. The returned text is empty for
  /// an empty line and for a comment (#). The returned view refers to this object and is valid until the next call.
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
