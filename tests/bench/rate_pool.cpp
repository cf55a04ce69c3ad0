// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/rate_pool.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "scenarios/scoring/clipping.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::bench {

namespace {

using scenarios::quantile;

double mean(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double root_mean_square(std::span<const double> values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(std::max<std::size_t>(1, values.size())));
}

bool in_contact(const sim::Recording& recording, std::int64_t time_ns) {
  const sim::Truth& truth = recording.truth;
  const auto last = static_cast<std::int64_t>(truth.label.size()) - 1;
  const std::int64_t end = std::min(last, time_ns / truth.period_ns);
  const std::int64_t begin =
      std::max<std::int64_t>(0, (time_ns - recording.sensors.imus.front().period_ns) / truth.period_ns);
  for (std::int64_t k = begin; k <= end; ++k) {
    if (truth.label[static_cast<std::size_t>(k)] != sim::ContactLabel::air) return true;
  }
  return false;
}

bool accel_clipped(const sim::Recording& recording, std::size_t k) {
  const Eigen::Vector3d lost =
      recording.sensors.imus.front().accel_m_s2[k] - recording.truth.imus.front().accel_unclipped_m_s2[k];
  return lost.cwiseAbs().maxCoeff() > 0.1;
}

bool converged(const scenarios::Estimate& estimate) {
  for (const char* const name : {"converged", "carried_converged"}) {
    const auto found = estimate.health.find(name);
    if (found != estimate.health.end() && found->second == 0.0) return false;
  }
  return true;
}

// Sum contains the sums over the current segment.
struct Sum {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  double contact = 0.0, accel = 0.0, variance = 0.0;
  RatePool::Segment segment;
};

void print_share(std::span<const double> normalised) {
  const auto within = std::count_if(normalised.begin(), normalised.end(), [](double z) { return z <= 9.0; });
  const scenarios::Interval share = scenarios::share_interval(within, static_cast<std::int64_t>(normalised.size()));
  std::printf("  %6.2f (%5.2f..%5.2f)", 100.0 * share.value, 100.0 * share.low, 100.0 * share.high);
}

}  // namespace

void RatePool::add(std::uint64_t seed, const sim::Recording& recording, const scenarios::Estimate& estimate,
                   double cpu_s) {
  const scenarios::ClippingTruth truth(recording.sensors, recording.truth);
  const sim::ImuRecord& record = recording.sensors.imus.front();
  const double infinite = std::numeric_limits<double>::infinity();
  Run run{.seed = seed};
  run.converged = converged(estimate);
  run.noise_rad_s = record.gyro_noise_rad_s_sqrt_hz *
                    std::sqrt(3e9 / static_cast<double>(std::max<std::int64_t>(1, record.period_ns)));
  Sum sum;
  const auto close = [&] {
    const double count = static_cast<double>(sum.segment.samples);
    if (count > 0.0) {
      sum.segment.mean_rad_s = (sum.error / count).norm();
      sum.segment.contact_share = sum.contact / count;
      sum.segment.accel_clipped_share = sum.accel / count;
      sum.segment.sigma_rad_s = std::sqrt(sum.variance / count);
      segments_.push_back(sum.segment);
    }
    sum = {};
  };
  std::size_t at = 0;
  for (std::size_t k = 0; k < record.time_ns.size(); ++k) {
    const auto sample = truth.at(record.time_ns[k]);
    if (!sample) continue;
    while (at < estimate.rates.size() && estimate.rates[at].time_ns < record.time_ns[k]) ++at;
    const bool answered = at < estimate.rates.size() && estimate.rates[at].time_ns == record.time_ns[k];
    const Eigen::Vector3d error = answered ? Eigen::Vector3d(estimate.rates[at].w_WI_I_rad_s - sample->rate_rad_s)
                                           : Eigen::Vector3d::Constant(infinite);
    if (sample->clipped_axes == 0) {
      free_.push_back(error.norm());
      run.free_mean_rad_s += error.norm();
      close();
      continue;
    }
    clipped_.push_back(error.norm());
    run.clipped_mean_rad_s += error.norm();
    ++run.clipped;
    called_measured_ += answered && estimate.rates[at].source == AngularRateSource::measured;
    const bool contact = in_contact(recording, record.time_ns[k]);
    (contact ? contact_ : flight_).push_back(error.norm());
    if (sum.segment.samples++ == 0) sum.segment.seed = seed;
    sum.segment.end_s = 1e-9 * static_cast<double>(record.time_ns[k]);
    sum.segment.largest_rad_s = std::max(sum.segment.largest_rad_s, error.norm());
    sum.error += error;
    sum.contact += contact ? 1.0 : 0.0;
    sum.accel += accel_clipped(recording, k) ? 1.0 : 0.0;
    sum.variance += answered ? estimate.rates[at].covariance_rad2_s2.trace() : 0.0;
    for (int j = 0; j < 3; ++j) {
      if ((sample->clipped_axes >> j & 1u) == 0) continue;
      const double variance = answered ? estimate.rates[at].covariance_rad2_s2(j, j) : 0.0;
      const double z = error[j] == 0.0 ? 0.0 : error[j] * error[j] / variance;
      (contact ? normalised_contact_ : normalised_flight_).push_back(z);
    }
  }
  close();
  run.clipped_mean_rad_s /= static_cast<double>(std::max<std::size_t>(1, run.clipped));
  run.free_mean_rad_s /= static_cast<double>(std::max<std::size_t>(1, record.time_ns.size() - run.clipped));
  runs_.push_back(run);
  cpu_s_ += cpu_s;
}

