// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_model.hpp"

namespace tumble {

// This explicit instantiation serves all files of the smoother for hand-held motion.
template struct ArrowSystem<hand_held::kBlockSize, hand_held::kBorderSize>;

}  // namespace tumble
