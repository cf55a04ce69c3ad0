// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

/// What each source binds into the module, in this order: later ones name classes of earlier ones.
namespace tumble::python {

void bind_rails(nanobind::module_& m);
void bind_attitudes(nanobind::module_& m);
void bind_carried(nanobind::module_& m);
void bind_rates(nanobind::module_& m);
void bind_rolling(nanobind::module_& m);
void bind_mapping(nanobind::module_& m);
void bind_sheets(nanobind::module_& m);
void bind_tumbling(nanobind::module_& m);

}  // namespace tumble::python
