// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_model.hpp"

namespace tumble {

// All files for hand-held motion share this explicit instantiation of ArrowSystem.
template struct ArrowSystem<hand_held::kBlockSize, hand_held::kBorderSize>;

}  // namespace tumble
