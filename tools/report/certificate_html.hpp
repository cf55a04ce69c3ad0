// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::tools {

/// "31 of 31 figures within their bounds"; "none" without entries.
std::string certificate_summary(const scenarios::Certificate& certificate);

/// A table per certificate: what was measured, on what, value, bound, verdict, and the law that it is held to.
std::string certificates_html(std::span<const scenarios::Certificate> certificates);

}  // namespace tumble::tools
