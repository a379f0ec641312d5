/* loop MODEL.json [SECONDS]: a haptic loop at 1 kHz in C. Replace read_position_m and push by your device, which a
 * simulated finger stands for, and TRANSPORT_S by its delay. Real-time priority needs root or a limit "rtprio".
 *
 *   cc -std=c99 loop.c $(pkg-config --cflags --libs palpate_model) -o loop
 */
#define _GNU_SOURCE
#include <palpate/palpate.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>

#define PERIOD_NS 1000000L
#define TRANSPORT_S 0.0 /* from the encoder to this program, and from here to the motor */

static double finger_m = -1e-3, finger_m_per_s = 0.0; /* positive inside the block */

static double read_position_m(void) { return finger_m; }

static void push(double force_N) { /* a finger of 100 g goes to 3 mm and meets the force for 1 ms */
  const double drive_N = 300.0 * (3e-3 - finger_m) - 6.0 * finger_m_per_s;
  finger_m_per_s += 1e-9 * PERIOD_NS * (drive_N - force_N) / 0.1;
  finger_m += 1e-9 * PERIOD_NS * finger_m_per_s;
}

static double now_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void become_real_time(void) {
  struct sched_param priority;
  priority.sched_priority = 80;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) puts("no real-time priority: the loop will jitter more");
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) puts("memory is not locked: a page fault may delay the loop");
}

int main(int argc, char** argv) {
  char error[500];
  palpate_model* model = palpate_model_load(argc > 1 ? argv[1] : NULL, error, sizeof error);
  palpate_stream* stream = model == NULL ? NULL : palpate_stream_new(model, 0.0, error, sizeof error);
  palpate_limiter* limiter = stream == NULL ? NULL : palpate_limiter_new(NULL, error, sizeof error);
  const long ticks = 1000L * (argc > 2 ? atol(argv[2]) : 5);
  long tick, missed = 0;
  double before_s, worst_s = 0.0;
  struct timespec deadline;
  if (limiter == NULL) return fprintf(stderr, "error: %s\n", error), 1;
  become_real_time();
  clock_gettime(CLOCK_MONOTONIC, &deadline);
  before_s = now_s() - 1e-9 * PERIOD_NS;
  for (tick = 1; tick <= ticks; ++tick) {
    const double time_s = now_s(), step_s = time_s - before_s; /* of the sample; a device's own clock is better */
    const double force_N = palpate_limiter_render(limiter, stream, time_s, read_position_m(), step_s);
    double lag_s;
    push(force_N);
    /* The lag of this force: transport, from the sample to here, and half the time for which it is held. */
    lag_s = TRANSPORT_S + now_s() - time_s + 0.5 * step_s;
    if (lag_s > worst_s) worst_s = lag_s;
    before_s = time_s;
    if (tick % 500 == 0) { /* the largest of half a second, because a late force counts, not the mean */
      palpate_limiter_set_lag(limiter, worst_s);
      printf("force %.3f N, lag %.2f ms, stiffness share %.2f, flags %u, missed %ld\n", force_N, 1e3 * worst_s,
             palpate_limiter_stiffness_share(limiter), palpate_limiter_flags(limiter), missed);
      worst_s = 0.0;
    }
    deadline.tv_nsec += PERIOD_NS;
    if (deadline.tv_nsec >= 1000000000L) deadline.tv_nsec -= 1000000000L, ++deadline.tv_sec;
    if (now_s() > (double)deadline.tv_sec + 1e-9 * (double)deadline.tv_nsec) { /* too late: skip, never catch up */
      clock_gettime(CLOCK_MONOTONIC, &deadline);
      ++missed;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
  }
  push(0.0);
  palpate_limiter_free(limiter);
  palpate_stream_free(stream);
  palpate_model_free(model);
  return 0;
}
