/* Palpate's models for any program: load a model file, pass the tool's positions to it, get the force. C99, for every
 * language that can call C.
 *
 *   palpate_model *model = palpate_model_load("block.json", error, sizeof error);
 *   palpate_stream *stream = palpate_stream_new(model, 30e-6, error, sizeof error);
 *   palpate_limiter *limiter = palpate_limiter_new(NULL, error, sizeof error);
 *   for (;;) push(palpate_limiter_render(limiter, stream, time_s, position_m, time_s - before_s));
 *
 * Units are SI. position_m runs along the inward surface normal: 0 at the undisturbed surface, positive inside. If the
 * training recordings had their surface at another position, so has the model. Forces act along the outward normal,
 * positive when the material pushes the tool out.
 *
 * A stream runs the code of `palpate replay`: the same samples, with the same sensor (palpate_sensor_of), give the same
 * forces to the last bit.
 *
 * Errors: functions that can fail return NULL (or -1) and write one line of UTF-8 to `error`, truncated to `error_size`
 * bytes with the terminating zero; `error` may be NULL. No function throws, writes to a terminal, or changes the locale
 * or a signal handler. For a NULL handle forces are 0, errors NaN, flags 0 and texts empty. Freeing NULL does nothing;
 * freeing a handle twice, or using one that was freed, is undefined, as with free().
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

/* Increases when a function or a struct of this header changes its meaning or its layout. */
#define PALPATE_ABI_VERSION 3

/* The version of the linked library; a program compares it with PALPATE_ABI_VERSION. */
PALPATE_API int palpate_abi_version(void);
/* The version of palpate, "MAJOR.MINOR.PATCH"; MAJOR is PALPATE_ABI_VERSION. */
PALPATE_API const char* palpate_version(void);

typedef struct palpate_model palpate_model;     /* immutable, shareable between threads */
typedef struct palpate_stream palpate_stream;   /* one tool; one thread at a time */
typedef struct palpate_limiter palpate_limiter; /* one actuator; one thread at a time */

/* ---- models: slow side, allocate ---- */

/* Loads a model file of `palpate fit`. NULL: no such file, not a model, damaged. */
PALPATE_API palpate_model* palpate_model_load(const char* path, char* error, size_t error_size);
/* Frees the handle; streams of the model stay valid. */
PALPATE_API void palpate_model_free(palpate_model*);
/* The name, e.g. "greedy-100"; valid until the model is freed. */
PALPATE_API const char* palpate_model_name(const palpate_model*);
/* The output of `palpate fit --json` if this process fitted the model, else empty. Valid until the model is freed. */
PALPATE_API const char* palpate_model_report(const palpate_model*);
/* Writes the model file atomically. Returns 0, or -1: see error. */
PALPATE_API int palpate_model_save(const palpate_model*, const char* path, int overwrite, char* error,
                                   size_t error_size);
/* The number of features of the model, 1 to 8, and their names, e.g. "feature_depth_m"; valid until the model is freed,
 * empty for an index beyond the last. */
PALPATE_API size_t palpate_model_feature_count(const palpate_model*);
PALPATE_API const char* palpate_model_feature_name(const palpate_model*, size_t index);
/* ---- recordings ---- */

/* A recording, or the motion of a tool: `size` samples in columns. A column that was not measured, or that a function
 * does not use, may be NULL. */
typedef struct palpate_recording {
  const char* name; /* of a file, without folder and extension; appears in models that are fitted to the recording */
  size_t size;
  const double* time_s;
  const double* position_m;
  const double* force_N;
  const double* velocity_m_per_s;
  const double* acceleration_m_per_s2;
} palpate_recording;

/* Reads a recording file. NULL: see error, which has file, line and column. Slow side. */
PALPATE_API palpate_recording* palpate_recording_load(const char* path, char* error, size_t error_size);
/* Frees a recording of palpate_recording_load with its columns. */
PALPATE_API void palpate_recording_free(palpate_recording*);
/* Marks the samples in contact, over which replay computes its errors: a position above 0, or a measured force beyond
 * both the JND at 0 N and five times its noise. in_contact: receives 1 or 0 for each sample. Returns 0, or -1 if a
 * pointer or a column that is needed is NULL. */
PALPATE_API int palpate_in_contact(const palpate_recording*, unsigned char* in_contact);

/* ---- streams ---- */

