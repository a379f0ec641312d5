/* From recordings to models in any program: `palpate fit`. C99; link palpate::fit (libpalpate_fit), which includes all
 * of palpate.h. Errors, units and handles as in palpate.h.
 */
#ifndef PALPATE_PALPATE_FIT_H
#define PALPATE_PALPATE_FIT_H

#include <palpate/palpate.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Fits one model to all recordings together; saved, it has the bytes of the file of `palpate fit` with these options.
 *
 * options: "NAME=VALUE" separated by blanks, e.g. "method=random centres=40"; NULL or "": the defaults, in brackets.
 *   method      direct, voxel, random, kdtree, greedy: a method on the measured force, as Hoever and Harders (2009);
 *               trend; trend+direct ... trend+greedy: the trend and a correction; a number of centres may follow:
 *               greedy-40 [trend+greedy]
 *   centres     of random, kdtree and greedy: 1 to 2000 [100]
 *   candidates  of greedy: candidate sites per step, or all [100]
 *   features    auto, scene (those of 2009), or a list such as depth,velocity,maxwell:0.17 [auto]
 *   kernel      auto, cubic, linear, thin-plate [auto]
 *   grid        of voxel: nodes per feature such as 25x11x11x11 [automatic]
 *   seed        of random, kdtree and greedy, alone or after trend+ [1]
 * progress: called from time to time with the finished fraction and `context`; returns 0 to interrupt; may be NULL.
 *
 * Slow side: allocates, and may take minutes. Returns NULL, see error: a sample or an option is not valid; a recording
 * is not usable, as in `palpate check`; interrupted. */
PALPATE_API palpate_model* palpate_fit(const palpate_recording* recordings, size_t recording_count, const char* options,
                                       int (*progress)(double fraction, void* context), void* context, char* error,
                                       size_t error_size);

#ifdef __cplusplus
}
#endif

#endif
