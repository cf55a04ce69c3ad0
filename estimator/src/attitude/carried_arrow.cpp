// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/carried_model.hpp"

namespace tumble {

// explicit instantiation that all files of the hand-held motion smoother share
template struct ArrowSystem<carried::kState, carried::kBorder>;

}  // namespace tumble
