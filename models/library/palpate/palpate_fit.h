/* From recordings to models in any program: what `palpate import`, `palpate check` and
 * `palpate fit` do, with their defaults. C99; link palpate::fit (libpalpate_fit), which
 * has everything of palpate.h in it as well. Errors, units and handles as in palpate.h;
 * every function here allocates, reads files and may take minutes.
 */
#ifndef PALPATE_PALPATE_FIT_H
#define PALPATE_PALPATE_FIT_H

#include <palpate/palpate.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- recordings ---- */

typedef struct palpate_recording palpate_recording; /* immutable, shareable between threads */

typedef struct palpate_row {
  double time_s;
  double position_m;
  double force_N;
  double velocity_m_per_s;      /* 0 where the recording has none */
  double acceleration_m_per_s2; /* 0 where the recording has none */
} palpate_row;

PALPATE_API palpate_recording* palpate_recording_load(const char* path, char* error, size_t error_size);
PALPATE_API void palpate_recording_free(palpate_recording*);
PALPATE_API size_t palpate_recording_row_count(const palpate_recording*);
/* The rows, one after the other; valid until the recording is freed. */
PALPATE_API const palpate_row* palpate_recording_rows(const palpate_recording*);

/* A table of another program becomes a recording, by the guesses of `palpate import`; what
 * cannot be guessed is an error. An existing file is replaced only with `overwrite`.
 * Returns 0, or -1: see error. */
PALPATE_API int palpate_import(const char* table, const char* recording, int overwrite, char* error, size_t error_size);

typedef struct palpate_check_result {
  int usable;                    /* 2: usable, 1: with care, 0: not */
  double noise_floor_within_jnd; /* what a perfect model would reach, 0 to 1 */
  double surface_offset_m;       /* to be subtracted from position_m */
  double force_zero_N;           /* to be subtracted from force_N */
} palpate_check_result;

/* Is this recording fit to be fitted? `findings`: one line each, "severity code: text", cut
 * to its size; may be NULL. Returns 0, or -1: the file is no recording. */
PALPATE_API int palpate_check(const char* recording, palpate_check_result*, char* findings, size_t findings_size,
                              char* error, size_t error_size);

/* ---- fits ---- */

typedef struct palpate_fit_options {
  const char* method; /* trend, direct, voxel, random, kdtree, greedy */
  int centres;        /* of random, kdtree and greedy; 1 to 100000 */
  unsigned long long seed;
  int overwrite; /* replace an existing model file */
  /* Called now and then with the fraction done and `context`; returns 0 to stop. May be NULL. */
  int (*progress)(double fraction, void* context);
  void* context;
} palpate_fit_options;

/* greedy, 100 centres, seed 1. */
PALPATE_API void palpate_fit_options_default(palpate_fit_options*);

/* Fits one model to all recordings together and writes it: the same bytes as
 * `palpate fit --method ... --centres ... --seed ...`. NULL options: the default ones.
 * Returns 0, or -1: see error; then no file is left. */
PALPATE_API int palpate_fit(const char* const* recordings, size_t recording_count, const palpate_fit_options*,
                            const char* model, char* error, size_t error_size);

#ifdef __cplusplus
}
#endif

#endif
