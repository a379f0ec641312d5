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
/* From `n` samples in memory, by the rules of a recording file; velocity and acceleration may be
 * NULL. `name`: kept in models that are fitted to it. left_out: 1 for samples that a fit learns nothing from,
 * for cross-validation; their motion counts in the memory of the others; NULL: none. NULL: see error. */
PALPATE_API palpate_recording* palpate_recording_new(const char* name, size_t n, const double* time_s,
                                                     const double* position_m, const double* force_N,
                                                     const double* velocity_m_per_s,
                                                     const double* acceleration_m_per_s2, const unsigned char* left_out,
                                                     char* error, size_t error_size);
PALPATE_API void palpate_recording_free(palpate_recording*);
/* Of a file: its name without folder and ending. Valid until the recording is freed. */
PALPATE_API const char* palpate_recording_name(const palpate_recording*);
/* Whether it has the column. */
PALPATE_API int palpate_recording_has_velocity(const palpate_recording*);
PALPATE_API int palpate_recording_has_acceleration(const palpate_recording*);
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

/* The options of `palpate fit`, with its names, values and defaults; NULL: the default. */
typedef struct palpate_fit_options {
  const char* method;     /* trend, direct, voxel, random, kdtree, greedy [greedy] */
  int centres;            /* of random, kdtree and greedy; 1 to 2000 [100] */
  const char* candidates; /* of greedy: sites tried per step, or all [100] */
  const char* kernel;     /* cubic, linear, thin-plate [cubic] */
  const char* weighting;  /* jnd, relative, none [jnd] */
  const char* reduction;  /* coverage, force, none [coverage] */
  const char* recipe;     /* paper-2009: that of Hoever and Harders (2009) */
  const char* features;   /* auto, scene, or a list such as depth,velocity,maxwell:0.17 [auto] */
  const char* relaxation; /* of the scene's features: scene, auto, or times such as 0.17,1.27 */
  const char* surface;    /* auto, recorded [auto] */
  const char* grid;       /* of voxel: nodes per feature such as 25x11x11x11 */
  unsigned long long seed;
  /* What `palpate fit` takes from a scene [silicone_block]: its name, its features and its JND line. */
  const char* scene;
  const char* scene_features; /* [depth,velocity,lowpass_velocity:0.17,lowpass_velocity:1.27] */
  double jnd_offset_N;        /* > 0 [0.065] */
  double jnd_weber_fraction;  /* >= 0 [0.0633] */
  int overwrite;              /* replace an existing model file */
  /* Called now and then with the fraction done and `context`; returns 0 to stop. May be NULL. */
  int (*progress)(double fraction, void* context);
  void* context;
} palpate_fit_options;

PALPATE_API void palpate_fit_options_default(palpate_fit_options*);

/* Fits one model to all recordings together; a recording that `palpate check` calls unusable is an
 * error. NULL options: the default ones. NULL: see error. */
PALPATE_API palpate_model* palpate_fit_recordings(const palpate_recording* const* recordings, size_t recording_count,
                                                  const palpate_fit_options*, char* error, size_t error_size);
/* The same from files to a file: the same bytes as `palpate fit` with these options. Returns 0, or -1: see error; then
 * no file is left. */
PALPATE_API int palpate_fit(const char* const* recordings, size_t recording_count, const palpate_fit_options*,
                            const char* model, char* error, size_t error_size);

/* The folds of cross-validation that a fit uses for these depths: whole recordings from three on,
 * else whole contacts, long ones cut into pieces in time. depth_m: of `n` samples, all recordings one after
 * the other, > 0 in contact; recording: the number of each sample's recording, counted from 0, NULL: one;
 * fold: receives the number of each sample's fold, counted from 0. Returns the number of folds, or -1 for NULL. */
PALPATE_API int palpate_folds(size_t n, const double* depth_m, const int* recording, int* fold);

#ifdef __cplusplus
}
#endif

#endif
