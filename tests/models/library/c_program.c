/* The C interface as a C99 program sees it: c_program MODEL.json RECORDING.csv NO_MODEL
 * Checks what wrong arguments give; then reads "time position" lines from standard input
 * and prints the force of each. */
#include <palpate/palpate.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "does not hold: %s\n", what);
  ++failures;
}

static void check_handles(const char* no_model) {
  char error[200] = "untouched";
  char tiny[4];
  expect(palpate_abi_version() == PALPATE_ABI_VERSION, "the ABI version is the header's");
  expect(palpate_model_load("/nowhere/model.json", error, sizeof error) == NULL, "no such file: NULL");
  expect(strstr(error, "/nowhere/model.json") != NULL, "the error names the file");
  expect(palpate_model_load(no_model, error, sizeof error) == NULL, "not a model: NULL");
  expect(strlen(error) > 0, "not a model: says why");
  expect(palpate_model_load(no_model, tiny, sizeof tiny) == NULL && strlen(tiny) < 4, "a short buffer holds the end");
  expect(palpate_model_load(no_model, NULL, 0) == NULL, "no buffer: NULL");
  expect(palpate_model_load(NULL, error, sizeof error) == NULL, "no path: NULL");
  expect(palpate_model_load(NULL, error, 0) == NULL, "a buffer of no bytes: NULL");
  palpate_model_free(NULL);
  expect(strcmp(palpate_model_name(NULL), "") == 0, "no model: no name");
  expect(palpate_stream_new(NULL, 0.0, error, sizeof error) == NULL, "a stream of no model: NULL");
  palpate_stream_free(NULL);
  palpate_stream_reset(NULL);
  expect(palpate_stream_force(NULL, 0.0, 0.001) == 0.0, "no stream: no force");
  expect(palpate_stream_out_of_domain(NULL) == 0, "no stream: not out of domain");
  expect(isnan(palpate_stream_predicted_error(NULL)), "no stream: nothing is predicted");
  expect(palpate_recording_load("/nowhere/rec.csv", error, sizeof error) == NULL, "no such recording: NULL");
  palpate_recording_free(NULL);
  expect(palpate_sensor_of(NULL, NULL) == -1, "no recording: -1");
  palpate_limits_default(NULL);
  palpate_limiter_free(NULL);
  palpate_limiter_stop(NULL);
  expect(palpate_limiter_force(NULL, 1.0, 0.001, 0.0) == 0.0, "no limiter: no force");
  expect(palpate_limiter_flags(NULL) == 0, "no limiter: no flags");
  expect(palpate_stream_accepted(NULL) == 0, "no stream: nothing is accepted");
  expect(palpate_limiter_render(NULL, NULL, 0.0, 0.001, 0.001) == 0.0, "no limiter: no force");
  palpate_limiter_set_lag(NULL, 0.001);
}

static void check_samples(const palpate_model* model) {
  char error[200];
  palpate_sensor sensor;
  palpate_stream* stream;
  memset(&sensor, 0, sizeof sensor);
  expect(palpate_stream_new(model, NAN, error, sizeof error) == NULL, "a step of NaN: NULL");
  expect(palpate_stream_new(model, -1e-6, error, sizeof error) == NULL, "a negative step: NULL");
  expect(strstr(error, "encoder_step_m") != NULL, "the error names the field");
  sensor.velocity_noise_m_per_s = -1.0;
  expect(palpate_stream_new_with_sensor(model, &sensor, error, sizeof error) == NULL, "a negative noise: NULL");
  expect(palpate_stream_new_with_sensor(model, NULL, error, sizeof error) == NULL, "no sensor: NULL");
  stream = palpate_stream_new(model, 0.0, error, sizeof error);
  expect(stream != NULL && strcmp(error, "") == 0, "a stream, and no error");
  expect(palpate_stream_force(stream, 0.0, -0.001) == 0.0, "in the air: no force");
  expect(palpate_stream_force(stream, 0.001, 0.003) > 0.0, "in the block: a force");
  expect(palpate_stream_force(stream, 0.001, 0.003) == 0.0, "the same time again: no force");
  expect(palpate_stream_force(stream, -1.0, 0.003) == 0.0, "time backwards: no force");
  expect(palpate_stream_force(stream, NAN, 0.003) == 0.0, "time NaN: no force");
  expect(palpate_stream_force(stream, 0.002, NAN) == 0.0, "position NaN: no force");
  expect(palpate_stream_force(stream, 0.002, INFINITY) == 0.0, "position infinite: no force");
  expect(palpate_stream_force(stream, 0.002, 1e300) >= 0.0, "a position beyond the world: some force");
  palpate_stream_reset(stream);
  expect(palpate_stream_force(stream, 0.0, 0.003) > 0.0, "after a reset time may begin again");
  palpate_stream_free(stream);
}

static void print_forces(const palpate_model* model, const char* path) {
  char error[200];
  double time_s, position_m;
  palpate_sensor sensor;
  palpate_stream* stream;
  palpate_recording* recording = palpate_recording_load(path, error, sizeof error);
  expect(palpate_sensor_of(recording, &sensor) == 0, error);
  palpate_recording_free(recording);
  stream = palpate_stream_new_with_sensor(model, &sensor, error, sizeof error);
  while (scanf("%lf %lf", &time_s, &position_m) == 2)
    printf("%.17g\n", palpate_stream_force(stream, time_s, position_m));
  palpate_stream_free(stream);
}

int main(int argc, char** argv) {
  char error[200];
  palpate_model* model;
  if (argc != 4) return 2;
  check_handles(argv[3]);
  model = palpate_model_load(argv[1], error, sizeof error);
  if (model == NULL) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  expect(strlen(palpate_model_name(model)) > 0, "a model has a name");
  check_samples(model);
  print_forces(model, argv[2]);
  palpate_model_free(model);
  return failures == 0 ? 0 : 1;
}
