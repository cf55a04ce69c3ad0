// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <GL/osmesa.h>

namespace tumble::sim {

/// Private to sim: what pictures need of OSMesa, which is loaded when the first one is drawn. It brings LLVM with it,
/// and a program that begins with it starts a third later, whatever it does (docs/figures.md).
struct OsMesa {
  decltype(&::OSMesaCreateContextExt) create_context;
  decltype(&::OSMesaDestroyContext) destroy_context;
  decltype(&::OSMesaMakeCurrent) make_current;
};

/// Loaded once, for the life of the process; its names are then seen by the engine, which asks for OpenGL by name.
/// Throws std::runtime_error when it cannot be loaded. From any thread.
const OsMesa& osmesa();

}  // namespace tumble::sim
