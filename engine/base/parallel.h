// Fork and join for the fits. Never used in the tick.
#pragma once

#include <functional>

namespace palpate {

// Number of threads the fits use: what the machine has.
int thread_count();

// Calls work(0) ... work(count - 1), each once, on up to thread_count()
// threads, and returns when all are done. Which thread takes which part is not
// fixed, so parts must write to places of their own; results that are then
// combined in the order of the parts do not depend on the threads.
// `work` must not throw.
void parallel_for(int count, const std::function<void(int part)>& work);

}  // namespace palpate
