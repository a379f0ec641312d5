// Firmware of a Hapkit board (ATmega328P at 16 MHz) as a device of `bridge:`, with 1000 samples per second over its
// serial port at 1 Mbaud. To build and to load, in the project's folder:
//   avr-g++ -std=c++11 -Os -mmcu=atmega328p -I . devices/firmware/hapkit/hapkit.cpp -o hapkit.elf
//   avr-objcopy -O ihex hapkit.elf hapkit.hex
//   avrdude -p m328p -c arduino -P /dev/ttyUSB0 -b 115200 -U flash:w:hapkit.hex
// Pins of the Hapkit board: PWM D5, direction D8, magnetic sensor A2. If D4 is on ground, the amplified load cell of a
// tool is on A3. The constants are those of one Hapkit: measure yours, and do the first test without a hand on the
// handle. The position is 0 where the board started.
#include <avr/interrupt.h>
#include <avr/io.h>

#include "devices/firmware/bridge_firmware.h"

namespace {

// Distance of the handle for one count of the sensor: 0.0107 degrees of the sector, with the handle at 75 mm. Each
// sample sums kAdditions conversions of a channel; twelve conversions of 52 us and their interrupts fit into 1 ms.
constexpr uint8_t kAdditions = 6;
constexpr int32_t kNmPerCount = 14008;
constexpr int16_t kSensorRange = 980;  // counts between two flips of the magnet
constexpr int32_t kForce_uNPerCount = 10000;
constexpr int32_t kForceZero = 102;  // counts
// The stall force of the motor at the handle is 7 N, at a duty of 255. The force is proportional to the square of the
// duty: force in uN = kuNPerDutySquared * duty^2.
constexpr int32_t kuNPerDutySquared = 107;
constexpr int32_t kMost_uN = 5000000;
constexpr uint8_t kPosition = 2, kForce = 3;  // channels

// Sums of the running conversions and of the finished ones, and the time of the finished ones.
volatile int32_t sums[2], ready[2];
volatile uint16_t ready_at;
volatile uint8_t conversions = 0, samples = 0;
volatile uint32_t wraps = 0;  // of timer 1
uint8_t seen = 0;

// Rings of bytes between the serial port and the loop; a power of two.
constexpr uint8_t kRing = 64;
volatile uint8_t in_ring[kRing], out_ring[kRing];
volatile uint8_t in_written = 0, in_read = 0, out_written = 0, out_read = 0;

uint16_t square_root(uint32_t value) {
  uint16_t root = 0;
  for (uint16_t bit = 1u << 15; bit != 0; bit >>= 1) {
    const uint16_t trial = root | bit;
    if (static_cast<uint32_t>(trial) * trial <= value) root = trial;
  }
  return root;
}

class Hapkit {
 public:
  uint32_t now_us() {
    const uint8_t saved = SREG;
    cli();
    const uint16_t ticks = TCNT1;
    uint32_t high = wraps;
    // The timer has wrapped, but its interrupt is pending: counts the wrap here.
    if ((TIFR1 & (1 << TOV1)) != 0 && ticks < 0x8000) ++high;
    SREG = saved;
    return (high << 15) | (ticks >> 1);
  }

  bool receive(uint8_t& byte) {
    if (in_read == in_written) return false;
    byte = in_ring[in_read % kRing];
    ++in_read;
    return true;
  }

  bool sample(uint32_t& time_us, int32_t& position_nm, int32_t& force_uN) {
    if (samples == seen) return false;
    cli();
    seen = samples;
    const int32_t position = ready[0], force = ready[1];
    time_us = now_us() - static_cast<uint16_t>(TCNT1 - ready_at) / 2;
    sei();
    position_nm = position * (kNmPerCount / kAdditions);
    const bool fitted = (PIND & (1 << PIND4)) == 0;
    force_uN =
        fitted ? (force - kForceZero * kAdditions) * (kForce_uNPerCount / kAdditions) : palpate::bridge::kNoForce;
    return true;
  }

  uint8_t condition() { return 0; }  // the board detects neither faults nor a grip

