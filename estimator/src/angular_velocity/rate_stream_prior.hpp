// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/rate_stream.hpp"

// What the two halves of RateStream share.
namespace tumble {

/// Samples by which the history may exceed its length before it is cut, all at once.
inline constexpr std::size_t kSurplus = 32;

double seconds_between(const RateStream::Knot& from, const RateStream::Knot& to);

/// Adds a prior at another point than the one about which it stands.
void add_prior(const RateStream::Prior& prior, const RateModel& model, const RateKnot& knot, const RigConstants& rig,
               arrow::Block& block, arrow::Corner& corner);

}  // namespace tumble
