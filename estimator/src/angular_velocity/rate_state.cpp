// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_state.hpp"

namespace tumble {

const char* to_string(RateSource source) {
  switch (source) {
    case RateSource::measured:
      return "measured";
    case RateSource::recovered_flight:
      return "recovered_flight";
    case RateSource::recovered_contact:
      return "recovered_contact";
    case RateSource::bounded_only:
      return "bounded_only";
  }
  return "unknown";
}

}  // namespace tumble
