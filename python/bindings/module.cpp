// SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/nanobind.h>

#include "bindings.hpp"
#include "parameters.hpp"
#include "results.hpp"
#include "trouble.hpp"

NB_MODULE(_tumble, m) {
  m.doc() = "The estimators of tumble. The package tumble exports everything in this module.";
  tumble::python::translate_invalid_params();
  tumble::python::bind_parameter(m);
  tumble::python::bind_results(m);
  tumble::python::bind_rails(m);
  tumble::python::bind_attitudes(m);
  tumble::python::bind_carried(m);
  tumble::python::bind_rates(m);
  tumble::python::bind_rolling(m);
  tumble::python::bind_mapping(m);
  tumble::python::bind_sheets(m);
  tumble::python::bind_tumbling(m);
  tumble::python::bind_adapters(m);
}
