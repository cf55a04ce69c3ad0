// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// A certificate (checks of the simulation) that the store lacks is measured and saved in the store, unless the
/// measurement is interrupted.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
