// A Hapkit in simavr: the firmware of devices/firmware/hapkit on an emulated ATmega328P in
// real time, with its serial port on a pseudo-terminal. A simulated hand moves the handle. It
// presses a block, whose force the load cell measures (--material NAME), or only feels the
// force of the motor.
//
//   palpate_hapkit_board FIRMWARE.elf [--material NAME] [--seed N]
//
// Prints the port, then a line each time the motor's pins start or stop driving, with the
// emulated time and the time since the last byte from the host. Exits at the end of its input.
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <simavr/avr_adc.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "devices/virtual/simulated_devices.h"
#include "engine/base/random_stream.h"
#include "engine/live/pacer.h"
#include "scenes/material/rig.h"

namespace {

constexpr double kClock_Hz = 16e6;
constexpr std::uint64_t kByteCycles = 160;  // 1 Mbaud
constexpr int kSlicesPerStep = 16;
constexpr double kStep_s = kByteCycles * kSlicesPerStep / kClock_Hz;  // 160 us
// As in hapkit.cpp.
constexpr double kMetresPerCount = 14.008e-6;
constexpr double kSensorRange = 980.0;
constexpr double kForceZero = 102.0, kNewtonsPerCount = 0.01;
constexpr double kStall_N = 0.000107 * 255.0 * 255.0;
constexpr double kNoise = 0.5;         // counts
constexpr double kAtSurface_s = 0.15;  // the tool rests at the surface while the board starts
// Registers of the ATmega328P.
constexpr int kPortB = 0x25, kTccr0a = 0x44, kOcr0b = 0x48;

struct Bench {
  avr_t* avr = nullptr;
  int pty = -1;
  std::deque<std::uint8_t> to_board;
  std::vector<std::uint8_t> from_board;
  std::uint64_t last_byte_cycle = 0, last_high_cycle = 0;
  palpate::RandomStream noise{7, 0};

