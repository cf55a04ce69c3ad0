// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/osmesa.h>

namespace tumble::sim {

/// The library OSMesa is loaded when the first picture is rendered. Loading OSMesa and LLVM at the start would make the
/// start of every program a third longer.
struct OsMesa {
  decltype(&::OSMesaCreateContextExt) create_context;
  decltype(&::OSMesaDestroyContext) destroy_context;
  decltype(&::OSMesaMakeCurrent) make_current;
};

/// The symbols of OSMesa must be visible to MuJoCo, which looks up OpenGL functions by name. Throws std::runtime_error
/// if loading fails; may be called from any thread.
const OsMesa& osmesa();

}  // namespace tumble::sim
