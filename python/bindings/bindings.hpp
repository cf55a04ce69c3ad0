// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

/// Each function below binds the classes of one source file. The calls keep this order, because later sources use
/// classes of earlier sources.
namespace tumble::python {

void bind_rails(nanobind::module_& m);
void bind_attitudes(nanobind::module_& m);
void bind_carried(nanobind::module_& m);
void bind_rates(nanobind::module_& m);
void bind_rolling(nanobind::module_& m);
void bind_mapping(nanobind::module_& m);
void bind_sheets(nanobind::module_& m);
void bind_tumbling(nanobind::module_& m);
void bind_adapters(nanobind::module_& m);

}  // namespace tumble::python