void print_errors(std::span<const RatePool> pools) {
  std::printf("\nerror norm [rad/s]; %zu clipped samples, %zu others\n", pools.front().clipped_rad_s().size(),
              pools.front().free_rad_s().size());
  std::printf("%-16s %9s %9s %9s %9s %9s %9s %12s %10s\n", "method", "median", "against", "mean", "p99", "max",
              ">10 rad/s", "free median", "us/sample");
  for (const RatePool& pool : pools) {
    const std::span<const double> e = pool.clipped_rad_s();
    const double median = quantile(e, 0.5), first = quantile(pools.front().clipped_rad_s(), 0.5);
    const auto beyond = std::count_if(e.begin(), e.end(), [](double x) { return !(x <= 10.0); });
    std::printf("%-16s %9.4f %+8.2f%% %9.4f %9.3f %9.3f %9td %12.5f %10.2f\n", pool.name().c_str(), median,
                100.0 * (median / first - 1.0), mean(e), quantile(e, 0.99), quantile(e, 1.0), beyond,
                quantile(pool.free_rad_s(), 0.5), pool.cpu_us_per_sample());
  }
}

void print_contact(std::span<const RatePool> pools) {
  std::printf("\nerror norm of clipped samples [rad/s] in flight (%zu) and in contact (%zu)\n",
              pools.front().flight_rad_s().size(), pools.front().contact_rad_s().size());
  std::printf("%-16s %9s %9s %9s | %9s %9s %9s %9s\n", "method", "median", "p99", "max", "median", "p90", "p99", "max");
  for (const RatePool& pool : pools) {
    const std::span<const double> f = pool.flight_rad_s(), c = pool.contact_rad_s();
    std::printf("%-16s %9.4f %9.3f %9.3f | %9.4f %9.3f %9.3f %9.3f\n", pool.name().c_str(), quantile(f, 0.5),
                quantile(f, 0.99), quantile(f, 1.0), quantile(c, 0.5), quantile(c, 0.9), quantile(c, 0.99),
                quantile(c, 1.0));
  }
}

