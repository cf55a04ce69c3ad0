// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/turning.hpp"

#include <fmt/format.h>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "scenarios/recordings/upper_median.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kTurnShortest_ns = 50'000'000, kTurnLongest_ns = 1'000'000'000;
constexpr std::int64_t kReadingHole_ns = 100'000'000;
constexpr double kLeast_rad = 0.02, kMost_rad = 2.5;
constexpr double kEnough_rad = 0.2;
constexpr std::size_t kTurnPairsMin = 6, kTurnPairsMax = 400, kDelayPairsMin = 20;
constexpr std::uint8_t kGyroClipped = 0b111;
constexpr double kCoarse_s = 0.02, kFine_s = 0.002;
/// A clock error of 0.3 s is detectable if shifting the time stamps by 0.3 s at least doubles the rotation difference
/// between gyro and attitudes.
constexpr double kShown_s = 0.3, kShows = 2.0, kShowsBy = 0.02;
/// The direction of gravity is tested only if the gyro agrees with the stated quaternion convention, with a rotation
/// difference of at most 30 %.
constexpr double kAgreesAsStated = 0.3;
constexpr double kNoFit = std::numeric_limits<double>::infinity();

class GyroIntegral {
 public:
  explicit GyroIntegral(const sim::ImuRecord& imu) : imu_(imu) {
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    std::size_t unusable = 0;
    for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
      const std::int64_t step_ns = k == 0 ? 0 : imu.time_ns[k] - imu.time_ns[k - 1];
      q = (q * so3::exp(seconds(step_ns) * imu.gyro_rad_s[k])).normalized();
      const bool clipped = k < imu.clip_flags.size() && (imu.clip_flags[k] & kGyroClipped) != 0;
      unusable += clipped || step_ns > kReadingHole_ns ? 1 : 0;
      q_.push_back(q);
      unusable_.push_back(unusable);
    }
  }

  std::optional<Eigen::Quaterniond> between(std::int64_t from_ns, std::int64_t to_ns) const {
    const std::size_t first = sample_at(from_ns), last = sample_at(to_ns);
    if (last == imu_.time_ns.size() || from_ns < imu_.time_ns.front()) return std::nullopt;
    if (unusable_[last] != unusable_[first == 0 ? 0 : first - 1]) return std::nullopt;
    return at(first, from_ns).conjugate() * at(last, to_ns);
  }

 private:
  std::size_t sample_at(std::int64_t time_ns) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(imu_.time_ns, time_ns) - imu_.time_ns.begin());
  }
  Eigen::Quaterniond at(std::size_t k, std::int64_t time_ns) const {
    return q_[k] * so3::exp(seconds(time_ns - imu_.time_ns[k]) * imu_.gyro_rad_s[k]);
  }

  const sim::ImuRecord& imu_;
  std::vector<Eigen::Quaterniond> q_;
  std::vector<std::size_t> unusable_;  ///< unusable samples before each sample
};

struct AttitudePair {
  const TimedAttitude *before, *after;
};

double angle_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2.0 * std::acos(std::min(std::abs(a.dot(b)), 1.0));
}

std::optional<AttitudePair> pair_from(std::span<const TimedAttitude> attitudes, std::size_t first) {
  std::optional<AttitudePair> out;
  for (std::size_t k = first + 1; k < attitudes.size(); ++k) {
    const std::int64_t length_ns = attitudes[k].time_ns - attitudes[first].time_ns;
    if (length_ns > kTurnLongest_ns) break;
    const double turned_rad = angle_rad(attitudes[first].q_WA, attitudes[k].q_WA);
    if (length_ns < kTurnShortest_ns || turned_rad < kLeast_rad) continue;
    out.reset();
    if (turned_rad <= kMost_rad) out = {&attitudes[first], &attitudes[k]};
    if (turned_rad >= kEnough_rad) break;
  }
  return out;
}

/// Returns pairs of attitudes with a rotation between them. Pairs with little rotation contain mainly noise, so they
/// are used only if there are few other pairs.
std::vector<AttitudePair> pairs_of(std::span<const TimedAttitude> attitudes) {
  std::vector<AttitudePair> out;
  for (std::size_t first = 0; first < attitudes.size();) {
    if (const auto pair = pair_from(attitudes, first)) out.push_back(*pair);
    const std::int64_t next_ns = attitudes[first].time_ns + kTurnShortest_ns;
    while (first < attitudes.size() && attitudes[first].time_ns < next_ns) ++first;
  }
  const auto small = [](const AttitudePair& pair) {
    return angle_rad(pair.before->q_WA, pair.after->q_WA) < kEnough_rad;
  };
  if (out.size() - static_cast<std::size_t>(std::ranges::count_if(out, small)) >= kDelayPairsMin)
    std::erase_if(out, small);
  if (out.size() <= kTurnPairsMax) return out;
  std::vector<AttitudePair> even;
  for (std::size_t k = 0; k < kTurnPairsMax; ++k) even.push_back(out[k * out.size() / kTurnPairsMax]);
  return even;
}

