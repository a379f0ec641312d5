// What a model's evaluation takes: the median over about the last second in
// contact.
// Thread guarantee: one thread; allocates nothing.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

class EvaluationTime {
 public:
  void add(float time_ns) noexcept;
  // Nanoseconds; 0 before the first one. Renewed every kRenewal values.
  double median_ns() const noexcept { return median_ns_; }

 private:
  static constexpr std::size_t kValues = 1000;
  static constexpr std::size_t kRenewal = 100;
  void renew() noexcept;

  std::array<float, kValues> values_ns_{};
  std::size_t count_ = 0;  // of all time
  double median_ns_ = 0.0;
};

}  // namespace palpate
