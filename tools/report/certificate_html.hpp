// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/certificate/certificate.hpp"

namespace tumble::tools {

std::string certificate_summary(const scenarios::Certificate& certificate);

std::string certificates_html(std::span<const scenarios::Certificate> certificates);

}  // namespace tumble::tools