  double now_ms() const { return 1e3 * static_cast<double>(avr->cycle) / kClock_Hz; }
};

void on_sent(avr_irq_t*, std::uint32_t value, void* bench) {
  static_cast<Bench*>(bench)->from_board.push_back(static_cast<std::uint8_t>(value));
}
void on_pwm_pin(avr_irq_t*, std::uint32_t value, void* bench) {
  auto* self = static_cast<Bench*>(bench);
  if (value != 0) self->last_high_cycle = self->avr->cycle;
}

void fail(const char* what) {
  std::fprintf(stderr, "error: %s\n", what);
  std::exit(1);
}

void start_board(Bench& bench, const char* elf) {
  elf_firmware_t firmware{};
  if (elf_read_firmware(elf, &firmware) != 0) fail("cannot read the firmware");
  bench.avr = avr_make_mcu_by_name("atmega328p");
  if (bench.avr == nullptr) fail("simavr knows no ATmega328P");
  avr_init(bench.avr);
  firmware.frequency = static_cast<std::uint32_t>(kClock_Hz);
  avr_load_firmware(bench.avr, &firmware);
  bench.avr->log = LOG_ERROR;
  bench.avr->vcc = bench.avr->avcc = bench.avr->aref = 5000;
  std::uint32_t flags = 0;
  avr_ioctl(bench.avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POOL_SLEEP);
  avr_ioctl(bench.avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  avr_irq_register_notify(avr_io_getirq(bench.avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_sent, &bench);
  avr_irq_register_notify(avr_io_getirq(bench.avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 5), on_pwm_pin, &bench);
}

// Opens the pseudo-terminal of the port, without echo, and prints its name.
void open_port(Bench& bench) {
  int line = -1;
  char name[128];
  termios raw{};
  cfmakeraw(&raw);
  if (openpty(&bench.pty, &line, name, &raw, nullptr) != 0) fail("no pseudo-terminal");
  fcntl(bench.pty, F_SETFL, O_NONBLOCK);
  // `line` stays open, so that the port stays when the host closes it.
  std::printf("%s\n", name);
  std::fflush(stdout);
}

void set_volts(Bench& bench, int channel, double counts) {
  const double noisy = std::clamp(counts + kNoise * bench.noise.normal(), 0.0, 1023.0);
  avr_raise_irq(avr_io_getirq(bench.avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + channel),
                static_cast<std::uint32_t>(std::lround(noisy * 5000.0 / 1024.0)));
}

void exchange_bytes(Bench& bench) {
  std::uint8_t bytes[4096];
  const ssize_t came = read(bench.pty, bytes, sizeof bytes);
  for (ssize_t i = 0; i < came; ++i) bench.to_board.push_back(bytes[i]);
  if (bench.from_board.empty()) return;
  // Bytes that the host does not read are lost, as on a wire.
  [[maybe_unused]] const ssize_t written = write(bench.pty, bench.from_board.data(), bench.from_board.size());
  bench.from_board.clear();
}

void run_slices(Bench& bench) {
  avr_irq_t* const input = avr_io_getirq(bench.avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  for (int i = 0; i < kSlicesPerStep; ++i) {
    if (!bench.to_board.empty()) {
      avr_raise_irq(input, bench.to_board.front());
      bench.to_board.pop_front();
      bench.last_byte_cycle = bench.avr->cycle;
    }
    for (const std::uint64_t until = bench.avr->cycle + kByteCycles; bench.avr->cycle < until;) {
      const int state = avr_run(bench.avr);
      if (state == cpu_Done || state == cpu_Crashed) fail("the firmware crashed");
    }
  }
}

double motor_N(const Bench& bench) {
  const std::uint8_t* const data = bench.avr->data;
  if ((data[kTccr0a] & 0x20) == 0) return 0.0;
  const double duty = data[kOcr0b] / 255.0;
  return ((data[kPortB] & 1) != 0 ? kStall_N : -kStall_N) * duty * duty;
}

// Whether the pins drove the motor within the last PWM periods.
bool drives(const Bench& bench) {
  return motor_N(bench) != 0.0 || (bench.last_high_cycle != 0 && bench.avr->cycle - bench.last_high_cycle < 1024);
}

}  // namespace

int main(int argc, char** argv) {
  std::string material_name;
  std::uint64_t seed = 1;
  for (int i = 2; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--material") == 0) material_name = argv[i + 1];
    if (std::strcmp(argv[i], "--seed") == 0) seed = std::strtoull(argv[i + 1], nullptr, 10);
  }
  if (argc < 2) fail("names no firmware");
  palpate::HandDevice feeling(seed);  // without a material
  std::unique_ptr<palpate::HandMotion> hand;
  std::unique_ptr<palpate::Block> block;
  if (!material_name.empty()) {
    const auto material = palpate::find_material(material_name);
    if (!material) fail(material.error().message.c_str());
    hand = std::make_unique<palpate::Hand>(
        *material, palpate::HandSettings{.strongest_press_N = material->strongest_press_N}, seed);
    block = material->make_block();
  }
  Bench bench;
  start_board(bench, argv[1]);
  open_port(bench);
  // D4 on ground: the load cell is present.
  avr_ioport_external_t cell{};
  cell.name = 'D';
  cell.mask = 1 << 4;
  cell.value = block != nullptr ? 0 : 1 << 4;
  avr_ioctl(bench.avr, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &cell);
  // Real-time priority, because a board does not wait for other programs. The system ends it where it is too slow to
  // sleep for so long, and when the test ends without closing its input.
  constexpr rlimit kWithoutSleep_us{10'000'000, 10'000'000};
  setrlimit(RLIMIT_RTTIME, &kWithoutSleep_us);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  palpate::make_this_thread_realtime(10, false);
  palpate::SteadyPacer pacer;
  std::int64_t start_ns = pacer.now_ns();
  double position_m = 0.0, force_N = 0.0;
  bool drove = false, moving = false;
  for (std::uint64_t step = 1;; ++step) {
    const double now_s = kStep_s * static_cast<double>(step);
    if (now_s > kAtSurface_s) {
      if (!moving && block != nullptr) hand->resume_at(0.0);
      if (!moving) feeling.resume_at(0.0, now_s - kStep_s);
      moving = true;
      constexpr int kSubsteps = 4;
      for (int i = 0; i < kSubsteps && block != nullptr; ++i) {
        const double dt_s = kStep_s / kSubsteps;
        hand->move(dt_s);
        force_N = block->step(hand->position_m(), hand->velocity_m_per_s(), dt_s);
        hand->feel(force_N + motor_N(bench), dt_s);
      }
      palpate::DeviceSample sample;
      feeling.write(motor_N(bench));
      feeling.read(now_s, sample);
      position_m = block != nullptr ? hand->position_m() : sample.tool.position_m;
    }
    const double counts = position_m / kMetresPerCount + 0.5 * kSensorRange;
    set_volts(bench, 2, counts - kSensorRange * std::floor(counts / kSensorRange));
    set_volts(bench, 3, kForceZero + force_N / kNewtonsPerCount);
    exchange_bytes(bench);
    run_slices(bench);
    if (drives(bench) != drove) {
      drove = !drove;
      std::printf("%s %.2f ms, %.2f ms after the last byte\n", drove ? "drives" : "zero", bench.now_ms(),
                  1e3 * static_cast<double>(bench.avr->cycle - bench.last_byte_cycle) / kClock_Hz);
      std::fflush(stdout);
    }
    const std::int64_t due_ns = start_ns + static_cast<std::int64_t>(1e9 * now_s);
    if (const std::int64_t late_ns = pacer.now_ns() - due_ns; late_ns > 50'000'000) {
      // The machine stalled, and the simulated hand with it. hapkit_test.cpp then repeats its recording.
      if (block != nullptr) {
        std::printf("held up %.0f ms\n", 1e-6 * static_cast<double>(late_ns));
        std::fflush(stdout);
      }
      if (late_ns > 200'000'000) start_ns += late_ns;  // a long delay is not caught up
    }
    pacer.wait_until(due_ns);
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char none[64];
    if (step % 64 == 0 && poll(&input, 1, 0) == 1 && read(STDIN_FILENO, none, sizeof none) == 0) return 0;
  }
}
