// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/osmesa.h>

namespace tumble::sim {

/// OsMesa contains the functions of the library OSMesa, which is loaded when the first picture is rendered. Loading
/// OSMesa (with LLVM) at the start would make the start of every program a third longer (docs/figures.md).
struct OsMesa {
  decltype(&::OSMesaCreateContextExt) create_context;
  decltype(&::OSMesaDestroyContext) destroy_context;
  decltype(&::OSMesaMakeCurrent) make_current;
};

/// Loads OSMesa once for the life of the process, and returns its functions. The symbols of OSMesa are then visible to
/// MuJoCo, which looks up OpenGL functions by name. Throws std::runtime_error if loading fails. The function may be
/// called from any thread.
const OsMesa& osmesa();

}  // namespace tumble::sim
