// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_state.hpp"

namespace tumble {

const char* to_string(AngularRateSource source) {
  switch (source) {
    case AngularRateSource::measured:
      return "measured";
    case AngularRateSource::recovered_in_flight:
      return "recovered_in_flight";
    case AngularRateSource::recovered_in_contact:
      return "recovered_in_contact";
    case AngularRateSource::lower_bound_only:
      return "lower_bound_only";
  }
  return "unknown";
}

}  // namespace tumble
