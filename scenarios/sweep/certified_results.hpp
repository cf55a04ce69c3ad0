// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "scenarios/certificate/certificate_store.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Returns the certificate of this build (checks of its simulation) if `results` or the store contains it, and copies
/// it to `results`. Makes no measurement; otherwise returns nothing.
std::optional<Certificate> known_certificate(Results& results, const CertificateStore& store);

/// Adds the certificate of this build (checks of its simulation) to `results` if it is missing, and returns it. A
/// certificate that the store lacks is measured and saved in the store. If the measurement is interrupted, the
/// certificate has no entries and is not saved. Throws the exceptions of measure_certificate.
Certificate certify_results(Results& results, const CertificateStore& store, const CertificateInput& input,
                            const CertifyOptions& options);

}  // namespace tumble::scenarios
