// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/carried_model.hpp"

namespace tumble {

// explicit instantiation for all files that solve the equations of hand-held motion
template struct ArrowSystem<carried::kState, carried::kBorder>;

}  // namespace tumble