/* The sensor of the tool. */
typedef struct palpate_sensor {
  double encoder_step_m;              /* 0: exact */
  double position_noise_m;            /* standard deviation in addition to the quantisation */
  double velocity_noise_m_per_s;      /* standard deviation of measured velocities; 0: none are measured */
  double acceleration_noise_m_per_s2; /* standard deviation of measured accelerations; 0: none are measured */
} palpate_sensor;

/* A stream of positions alone, quantised in steps of encoder_step_m (>= 0). If it is 0 (unknown) or the step of the
 * model's training recordings, the sensor is theirs, with its noise. The same positions as in a recording of that rig
 * then give bit-identical forces to replay. For exact positions, or another sensor with noise, use
 * palpate_stream_new_with_sensor. Slow side. */
PALPATE_API palpate_stream* palpate_stream_new(const palpate_model*, double encoder_step_m, char* error,
                                               size_t error_size);
/* A stream with exactly this sensor. NULL: a number is out of its range or not finite. Slow side. */
PALPATE_API palpate_stream* palpate_stream_new_with_sensor(const palpate_model*, const palpate_sensor*, char* error,
                                                           size_t error_size);
/* The sensor of a recording, as identified by replay from the first 30,000 samples. encoder_step_m is 0 if the
 * positions are not quantised; position_noise_m is then their noise. Slow side. Returns 0, or -1 for NULL. */
PALPATE_API int palpate_sensor_of(const palpate_recording*, palpate_sensor*);

/* Resets the stream; its next samples continue this recording of the same rig, whose presses the material remembers.
 * Otherwise a stream begins at rest. Slow side. Returns 0, or -1 without a stream, a sample, a time or a position. */
PALPATE_API int palpate_stream_start_after(palpate_stream*, const palpate_recording*, char* error, size_t error_size);

PALPATE_API void palpate_stream_free(palpate_stream*);
/* Resets the motion estimate and the filters; the next sample may have any time. Wait-free. */
PALPATE_API void palpate_stream_reset(palpate_stream*);

/* Takes the next sample and returns the force in N: at most 1.2 times the largest training force, and negative only for
 * a material that pulls, at most as strongly as it did in the training. Values that are not finite, and a time that is
 * not later than the last one, return 0 N and leave the state as it is. Times that go back by more than 0.1 s are a new
 * stream from the second sample on. Where a few samples, within 0.1 s, had wrong times, the stream continues from its
 * state before them. Wait-free: no allocation, lock, system call. */
PALPATE_API double palpate_stream_force(palpate_stream*, double time_s, double position_m);
/* The same with measured velocity and acceleration; a channel that the sensor does not have is ignored. */
PALPATE_API double palpate_stream_force_with_motion(palpate_stream*, double time_s, double position_m,
                                                    double velocity_m_per_s, double acceleration_m_per_s2);

/* Takes the next `n` samples. The results equal those of palpate_stream_force and palpate_stream_predicted_error for
 * each sample. bound_N may be NULL. Wait-free. Returns 0, or -1 for NULL. */
PALPATE_API int palpate_stream_forces(palpate_stream*, size_t n, const double* time_s, const double* position_m,
                                      double* force_N, double* bound_N);
/* The same for the motion of a recording. A channel that the stream's sensor measures needs its column. features:
 * receives size x feature_count values, one feature vector after the other. Each of the results may be NULL. */
PALPATE_API int palpate_stream_replay(palpate_stream*, const palpate_recording*, double* force_N, double* bound_N,
                                      double* features);

/* 1 if the last call took its sample, 0 if it refused it (a value that is not finite, a time that is not later) or
 * there was none. The 0 N of a refused sample are no force of the material. Wait-free. */
PALPATE_API int palpate_stream_accepted(const palpate_stream*);
/* 1 if the motion at the last accepted sample was out of the domain of the recordings, so that the force is
 * mainly the model's trend; otherwise, and out of contact, 0. Wait-free. */
PALPATE_API int palpate_stream_out_of_domain(const palpate_stream*);
/* The 95 % bound on the error of the force at the same sample, N. 0 out of contact; NaN if the model has none.
 * Wait-free. */
PALPATE_API double palpate_stream_predicted_error(const palpate_stream*);

/* ---- before an actuator ---- */

/* The limiter applies, in this order: no force during a fault; a ramp after the start and after each fault;
 * |force| <= largest_N, less when the motor warms up; a limited rate of change. */
