// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "../angular_velocity/rate_stream_members.hpp"
#include "hand_held_stream_members.hpp"
#include "tumble/attitude/regime_stream.hpp"

/// regime_stream_members.hpp lists the members of RegimeStream's state and further members of RegimeStream::Params, for
/// saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<RegimeProbabilities> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("shares.flight", s.flight);
  visit("shares.contact", s.contact);
  visit("shares.carried", s.hand_held);
}

template <StateOf<RegimeStream::ReportedProbability> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("near.time_ns", s.time_ns);
  visit("near.carried", s.hand_held);
}

template <StateOf<RegimeStream::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("regime.rate", s.rate);
  visit("regime.carried", s.hand_held);
  visit.scratch(s.signs);
  visit("regime.shares", s.probabilities);
  visit("regime.sum", s.sum);
  visit("regime.reported", s.reported);
  visit("regime.joined", s.combined_samples);
  visit("regime.starts", s.starts);
  visit("regime.rig_resets", s.rig_resets);
  visit("regime.resets", s.resets);
  visit("regime.carrying", s.hand_held_running);
  visit("regime.near", s.near);
  visit("regime.reported_ns", s.reported_ns);
  visit("regime.clipped_ns", s.clipped_ns);
}

template <StateOf<RegimeStream::Params> Self, class Visitor>
void others(Self& p, Visitor& visit) {
  others(p.rate, visit);
}

}  // namespace tumble
