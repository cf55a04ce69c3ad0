// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

inline const std::string kError = "rate_error_clipped_median_rad_s";  ///< lower is better

}  // namespace tumble::scenarios