typedef struct palpate_limits {
  double largest_N;       /* peak, > 0 */
  double fastest_N_per_s; /* > 0 */
  double ramp_s;          /* >= 0 */
  double continuous_N;    /* force that the motor can hold permanently, > 0; infinite: no thermal limit */
  double thermal_time_s;  /* time constant of the motor's winding, > 0 */
  double stale_after_s;   /* maximum age of a sample, > 0 */
  double stop_s;          /* time to reduce any force to 0, >= 0 */
} palpate_limits;

enum { /* bits of palpate_limiter_flags: what the limiter did to the last force */
       PALPATE_LIMIT_NOT_FINITE = 1,
       PALPATE_LIMIT_CLAMPED = 2,
       PALPATE_LIMIT_SLEWED = 4,
       PALPATE_LIMIT_RAMPING = 8,
       PALPATE_LIMIT_THERMAL = 16,
       PALPATE_LIMIT_STALE = 32,
       PALPATE_LIMIT_STOPPED = 64,
       PALPATE_LIMIT_REDUCED = 128,    /* palpate_limiter_stiffness_share is below 0.95 */
       PALPATE_LIMIT_WRONG_STEP = 256, /* step_s and time_s differ by more than a quarter */
       PALPATE_LIMIT_PASSIVE = 512     /* the passivity controller takes more than a JND of the force */
};

/* 10 N, 2000 N/s, ramp 0.3 s, no thermal limit, stale after 10 ms, stop within 10 ms. */
PALPATE_API void palpate_limits_default(palpate_limits*);
/* NULL limits: the defaults. Returns NULL if a limit is out of its range. Slow side. */
PALPATE_API palpate_limiter* palpate_limiter_new(const palpate_limits*, char* error, size_t error_size);
PALPATE_API void palpate_limiter_free(palpate_limiter*);
/* The force on a hand: takes the next sample into the stream and returns what to render, always finite. The model's
 * force passes the stages of the program's own loop: the stiffness that a hand can hold stably with the lag of the
 * loop, the passivity controller, the limiter. `step_s`: since the last call, measured; where time_s shows longer
 * steps, those count. A sample that is not later than the last one, or not within the reach of a hand (20 mm, 10 m/s),
 * holds the force, until the last one is stale_after_s old. One that is not finite, and 96 calls or samples a second
 * or fewer (100, less the error of a clock), stop it: PALPATE_LIMIT_STOPPED. One limiter belongs to one stream.
 * Wait-free. */
PALPATE_API double palpate_limiter_render(palpate_limiter*, palpate_stream*, double time_s, double position_m,
                                          double step_s);
/* The lag of the force behind the motion for palpate_limiter_render: transport there and back, waits, and half the time
 * for which a force is held. It cannot be measured from here but by palpate_limiter_acted. The default, and the least,
 * is 1.5 times the interval between calls or samples. Returns 0, or -1 for a value below 0 or not finite, which is
 * ignored. Wait-free. */
PALPATE_API int palpate_limiter_set_lag(palpate_limiter*, double lag_s);
/* For a device that reports which command acts; called before each palpate_limiter_render: the force that acted at the
 * sample to come was computed from the sample of the time sampled_s. The limiter measures the lag from these times, as
 * the program does, and there is no force before the first is known; NaN: it is not. Wait-free. */
PALPATE_API void palpate_limiter_acted(palpate_limiter*, double sampled_s);
/* The part of the model's force that the stability limit leaves with this lag: 1 is all. Below 0.95
 * PALPATE_LIMIT_REDUCED is set. For palpate_limiter_render. Wait-free. */
PALPATE_API double palpate_limiter_stiffness_share(const palpate_limiter*);
/* The limiter alone: the force to render instead of `commanded_N`, always finite. `step_s`: since the last call;
 * `sample_age_s`: age of the sample that the force was computed from, 0 for a new one. Wait-free. */
PALPATE_API double palpate_limiter_force(palpate_limiter*, double commanded_N, double step_s, double sample_age_s);
/* Reports a device fault or a released dead-man switch: the next force goes towards 0. To be called once per tick while
 * the fault lasts. Wait-free. */
PALPATE_API void palpate_limiter_stop(palpate_limiter*);
PALPATE_API unsigned palpate_limiter_flags(const palpate_limiter*);

#ifdef __cplusplus
}
#endif

#endif
