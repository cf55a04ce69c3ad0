// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/carried_model.hpp"

namespace tumble {

// This explicit instantiation serves all files of the smoother for hand-held motion.
template struct ArrowSystem<carried::kState, carried::kBorder>;

}  // namespace tumble
