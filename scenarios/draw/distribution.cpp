// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <sstream>

#include "scenarios/errors.hpp"
#include "sim/random/stream.hpp"

namespace tumble::scenarios {

namespace {

using Shape = Distribution::Shape;

constexpr double kLeastKept = 0.01;

double normal_below(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

double normal_score(double probability) {
  if (probability <= 0.0 || probability >= 1.0) return std::copysign(HUGE_VAL, probability - 0.5);
  return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * probability);
}

std::string count_problem(const Distribution& d) {
  const std::size_t n = d.numbers.size();
  switch (d.shape) {
    case Shape::constant:
      return n == 1 ? "" : "needs exactly one number";
    case Shape::uniform:
    case Shape::log_uniform:
      return n == 2 ? "" : std::string(to_string(d.shape)) + " needs [low, high]";
    case Shape::normal:
      return n == 2 || n == 4 ? ""
                              : "the distribution 'normal' needs the list [mean, sigma] or [mean, sigma, low, high]";
    case Shape::choice:
      return n >= 1 ? "" : "the distribution 'choice' must list at least one value";
  }
  return "unknown shape";
}

std::string range_problem(double low, double high) {
  if (low <= high) return "";
  std::ostringstream text;
  text << "low " << low << " is above high " << high;
  return text.str();
}

std::string normal_problem(const std::vector<double>& numbers) {
  const double mean = numbers[0];
  const double sigma = numbers[1];
  std::ostringstream text;
  if (sigma < 0.0) {
    text << "sigma " << sigma << " is below 0";
  } else if (numbers.size() == 4) {
    const double low = numbers[2];
    const double high = numbers[3];
    if (const std::string problem = range_problem(low, high); !problem.empty()) return problem;
    const double kept = sigma > 0.0 ? normal_below((high - mean) / sigma) - normal_below((low - mean) / sigma)
                                    : (mean >= low && mean <= high ? 1.0 : 0.0);
    if (!(kept >= kLeastKept))
      text << fmt::format(
          "the interval [{:g}, {:g}] contains less than 1 % of the normal distribution; widen [low, high]", low, high);
  }
  return text.str();
}

double draw_normal(const std::vector<double>& numbers, sim::Stream& stream) {
  if (numbers.size() == 2) return numbers[0] + numbers[1] * stream.normal();
  // The probability that 10000 random numbers in a row are outside the truncation limits is below 1e-43, because the
  // limits contain at least 1 % of the distribution.
  for (int attempt = 0; attempt < 10000; ++attempt) {
    const double value = numbers[0] + numbers[1] * stream.normal();
    if (value >= numbers[2] && value <= numbers[3]) return value;
  }
  throw BadInput(
      "no sample of the truncated normal distribution was within its limits in 10000 tries; widen [low, high]");
}

double normal_at(const std::vector<double>& numbers, double score) {
  const double mean = numbers[0], sigma = numbers[1];
  if (numbers.size() == 2 || sigma == 0.0) return mean + sigma * score;
  const double low = normal_below((numbers[2] - mean) / sigma), high = normal_below((numbers[3] - mean) / sigma);
  const double probability = low + normal_below(score) * (high - low);
  return std::clamp(mean + sigma * normal_score(probability), numbers[2], numbers[3]);
}

double choice_at(const std::vector<double>& numbers, double score) {
  const auto index = static_cast<std::size_t>(normal_below(score) * static_cast<double>(numbers.size()));
  return numbers[std::min(index, numbers.size() - 1)];
}

void require_sound(const Distribution& distribution, std::string_view place) {
  const std::string problem = find_problem(distribution);
  if (!problem.empty()) throw BadInput(std::string(place) + ": " + problem);
}

}  // namespace

const char* to_string(Distribution::Shape shape) {
  switch (shape) {
    case Shape::constant:
      return "constant";
    case Shape::uniform:
      return "uniform";
    case Shape::normal:
      return "normal";
    case Shape::log_uniform:
      return "log_uniform";
    case Shape::choice:
      return "choice";
  }
  return "unknown";
}

std::string find_problem(const Distribution& d) {
  if (const std::string problem = count_problem(d); !problem.empty()) return problem;
  if (!std::all_of(d.numbers.begin(), d.numbers.end(), [](double x) { return std::isfinite(x); })) {
    return "the distribution contains a number that is not finite";
  }
  switch (d.shape) {
    case Shape::uniform:
      return range_problem(d.numbers[0], d.numbers[1]);
    case Shape::normal:
      return normal_problem(d.numbers);
    case Shape::log_uniform: {
      if (std::min(d.numbers[0], d.numbers[1]) <= 0.0)
        return "the distribution 'log_uniform' needs numbers greater than 0";
      return range_problem(d.numbers[0], d.numbers[1]);
    }
    case Shape::constant:
    case Shape::choice:
      break;
  }
  return "";
}

std::vector<double> support_points(const Distribution& d) {
  if (d.shape != Shape::normal) return d.numbers;
  if (d.numbers.size() == 4) return {d.numbers[2], d.numbers[3]};
  return {d.numbers[0]};
}

double draw_number(const Distribution& d, std::uint64_t seed, std::string_view place) {
  require_sound(d, place);
  if (d.shape == Shape::constant) return d.numbers[0];
  sim::Stream stream(seed, "draw." + std::string(place));
  switch (d.shape) {
    case Shape::uniform:
      return std::clamp(stream.uniform(d.numbers[0], d.numbers[1]), d.numbers[0], d.numbers[1]);
    case Shape::log_uniform: {
      const double value = std::exp(stream.uniform(std::log(d.numbers[0]), std::log(d.numbers[1])));
      return std::clamp(value, d.numbers[0], d.numbers[1]);  // because of rounding, exp(log(x)) may exceed x
    }
    case Shape::normal:
      return draw_normal(d.numbers, stream);
    case Shape::choice: {
      const auto count = static_cast<double>(d.numbers.size());
      const auto index = static_cast<std::size_t>(stream.uniform() * count);
      return d.numbers[std::min(index, d.numbers.size() - 1)];
    }
    case Shape::constant:
      break;
  }
  return d.numbers[0];
}

double number_at(const Distribution& d, double score) {
  require_sound(d, to_string(d.shape));
  const auto between = [&](double low, double high) { return low + normal_below(score) * (high - low); };
  switch (d.shape) {
    case Shape::uniform:
      return std::clamp(between(d.numbers[0], d.numbers[1]), d.numbers[0], d.numbers[1]);
    case Shape::log_uniform:
      return std::clamp(std::exp(between(std::log(d.numbers[0]), std::log(d.numbers[1]))), d.numbers[0], d.numbers[1]);
    case Shape::normal:
      return normal_at(d.numbers, score);
    case Shape::choice:
      return choice_at(d.numbers, score);
    case Shape::constant:
      break;
  }
  return d.numbers[0];
}

}  // namespace tumble::scenarios
