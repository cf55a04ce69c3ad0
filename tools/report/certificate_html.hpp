// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::tools {

/// Summarises a certificate, for example "31 of 31 figures within their bounds"; "none" without entries.
std::string certificate_summary(const scenarios::Certificate& certificate);

/// Returns one table per certificate: quantity and object, value, accepted range, verdict, and the law that defines the
/// range.
std::string certificates_html(std::span<const scenarios::Certificate> certificates);

}  // namespace tumble::tools
