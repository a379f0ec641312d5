// The last word on every force before a device gets it. In this order:
//
//   finite   a force that is not a number counts as 0 and as a fault
//   ramp     the share that is let through grows from 0 to 1 over `ramp_s` from
//            the start, and again after each fault
//   clamp    |force| <= largest_N
//   slew     |change| <= fastest_N_per_s x the time since the last force, so
//            that neither a fault nor a jump is felt as a kick
//
// Thread guarantee: one thread at a time; wait-free, never throws.
#pragma once

#include <cstdint>
#include <type_traits>

namespace palpate {

struct ForceLimits {
  double largest_N = 10.0;            // > 0
  double fastest_N_per_s = 5000.0;    // > 0
  double ramp_s = 0.3;                // >= 0
};

// What the limiter did to one force; bits, for TickSnapshot's neighbours.
namespace force_limit {
inline constexpr std::uint32_t kNotFinite = 1;  // fault
inline constexpr std::uint32_t kClamped = 2;
inline constexpr std::uint32_t kSlewed = 4;
inline constexpr std::uint32_t kRamping = 8;
}  // namespace force_limit

class ForceLimiter {
 public:
  explicit ForceLimiter(const ForceLimits& limits) noexcept : limits_(limits) {}

  // `wanted_N`: anything; `step_s`: since the last call, counted as between 0
  // and 10 ms, so that a stall does not license a jump. Returns the force to
  // render, finite, and sets `flags`.
  double limit(double wanted_N, double step_s) noexcept;

  // The next force is 0 and the ramp begins again; for a fault found elsewhere.
  void fault() noexcept { share_ = 0.0; }

  std::uint32_t flags() const noexcept { return flags_; }
  double force_N() const noexcept { return force_N_; }

 private:
  ForceLimits limits_;
  double share_ = 0.0;
  double force_N_ = 0.0;
  std::uint32_t flags_ = 0;
};

static_assert(std::is_trivially_copyable_v<ForceLimiter>);

}  // namespace palpate