Eigen::Quaterniond as_meant(const Eigen::Quaterniond& read, QuaternionConvention written) {
  const bool w_first = written == QuaternionConvention::w_first || written == QuaternionConvention::w_first_inverse;
  const Eigen::Quaterniond q = w_first ? Eigen::Quaterniond(read.x(), read.y(), read.z(), read.w()) : read;
  return written == QuaternionConvention::inverse || written == QuaternionConvention::w_first_inverse ? q.conjugate()
                                                                                                      : q;
}

class TurningComparison {
 public:
  TurningComparison(std::span<const TimedAttitude> attitudes, const std::vector<CandidateFrame>& frames,
                    const sim::ImuRecord& imu)
      : frames_(frames), gyro_(imu), pairs_(pairs_of(attitudes)) {
    for (const QuaternionConvention written : {QuaternionConvention::as_stated, QuaternionConvention::w_first,
                                               QuaternionConvention::inverse, QuaternionConvention::w_first_inverse}) {
      for (std::size_t frame = 0; frame < frames.size(); ++frame) add_reading(written, frame);
    }
  }

  bool set_delay(double delay_s, std::size_t least) {
    const auto delay_ns = std::llround(1e9 * delay_s);
    measured_.clear();
    std::vector<double> angles;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const auto turn = gyro_.between(pairs_[k].before->time_ns - delay_ns, pairs_[k].after->time_ns - delay_ns);
      if (!turn) continue;
      measured_.push_back({k, *turn});
      angles.push_back(angle_rad(pairs_[k].before->q_WA, pairs_[k].after->q_WA));
    }
    delay_s_ = delay_s;
    rotation_rad_ = upper_median(std::move(angles));
    return measured_.size() >= least;
  }

  std::size_t covered() const { return measured_.size(); }

  TurningFit fit(std::size_t reading) const {
    const Reading& each = readings_[reading];
    return {each.written, each.frame, delay_s_,
            share([&](const Measured& measured) { return angle_rad(each.seen_I[measured.pair], measured.turn); })};
  }

  TurningFit best() const {
    TurningFit out = fit(0);
    for (std::size_t k = 1; k < readings_.size(); ++k) {
      if (const TurningFit other = fit(k); other.difference < out.difference) out = other;
    }
    return out;
  }

  /// Returns the mean specific force in world axes. If the quaternion convention is correct, this force points up and
  /// has about the size of gravity.
  Eigen::Vector3d force(const TurningFit& fit, const sim::ImuRecord& imu) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Measured& measured : measured_) {
      const TimedAttitude& attitude = *pairs_[measured.pair].before;
      const auto at = std::ranges::lower_bound(imu.time_ns, attitude.time_ns - std::llround(1e9 * fit.delay_s));
      const auto k = static_cast<std::size_t>(at - imu.time_ns.begin());
      if (k == imu.time_ns.size()) continue;
      sum += as_meant(attitude.q_WA, fit.written) * (frames_[fit.frame].q_AI * imu.accel_m_s2[k]);
    }
    return sum / std::max(static_cast<double>(measured_.size()), 1.0);
  }

  /// Returns the quaternion conventions that fit the gyro about as well as `fitted`. If the sensor rotates about a
  /// single axis, several conventions can fit.
  std::vector<TurningFit> alike(const TurningFit& fitted) const {
    std::vector<TurningFit> out;
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      const TurningFit other = fit(k);
      if (other.frame == fitted.frame && other.difference < kShows * fitted.difference + kShowsBy) out.push_back(other);
    }
    return out;
  }

  /// Computes the best mounting of the IMU by a singular value decomposition, which solves Wahba's problem (1965).
  MountingFit mounting() const {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Measured& measured : measured_) sum += seen_A(measured.pair) * so3::logarithm(measured.turn).transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    const Eigen::Matrix3d R_AI =
        svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
    return {Eigen::Quaterniond(R_AI), delay_s_, share([&](const Measured& measured) {
              return (seen_A(measured.pair) - R_AI * so3::logarithm(measured.turn)).norm();
            })};
  }

 private:
  struct Reading {
    QuaternionConvention written;
    std::size_t frame;
    std::vector<Eigen::Quaterniond> seen_I;  ///< rotation of each pair, in IMU axes
  };
  struct Measured {
    std::size_t pair;
    Eigen::Quaterniond turn;
  };

  void add_reading(QuaternionConvention written, std::size_t frame) {
    const Eigen::Quaterniond& q_AI = frames_[frame].q_AI;
    for (const Reading& other : readings_) {  // a frame with equal mounting exists
      if (other.written == written && angle_rad(frames_[other.frame].q_AI, q_AI) < 1e-3) return;
    }
    Reading out{written, frame, {}};
    for (const AttitudePair& pair : pairs_) {
      const Eigen::Quaterniond seen =
          as_meant(pair.before->q_WA, written).conjugate() * as_meant(pair.after->q_WA, written);
      out.seen_I.push_back(q_AI.conjugate() * seen * q_AI);
    }
    readings_.push_back(std::move(out));
  }

  Eigen::Vector3d seen_A(std::size_t pair) const {
    return so3::logarithm(pairs_[pair].before->q_WA.conjugate() * pairs_[pair].after->q_WA);
  }

  template <class Error>
  double share(Error&& error) const {
    std::vector<double> errors;
    for (const Measured& measured : measured_) errors.push_back(error(measured));
    return errors.empty() ? kNoFit : upper_median(std::move(errors)) / rotation_rad_;
  }

  const std::vector<CandidateFrame>& frames_;
  GyroIntegral gyro_;
  std::vector<AttitudePair> pairs_;
  std::vector<Reading> readings_;
  std::vector<Measured> measured_;
  double delay_s_ = 0.0, rotation_rad_ = 0.0;
};

