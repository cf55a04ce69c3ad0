// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_model.hpp"

namespace tumble {

template struct BlockArrowSystem<hand_held::kBlockSize, hand_held::kBorderSize>;

}  // namespace tumble