  void push(int32_t force_uN) {
    const uint32_t size_uN = static_cast<uint32_t>(force_uN < 0 ? -force_uN : force_uN);
    if (size_uN < kuNPerDutySquared) {
      // A duty of 0 would still give a spike in every period.
      TCCR0A &= static_cast<uint8_t>(~(1 << COM0B1));
      PORTD &= static_cast<uint8_t>(~(1 << PORTD5));
      return;
    }
    const uint16_t duty = square_root(size_uN / kuNPerDutySquared);
    if (force_uN > 0) PORTB |= 1 << PORTB0;
    if (force_uN < 0) PORTB &= static_cast<uint8_t>(~(1 << PORTB0));
    OCR0B = duty > 255 ? 255 : static_cast<uint8_t>(duty);
    TCCR0A |= 1 << COM0B1;
  }

  // A frame for which there is no room is dropped; the next one replaces it.
  void send(const uint8_t* frame) {
    if (static_cast<uint8_t>(out_written - out_read) > kRing - palpate::bridge::kDeviceBytes) return;
    for (unsigned i = 0; i < palpate::bridge::kDeviceBytes; ++i) {
      out_ring[out_written % kRing] = frame[i];
      ++out_written;
    }
    UCSR0B |= 1 << UDRIE0;
  }
};

}  // namespace

// Unwraps the periodic field of the magnet: a large step is a flip. Returns counts since the start.
static int32_t unwrapped(int16_t counts) {
  static int16_t last = -1;
  static int32_t total = 0;
  if (last < 0) last = counts;
  int16_t step = counts - last;
  if (step > kSensorRange / 2) step -= kSensorRange;
  if (step < -kSensorRange / 2) step += kSensorRange;
  last = counts;
  return total += step;
}

ISR(TIMER1_OVF_vect) { ++wraps; }

// Runs the conversions of one channel after the other; they start again at the next millisecond.
ISR(ADC_vect) {
  const uint8_t which = conversions / kAdditions;
  sums[which] += which == 0 ? unwrapped(static_cast<int16_t>(ADC)) : static_cast<int32_t>(ADC);
  ++conversions;
  if (conversions < 2 * kAdditions) {
    ADMUX = static_cast<uint8_t>((1 << REFS0) | (conversions < kAdditions ? kPosition : kForce));
    ADCSRA |= 1 << ADSC;
  } else {
    ready[0] = sums[0];
    ready[1] = sums[1];
    ready_at = TCNT1;
    ++samples;
  }
}

// Starts the conversions every millisecond.
ISR(TIMER1_COMPA_vect) {
  OCR1A += 2000;
  conversions = 0;
  sums[0] = sums[1] = 0;
  ADMUX = (1 << REFS0) | kPosition;
  ADCSRA |= 1 << ADSC;
}

ISR(USART_RX_vect) {
  const uint8_t byte = UDR0;
  if (static_cast<uint8_t>(in_written - in_read) == kRing) return;
  in_ring[in_written % kRing] = byte;
  ++in_written;
}

ISR(USART_UDRE_vect) {
  if (out_read == out_written) {
    UCSR0B &= static_cast<uint8_t>(~(1 << UDRIE0));
    return;
  }
  UDR0 = out_ring[out_read % kRing];
  ++out_read;
}

int main() {
  PORTD = 1 << PORTD4;  // pull-up; the pins of the motor are low before they become outputs
  PORTB = 0;
  DDRD = 1 << DDD5;
  DDRB = 1 << DDB0;
  TCCR0A = (1 << WGM01) | (1 << WGM00);  // fast PWM, 62.5 kHz
  TCCR0B = 1 << CS00;
  TCCR1A = 0;
  TCCR1B = 1 << CS11;  // half microseconds
  OCR1A = 2000;
  TIMSK1 = (1 << TOIE1) | (1 << OCIE1A);
  ADCSRA = (1 << ADEN) | (1 << ADIE) | (1 << ADPS2) | (1 << ADPS1);  // 250 kHz
  UCSR0A = 1 << U2X0;
  UBRR0 = 1;  // 1 Mbaud
  UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
  UCSR0B = (1 << RXEN0) | (1 << TXEN0) | (1 << RXCIE0);
  sei();
  Hapkit board;
  palpate::bridge::Firmware<Hapkit> firmware(board, kMost_uN);
  for (;;) firmware.loop();
}
