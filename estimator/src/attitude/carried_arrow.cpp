// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/carried_model.hpp"

namespace tumble {

// compiled once, for the files that solve the carried body's equations
template struct ArrowSystem<carried::kState, carried::kBorder>;

}  // namespace tumble
