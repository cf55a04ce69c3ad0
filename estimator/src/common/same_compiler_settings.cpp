// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/same_compiler_settings.hpp"

namespace tumble::detail {

template <>
const char CompiledHere::link_time_check = 0;

}  // namespace tumble::detail
