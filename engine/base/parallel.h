// Parallel loops for the fits. Not for the tick.
#pragma once

#include <functional>

namespace palpate {

// The number of threads of a fit: one for each processor of the machine.
int thread_count();

// Calls work(0) ... work(count - 1) once each on up to thread_count() threads, and returns when all calls have ended.
// The assignment of parts to threads is not deterministic, so parts must write to separate memory; results that are
// then combined in the order of the parts are deterministic. `work` must not throw.
void parallel_for(int count, const std::function<void(int part)>& work);

}  // namespace palpate
