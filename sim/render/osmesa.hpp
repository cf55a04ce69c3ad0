// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/osmesa.h>

namespace tumble::sim {

/// Functions of the library OSMesa, which is loaded when the first picture is rendered. Loading at program start would
/// make every start a third slower.
struct OsMesa {
  decltype(&::OSMesaCreateContextExt) create_context;
  decltype(&::OSMesaDestroyContext) destroy_context;
  decltype(&::OSMesaMakeCurrent) make_current;
};

/// Loads OSMesa with symbols that are visible to MuJoCo, which looks up OpenGL functions by name. Throws
/// std::runtime_error if loading fails; may be called from any thread.
const OsMesa& osmesa();

}  // namespace tumble::sim
