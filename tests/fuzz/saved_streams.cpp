// SPDX-License-Identifier: BSD-3-Clause
#include <concepts>
#include <cstddef>
#include <vector>

#include "estimator/tests/kept_stream.hpp"
#include "tests/fuzz/saved_edits.hpp"
#include "tests/fuzz/saved_states.hpp"

namespace tumble::fuzz {

namespace {

/// Saved in motion, when the window is full.
template <class Stream>
struct Streaming {
  struct Estimator : test::Kept<Stream> {
    using Params = typename Stream::Params;
    using test::Kept<Stream>::Kept;

    static Status saved_params(const Bytes& bytes, Params& params) {
      return tumble::saved_params<Stream>(bytes, params);
    }
  };
  static constexpr std::size_t kSome = test::kRolls<Stream> ? 500 : 150, kMore = 8;

  /// Streams with short windows, which are fast.
  static typename Estimator::Params params() {
    const auto shorten = [](HandHeldStream::Params& hand_held) {
      hand_held.lag_s = 0.05;
      hand_held.window_s = 0.15;
    };
    typename Estimator::Params params = test::params_of_stream<Stream>();
    if constexpr (std::same_as<Stream, HandHeldStream>) shorten(params);
    if constexpr (std::same_as<Stream, HandHeldPipeline>) shorten(params.stream);
    return params;
  }
  static const std::vector<ImuSample>& samples() {
    static const std::vector<ImuSample> kSamples = test::samples_of_stream<Stream>();
    return kSamples;
  }
  static Bytes saved() {
    Estimator estimator(params());
    for (std::size_t k = 0; k < kSome; ++k) (void)estimator.push(samples()[k]);
    return estimator.save();
  }
  static void go_on(Estimator& estimator) {
    for (std::size_t k = kSome; k < kSome + kMore; ++k) (void)estimator.push(samples()[k]);
    estimator.end();
  }
};

}  // namespace

void saved_streams(const std::filesystem::path& file) {
  const Edits edits = read_edits(file);
  switch (edits.letter) {
    case 'R':
      return load_spoiled<Streaming<RateStream>>(edits);
    case 'G':
      return load_spoiled<Streaming<RegimeStream>>(edits);
    case 'C':
      return load_spoiled<Streaming<HandHeldStream>>(edits);
    case 'L':
      return load_spoiled<Streaming<HandHeldPipeline>>(edits);
    case 'F':
      return load_spoiled<Streaming<RollingFilter>>(edits);
    case 'S':
      return load_spoiled<Streaming<RollingSmoother>>(edits);
    default:
      throw scenarios::BadInput("none of R, G, C, L, F and S");
  }
}

}  // namespace tumble::fuzz
