// SPDX-License-Identifier: BSD-3-Clause
// example_bag_map FILE.mcap prints the trajectory of an MCAP file as lines t x y z qx qy qz qw, with the readers of the
// harness.
#include <cstdio>
#include <exception>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/bags/bag.hpp"

int main(int count, char** arguments) try {
  namespace scenarios = tumble::scenarios;
  const scenarios::Imported bag = scenarios::import_mcap(count > 1 ? arguments[1] : "", {});
  const scenarios::MethodPointer method = scenarios::find_methods("slam/tumble").front();
  const scenarios::Estimate estimate = method->run(bag.sensors, {}, {});
  for (const auto& [time_ns, p, q, v, covariance] : estimate.poses)
    std::printf("%.9f %.4f %.4f %.4f %.6f %.6f %.6f %.6f\n", 1e-9 * static_cast<double>(time_ns), p.x(), p.y(), p.z(),
                q.x(), q.y(), q.z(), q.w());
  return estimate.status.ok() ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
