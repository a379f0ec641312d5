/* Palpate's models in any program: load a model file, feed it the tool's position,
 * get the force. C99; everything that can call C can use it.
 *
 *   palpate_model *model = palpate_model_load("block.json", error, sizeof error);
 *   palpate_stream *stream = palpate_stream_new(model, 30e-6, error, sizeof error);
 *   for (;;) force_N = palpate_stream_force(stream, time_s, position_m);
 *
 * Units are SI. position_m runs along the inward surface normal: 0 at the undisturbed
 * surface, positive inside; a model of recordings that all touch deeper than 0 touches
 * where they do. Forces act along the outward normal, positive when the material pushes
 * the tool out.
 *
 * A stream runs the code of `palpate replay`: the same samples, with the same sensor
 * (palpate_sensor_of_recording), give the same forces to the last bit.
 *
 * Errors: functions that can fail return NULL (or -1) and write one line of UTF-8 to
 * `error`, cut to `error_size` bytes with its end; `error` may be NULL. No function
 * throws, writes to a terminal, or changes the locale or a signal handler.
 * A NULL handle is no handle: forces are 0, errors NaN, flags 0, texts empty.
 * Freeing NULL does nothing; freeing a handle twice, or using one that was freed, is
 * undefined, as with free().
 */
#ifndef PALPATE_PALPATE_H
#define PALPATE_PALPATE_H

#include <stddef.h>

#if defined(__GNUC__)
#define PALPATE_API __attribute__((visibility("default")))
#else
#define PALPATE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Raised when a function or a struct of this header changes its meaning or its layout. */
#define PALPATE_ABI_VERSION 2

/* Of the library that is linked; a program compares it with PALPATE_ABI_VERSION. */
PALPATE_API int palpate_abi_version(void);

typedef struct palpate_model palpate_model;     /* immutable, shareable between threads */
typedef struct palpate_stream palpate_stream;   /* one tool; one thread at a time */
typedef struct palpate_limiter palpate_limiter; /* one actuator; one thread at a time */

/* ---- models: slow side, allocate ---- */

/* A model file as `palpate fit` writes it. NULL: no such file, not a model, damaged. */
PALPATE_API palpate_model* palpate_model_load(const char* path, char* error, size_t error_size);
/* Streams of the model stay valid. */
PALPATE_API void palpate_model_free(palpate_model*);
/* E.g. "greedy-100"; valid until the model is freed. */
PALPATE_API const char* palpate_model_name(const palpate_model*);
/* Of a model that this process fitted: what `palpate fit --json` prints; else empty. Valid
 * until the model is freed. */
PALPATE_API const char* palpate_model_report(const palpate_model*);
/* Writes the model file, whole or not at all. Returns 0, or -1: see error. */
PALPATE_API int palpate_model_save(const palpate_model*, const char* path, int overwrite, char* error,
                                   size_t error_size);
/* The model as one self-contained C99 file: `palpate export`. `encoder_step_m`: as
 * palpate_stream_new. Returns 0, or -1: see error. */
PALPATE_API int palpate_model_export_c(const palpate_model*, double encoder_step_m, int single_precision,
                                       const char* path, int overwrite, char* error, size_t error_size);

/* The features that the force depends on, 1 to 8, and their names, e.g. "depth_m"; valid until
 * the model is freed, empty beyond the last. */
PALPATE_API size_t palpate_model_feature_count(const palpate_model*);
PALPATE_API const char* palpate_model_feature_name(const palpate_model*, size_t index);
/* The model at `n` feature vectors, one after the other, in contact. force_N: trend + correction,
 * within the model's limits; bound_N: 95 of 100 errors stay below it, NaN where the model does
 * not know; trend_N: of the trend alone; outside: 1 out of the domain. Each may be NULL.
 * Returns 0, or -1 for a NULL model or NULL features. Any thread. */
PALPATE_API int palpate_model_evaluate(const palpate_model*, size_t n, const double* features, double* force_N,
                                       double* bound_N, double* trend_N, unsigned char* outside);
/* The just noticeable difference at a force, by the model's line; NULL model: that of Hoever and
 * Harders (2009), 0.065 N + 0.0633 |force_N|. */
PALPATE_API double palpate_jnd_N(const palpate_model*, double force_N);

/* ---- streams ---- */

/* What is known of the sensor behind the positions. */
typedef struct palpate_sensor {
  double encoder_step_m;              /* 0: not quantised */
  double position_noise_m;            /* standard deviation beside the quantisation */
  double velocity_noise_m_per_s;      /* counts with has_velocity; then > 0 */
  double acceleration_noise_m_per_s2; /* counts with has_acceleration; then > 0 */
  int has_velocity;                   /* samples come with a measured velocity */
  int has_acceleration;               /* samples come with a measured acceleration */
} palpate_sensor;

/* Positions alone, in steps of encoder_step_m (>= 0). 0 where unknown: the sensor is then
 * that of the recordings which the model was fitted to, noise beside the steps included,
 * and so it is when the step is theirs. The same positions as in a recording of that rig
 * give replay's forces to the last bit. Positions that are exact, or of another sensor
 * with noise: palpate_stream_new_with_sensor. Slow side. */
PALPATE_API palpate_stream* palpate_stream_new(const palpate_model*, double encoder_step_m, char* error,
                                               size_t error_size);
/* With everything that is known, as it is. NULL: a number is negative or not finite. Slow side. */
PALPATE_API palpate_stream* palpate_stream_new_with_sensor(const palpate_model*, const palpate_sensor*, char* error,
                                                           size_t error_size);
