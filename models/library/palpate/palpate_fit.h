/* From recordings to models in any program: `palpate import`, `palpate check` and `palpate fit` with their defaults.
 * C99; link palpate::fit (libpalpate_fit), which includes all of palpate.h. Errors, units and handles as in palpate.h.
 * Every function here allocates, reads files and may take minutes.
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
/* A recording from `n` samples in memory, by the rules of a recording file; velocity and acceleration may be NULL.
 * `name`: appears in models that are fitted to it. left_out: 1 for samples that are no training samples, for
 * cross-validation; their motion still updates the filters; NULL: none. Returns NULL: see error. */
PALPATE_API palpate_recording* palpate_recording_new(const char* name, size_t n, const double* time_s,
                                                     const double* position_m, const double* force_N,
                                                     const double* velocity_m_per_s,
                                                     const double* acceleration_m_per_s2, const unsigned char* left_out,
                                                     char* error, size_t error_size);
PALPATE_API void palpate_recording_free(palpate_recording*);
/* The name; for a file, without folder and extension. Valid until the recording is freed. */
PALPATE_API const char* palpate_recording_name(const palpate_recording*);
/* 1 if the recording has the column, else 0. */
PALPATE_API int palpate_recording_has_velocity(const palpate_recording*);
PALPATE_API int palpate_recording_has_acceleration(const palpate_recording*);
PALPATE_API size_t palpate_recording_row_count(const palpate_recording*);
/* The rows, one after the other; valid until the recording is freed. */
PALPATE_API const palpate_row* palpate_recording_rows(const palpate_recording*);

/* Converts a table of another program into a recording, by the rules of `palpate import`; what these cannot determine
 * is an error. An existing file is replaced only with `overwrite`. Returns 0, or -1: see error. */
PALPATE_API int palpate_import(const char* table, const char* recording, int overwrite, char* error, size_t error_size);

typedef struct palpate_check_result {
  int usable;                    /* 2: usable, 1: usable with warnings, 0: not usable */
  double noise_floor_within_jnd; /* share of samples that a perfect model has within the JND, 0 to 1 */
  double surface_offset_m;       /* to be subtracted from position_m */
  double force_zero_N;           /* to be subtracted from force_N */
} palpate_check_result;

/* Checks whether a recording is suitable for a fit. `findings`: one line each, "severity code: text", truncated to its
 * size; may be NULL. Returns 0, or -1: the file is no recording. */
PALPATE_API int palpate_check(const char* recording, palpate_check_result*, char* findings, size_t findings_size,
                              char* error, size_t error_size);

/* ---- fits ---- */

/* The options of `palpate fit` with their names, values and [defaults]; NULL: the default. */
typedef struct palpate_fit_options {
  const char* method;     /* trend, direct, voxel, random, kdtree, greedy [greedy] */
  int centres;            /* of random, kdtree and greedy; 1 to 2000 [100] */
  const char* candidates; /* of greedy: candidate sites per step, or all [100] */
  const char* kernel;     /* cubic, linear, thin-plate, quintic [cubic] */
  const char* weighting;  /* jnd, relative, none [jnd] */
  const char* reduction;  /* coverage, force, none [coverage] */
  const char* recipe;     /* paper-2009: that of Hoever and Harders (2009) [none] */
  const char* features;   /* auto, scene, or a list such as depth,velocity,maxwell:0.17 [auto] */
  const char* relaxation; /* of the scene's features: scene, auto, or times such as 0.17,1.27 */
  const char* surface;    /* auto, recorded [auto] */
  const char* grid;       /* of voxel: nodes per feature such as 25x11x11x11 */
  unsigned long long seed;
  /* The options that `palpate fit` reads from a scene [silicone_block]: its name, its features and its JND line. */
  const char* scene;
  const char* scene_features; /* [depth,velocity,lowpass_velocity:0.17,lowpass_velocity:1.27] */
  double jnd_offset_N;        /* > 0 [0.065] */
  double jnd_weber_fraction;  /* >= 0 [0.0633] */
  int overwrite;              /* replace an existing model file */
  /* Called from time to time with the finished fraction and `context`; returns 0 to interrupt. May be NULL. */
  int (*progress)(double fraction, void* context);
  void* context;
} palpate_fit_options;

PALPATE_API void palpate_fit_options_default(palpate_fit_options*);

/* Fits one model to all recordings together. A recording that is not usable (palpate_check) is an error. NULL options:
 * the defaults. Returns NULL: see error. */
PALPATE_API palpate_model* palpate_fit_recordings(const palpate_recording* const* recordings, size_t recording_count,
                                                  const palpate_fit_options*, char* error, size_t error_size);
/* The same from files to a file, which has the same bytes as that of `palpate fit` with these options. Returns 0, or
 * -1: see error; then no file is written. */
PALPATE_API int palpate_fit(const char* const* recordings, size_t recording_count, const palpate_fit_options*,
                            const char* model, char* error, size_t error_size);

/* The folds of the cross-validation of a fit: whole recordings if there are three or more, else whole contacts, of
 * which long ones are cut into pieces in time. depth_m: of `n` samples, all recordings one after the other, > 0 in
 * contact; recording: the index of each sample's recording, from 0, NULL: one recording; fold: receives the index of
 * each sample's fold, from 0. Returns the number of folds, or -1 for NULL. */
PALPATE_API int palpate_folds(size_t n, const double* depth_m, const int* recording, int* fold);

#ifdef __cplusplus
}
#endif

#endif
