// The reference of palpate-bench: eq. 2 as a plain scalar loop over 4-D centres with
// the cubic kernel, compiled with -O2. Ratios to it are comparable between machines.
#pragma once

#include <cstddef>

namespace palpate::bench {

// sum_j weights[j] |x - centre_j|^3 + tail[0] + sum_k tail[1 + k] x[k].
// `centres`: 4 numbers each, one after the other.
double scalar_cubic_4d(const double* centres, const double* weights, std::size_t count, const double* tail,
                       const double* x);

}  // namespace palpate::bench