/* The sensor that made a recording, as replay finds it from the first 30,000 rows. Its
 * encoder_step_m is 0 when the positions are not in whole steps; position_noise_m is then
 * their noise. Slow side.
 * Returns 0, or -1: the file is no recording. */
PALPATE_API int palpate_sensor_of_recording(const char* path, palpate_sensor*, char* error, size_t error_size);
/* The same of `n` samples in memory; velocity and acceleration may be NULL. Returns 0, or -1 for NULL. */
PALPATE_API int palpate_sensor_of_samples(size_t n, const double* time_s, const double* position_m,
                                          const double* velocity_m_per_s, const double* acceleration_m_per_s2,
                                          palpate_sensor*);

/* The samples that error figures are over, as replay counts them: a position above 0, or a measured
 * force beyond both the JND at 0 N and five times its noise. in_contact: receives 1 or 0 for each.
 * Returns 0, or -1 for NULL. */
PALPATE_API int palpate_in_contact(size_t n, const double* position_m, const double* force_N,
                                   unsigned char* in_contact);

PALPATE_API void palpate_stream_free(palpate_stream*);
/* Forgets motion and filters; the next sample begins a new contact. Wait-free. */
PALPATE_API void palpate_stream_reset(palpate_stream*);

/* The next sample; returns the force in N: at most 1.2 times the largest force that the model was
 * fitted to, and below 0 only where that material pulled, never beyond its strongest pull. A value that is not finite,
 * or a time that is not later than the last one: 0 N, and the state is kept. Wait-free: no allocation, lock, system
 * call. */
PALPATE_API double palpate_stream_force(palpate_stream*, double time_s, double position_m);
/* The same with measured velocity and acceleration; a channel that the sensor does not
 * have is ignored, whatever is in it. */
PALPATE_API double palpate_stream_force_with_motion(palpate_stream*, double time_s, double position_m,
                                                    double velocity_m_per_s, double acceleration_m_per_s2);

/* The next `n` samples: forces and errors as palpate_stream_force and
 * palpate_stream_predicted_error give them one by one. bound_N may be NULL. Wait-free.
 * Returns 0, or -1 for NULL. */
PALPATE_API int palpate_stream_forces(palpate_stream*, size_t n, const double* time_s, const double* position_m,
                                      double* force_N, double* bound_N);
/* The same with what the sensor measures beside the position (NULL: nothing), and with the feature
 * vectors, one after the other. Each of the results may be NULL. */
PALPATE_API int palpate_stream_forces_with_motion(palpate_stream*, size_t n, const double* time_s,
                                                  const double* position_m, const double* velocity_m_per_s,
                                                  const double* acceleration_m_per_s2, double* force_N, double* bound_N,
                                                  double* features);

/* Of the last sample that was taken: 1 when its motion is unlike the recordings, so that
 * the force is the model's safe trend; 0 otherwise, and out of contact. Wait-free. */
PALPATE_API int palpate_stream_out_of_domain(const palpate_stream*);
/* Of the same sample: the error that 95 of 100 samples stay below, in N. 0 out of contact;
 * NaN when the model does not know. Wait-free. */
PALPATE_API double palpate_stream_predicted_error(const palpate_stream*);

/* ---- the last word before an actuator ---- */

/* In this order: no force while something is wrong; a ramp after the start and each such
 * stop; |force| <= largest_N, less when the motor warms up; a limited rate of change. */
typedef struct palpate_limits {
  double largest_N;       /* peak, > 0 */
  double fastest_N_per_s; /* > 0 */
  double ramp_s;          /* >= 0 */
  double continuous_N;    /* may be held for ever, > 0; infinite: no thermal budget */
  double thermal_time_s;  /* of the motor's winding, > 0 */
  double stale_after_s;   /* age of a sample that is too old to push by, > 0 */
  double stop_s;          /* from any force to none, >= 0 */
} palpate_limits;

enum { /* what the limiter did to a force: bits of palpate_limiter_flags */
       PALPATE_LIMIT_NOT_FINITE = 1,
       PALPATE_LIMIT_CLAMPED = 2,
       PALPATE_LIMIT_SLEWED = 4,
       PALPATE_LIMIT_RAMPING = 8,
       PALPATE_LIMIT_THERMAL = 16,
       PALPATE_LIMIT_STALE = 32,
       PALPATE_LIMIT_STOPPED = 64
};

/* 10 N, 5000 N/s, ramp 0.3 s, no thermal budget, stale after 10 ms, stop within 10 ms. */
PALPATE_API void palpate_limits_default(palpate_limits*);
/* NULL limits: the default ones. NULL: a limit is out of its range. Slow side. */
PALPATE_API palpate_limiter* palpate_limiter_new(const palpate_limits*, char* error, size_t error_size);
PALPATE_API void palpate_limiter_free(palpate_limiter*);
/* The force to render instead of `commanded_N`, always finite. `step_s`: since the last
 * call; `sample_age_s`: of the sample behind the force, 0 when it is new. Wait-free. */
PALPATE_API double palpate_limiter_force(palpate_limiter*, double commanded_N, double step_s, double sample_age_s);
/* Device fault, released dead-man switch: the next force goes to 0. Once per tick while it
 * lasts. Wait-free. */
PALPATE_API void palpate_limiter_stop(palpate_limiter*);
PALPATE_API unsigned palpate_limiter_flags(const palpate_limiter*);

#ifdef __cplusplus
}
#endif

#endif
