// Random numbers that are bit-identical on every machine: RandomStream, xoshiro256** (Blackman & Vigna 2018), whose
// streams of one seed are independent, and SplitMix64 (Steele, Lea & Flood 2014) for draws without replacement.
// Thread guarantee: one thread at a time; wait-free.
#pragma once

#include <array>
#include <cstdint>

namespace palpate {

class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept { return mixed(state_ += kStep); }

  // Uniform in [0, bound), without bias. bound >= 1.
  std::uint64_t below(std::uint64_t bound) noexcept {
    const std::uint64_t rejected = (0 - bound) % bound;  // 2^64 mod bound
    std::uint64_t value = next();
    while (value < rejected) value = next();
    return value % bound;
  }

  // The increment of the state, and the function from a state to a number.
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  static std::uint64_t mixed(std::uint64_t z) noexcept {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }

 private:
  std::uint64_t state_;
};

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) noexcept {
    SplitMix64 mixer(SplitMix64::mixed(seed) + SplitMix64::kStep * (stream + 1));
    for (std::uint64_t& word : state_) word = mixer.next();
  }

  std::uint64_t next() noexcept {
    const std::uint64_t result = rotated(state_[1] * 5, 7) * 9;
    const std::uint64_t kept = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= kept;
    state_[3] = rotated(state_[3], 45);
    return result;
  }

  // Uniform in [from, to).
  double uniform(double from, double to) noexcept {
    return from + (to - from) * static_cast<double>(next() >> 11) * 0x1p-53;
  }

  // Uniform in 0 .. count - 1; count > 0 and small.
  std::uint64_t index(std::uint64_t count) noexcept { return (next() >> 32) * count >> 32; }

  // Mean 0, variance 1, approximately normal: the sum of twelve uniform numbers (Irwin-Hall), without logarithm or
  // cosine. At 3 standard deviations its tails are 20 % too thin; they end at 6.
  double normal() noexcept {
    std::uint64_t sum = 0;
    for (int draw = 0; draw < 3; ++draw) {
      const std::uint64_t bits = next();
      sum += (bits & 0xffff) + (bits >> 16 & 0xffff) + (bits >> 32 & 0xffff) + (bits >> 48);
    }
    // Each part has mean (2^16 - 1) / 2.
    return (static_cast<double>(sum) - 6.0 * 65535.0) * 0x1p-16;
  }

 private:
  static std::uint64_t rotated(std::uint64_t x, int by) noexcept { return x << by | x >> (64 - by); }
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace palpate