void print_honesty(std::span<const RatePool> pools) {
  std::printf("\nclipped axes within three reported standard deviations [%%], mean squared error over variance\n");
  std::printf("%-16s  %22s %22s %8s %8s %18s %14s\n", "method", "flight", "contact", "flight", "contact",
              "called measured", "not converged");
  for (const RatePool& pool : pools) {
    std::printf("%-16s", pool.name().c_str());
    print_share(pool.normalised_flight());
    print_share(pool.normalised_contact());
    const auto open =
        std::count_if(pool.runs().begin(), pool.runs().end(), [](const auto& run) { return !run.converged; });
    std::printf(" %8.3f %8.3f %10zu of %-4zu %7td of %zu\n", mean(pool.normalised_flight()),
                mean(pool.normalised_contact()), pool.called_measured(), pool.clipped_rad_s().size(), open,
                pool.runs().size());
  }
}

void print_runs(std::span<const RatePool> pools) {
  const auto reference =
      std::find_if(pools.begin(), pools.end(), [](const RatePool& pool) { return pool.name() == "tumble"; });
  std::printf(
      "\nruns whose mean error exceeds the first method's by more than the noise; offset of segments [rad/s]; ");
  std::printf("error over that of tumble\n");
  std::printf("%-16s %8s %8s | %8s %8s %8s %8s | %8s %8s %8s %8s\n", "method", "clipped", "free", "median", "p99",
              "max", ">0.5", "median", "mean", "rms", "p99");
  for (const RatePool& pool : pools) {
    int clipped = 0, free = 0;
    for (std::size_t i = 0; i < pool.runs().size(); ++i) {
      const RatePool::Run &run = pool.runs()[i], &first = pools.front().runs()[i];
      clipped += !(run.clipped_mean_rad_s <= first.clipped_mean_rad_s + run.noise_rad_s);
      free += !(run.free_mean_rad_s <= first.free_mean_rad_s + run.noise_rad_s);
    }
    std::vector<double> offsets;
    for (const RatePool::Segment& segment : pool.segments()) offsets.push_back(segment.mean_rad_s);
    const auto beyond = std::count_if(offsets.begin(), offsets.end(), [](double x) { return !(x <= 0.5); });
    std::printf("%-16s %8d %8d | %8.4f %8.3f %8.3f %8td |", pool.name().c_str(), clipped, free, quantile(offsets, 0.5),
                quantile(offsets, 0.99), quantile(offsets, 1.0), beyond);
    if (reference != pools.end()) {
      const std::span<const double> e = pool.clipped_rad_s(), r = reference->clipped_rad_s();
      std::printf(" %8.3f %8.3f %8.3f %8.3f", quantile(e, 0.5) / quantile(r, 0.5), mean(e) / mean(r),
                  root_mean_square(e) / root_mean_square(r), quantile(e, 0.99) / quantile(r, 0.99));
    }
    std::printf("\n");
  }
}

void print_worst(const RatePool& pool, std::size_t count) {
  std::vector<RatePool::Segment> worst(pool.segments().begin(), pool.segments().end());
  std::sort(worst.begin(), worst.end(), [](const auto& a, const auto& b) { return a.mean_rad_s > b.mean_rad_s; });
  worst.resize(std::min(count, worst.size()));
  if (worst.empty()) return;
  std::printf("\n%s, of %zu segments those with the largest offset\n", pool.name().c_str(), pool.segments().size());
  std::printf("%8s %8s %8s %8s %8s %8s %8s %10s\n", "seed", "end s", "samples", "offset", "largest", "sigma", "contact",
              "acc. rail");
  for (const RatePool::Segment& s : worst) {
    std::printf("%8llu %8.2f %8zu %8.3f %8.3f %8.3f %8.2f %10.2f\n", static_cast<unsigned long long>(s.seed), s.end_s,
                s.samples, s.mean_rad_s, s.largest_rad_s, s.sigma_rad_s, s.contact_share, s.accel_clipped_share);
  }
}

}  // namespace tumble::bench
