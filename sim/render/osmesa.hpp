// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/osmesa.h>

namespace tumble::sim {

/// OsMesa contains functions of the library OSMesa, which is loaded when the first picture is rendered. If OSMesa were
/// loaded at program start, every start would take a third longer.
struct OsMesa {
  decltype(&::OSMesaCreateContextExt) create_context;
  decltype(&::OSMesaDestroyContext) destroy_context;
  decltype(&::OSMesaMakeCurrent) make_current;
};

/// Loads OSMesa such that its symbols are visible to MuJoCo, because MuJoCo searches OpenGL functions by name. Throws
/// std::runtime_error if loading fails. The function may be called from any thread.
const OsMesa& osmesa();

}  // namespace tumble::sim