template <class Fit>
void take_better(const Fit& found, Fit& best) {
  if (found.difference < best.difference) best = found;
}

template <class Fit, class FitNow>
void search_delay(TurningComparison& comparison, double delay_max_s, std::size_t least, FitNow&& fit_now, Fit& best) {
  const auto search = [&](double centre_s, double reach_s, double step_s) {
    const long steps = std::lround(2.0 * reach_s / step_s);
    for (long step = 0; step <= steps; ++step) {
      if (comparison.set_delay(centre_s - reach_s + step_s * static_cast<double>(step), least))
        take_better(fit_now(), best);
    }
  };
  search(0.0, delay_max_s, kCoarse_s);
  search(best.delay_s, kCoarse_s, kFine_s);
}

constexpr double kUpMin_m_s2 = 5.0;              ///< smallest usable mean force
constexpr double kUpright = 0.9, kTilted = 0.5;  ///< cosines of the tilt

double uprightness(const TurningComparison& comparison, const sim::ImuRecord& imu, const TurningFit& fit) {
  const Eigen::Vector3d up = comparison.force(fit, imu);
  return up.norm() < kUpMin_m_s2 ? 0.0 : up.z() / up.norm();
}

void prefer_upright(TurningComparison& comparison, const sim::ImuRecord& imu, TurningFit& fit) {
  if (fit.written == QuaternionConvention::as_stated) return;
  comparison.set_delay(fit.delay_s, 0);
  for (const TurningFit& other : comparison.alike(fit)) {
    if (other.written != QuaternionConvention::as_stated &&
        uprightness(comparison, imu, other) > uprightness(comparison, imu, fit))
      fit = other;
  }
}

void compare_with_gravity(const TurningComparison& comparison, const sim::ImuRecord& imu, TurningCheck& check) {
  if (check.stated.difference > kAgreesAsStated) return;
  const double stated = uprightness(comparison, imu, check.stated);
  const std::vector<TurningFit> alike = comparison.alike(check.stated);
  check.order_known = alike.size() < 2 || stated > kUpright;
  if (stated > kTilted) return;
  for (const TurningFit& other : alike) {
    if (other.written != QuaternionConvention::as_stated && uprightness(comparison, imu, other) > kUpright)
      check.upright = other;
  }
}

bool clock_shows(TurningComparison& comparison, double stated, std::size_t least) {
  for (const double delay_s : {-kShown_s, kShown_s}) {
    if (!comparison.set_delay(delay_s, least)) return false;
    if (comparison.fit(0).difference < kShows * stated + kShowsBy) return false;
  }
  return true;
}

}  // namespace

std::string delay_text(double delay_s) {
  return fmt::format("{:.3f} s too {}", std::abs(delay_s), delay_s > 0.0 ? "late" : "early");
}

std::string delay_remedy(double delay_s) {
  if (delay_s > 0.0)
    return fmt::format(
        "the time stamps of the poses are {0:.3f} s too late, but at most {1:.2f} s is accepted; subtract {0:.3f} s "
        "from the time stamps",
        delay_s, kDelayMax_s);
  return fmt::format(
      "the time stamps of the poses are {0:.3f} s too early, but at most {1:.2f} s is accepted; add {0:.3f} s to the "
      "time stamps",
      -delay_s, kDelayMax_s);
}

TurningCheck check_turning(std::span<const TimedAttitude> attitudes, const std::vector<CandidateFrame>& frames,
                           const sim::ImuRecord& imu, double delay_max_s) {
  TurningCheck out;
  TurningComparison comparison(attitudes, frames, imu);
  if (!comparison.set_delay(0.0, kTurnPairsMin)) return out;
  out.pairs = comparison.covered();
  out.stated = comparison.fit(0);
  out.reading.delayed = out.reading.undelayed = comparison.best();
  out.mounting.delayed = out.mounting.undelayed = comparison.mounting();
  compare_with_gravity(comparison, imu, out);
  prefer_upright(comparison, imu, out.reading.undelayed);
  out.reading.delayed = out.reading.undelayed;
  const std::size_t least = std::max(kDelayPairsMin, out.pairs / 2);
  if (delay_max_s <= 0.0 || out.pairs < least) return out;
  out.clock_known = clock_shows(comparison, out.stated.difference, least);
  search_delay(
      comparison, delay_max_s, least, [&] { return comparison.best(); }, out.reading.delayed);
  search_delay(
      comparison, delay_max_s, least, [&] { return comparison.mounting(); }, out.mounting.delayed);
  prefer_upright(comparison, imu, out.reading.delayed);
  return out;
}

}  // namespace tumble::scenarios
