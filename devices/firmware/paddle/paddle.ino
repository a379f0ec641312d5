// Reference firmware of a haptic paddle on a Teensy 3.x or 4.x (an encoder, a motor with an H bridge, a switch on the
// handle) as a device of `bridge:`, with 1000 samples per second over the Teensy's USB serial port:
// `--device bridge:/dev/ttyACM0`. Copy the headers of .. into the sketch; the library Encoder is part of Teensyduino.
// Pins and constants are those of one paddle: set them to yours, measure kMost_uN, and do the first test without a hand
// on the handle. The position is 0 where the board started.
#include <Encoder.h>

#include "wire.h"
#include "bridge_protocol.h"
#include "bridge_firmware.h"

constexpr int kEncoderA = 2, kEncoderB = 3;
constexpr int kPwm = 5, kDirection = 6, kMotorFaultPin = 7;  // low: fault
constexpr int kGripPin = 8;                                  // low: held
constexpr int kFullScale_mA = 2000;                          // at a duty cycle of 100 %
constexpr int kPwmSteps = 4096;
constexpr int32_t kNmPerCount = 20000;  // counts increase inward
constexpr int32_t kuNPerMilliampere = 4000;
constexpr int32_t kMost_uN = 5000000;

class Paddle {
 public:
  Paddle() {
    pinMode(kDirection, OUTPUT);
    pinMode(kPwm, OUTPUT);
    digitalWrite(kPwm, LOW);
    pinMode(kMotorFaultPin, INPUT_PULLUP);
    pinMode(kGripPin, INPUT_PULLUP);
    analogWriteResolution(12);
    analogWriteFrequency(kPwm, 20000);
  }
  uint32_t now_us() { return micros(); }
  bool receive(uint8_t& byte) {
    if (Serial.available() == 0) return false;
    byte = static_cast<uint8_t>(Serial.read());
    return true;
  }
  bool sample(uint32_t& time_us, int32_t& position_nm, int32_t& force_uN) {
    if (micros() - sampled_us_ < 1000) return false;
    time_us = sampled_us_ = micros();
    position_nm = encoder_.read() * kNmPerCount;
    force_uN = palpate::bridge::kNoForce;
    return true;
  }
  // A quadrature encoder cannot report faults.
  uint8_t condition() {
    return (digitalRead(kMotorFaultPin) == LOW ? palpate::bridge::kMotorFault : 0) |
           (digitalRead(kGripPin) == LOW ? palpate::bridge::kGrip : 0);
  }
  // Out of the block is towards smaller counts.
  void push(int32_t force_uN) {
    digitalWrite(kDirection, force_uN > 0 ? HIGH : LOW);
    analogWrite(kPwm, abs(force_uN / kuNPerMilliampere) * (kPwmSteps - 1) / kFullScale_mA);
  }
  // A frame for which there is no room is dropped; the next one replaces it.
  void send(const uint8_t* frame) {
    if (Serial.availableForWrite() >= static_cast<int>(palpate::bridge::kDeviceBytes))
      Serial.write(frame, palpate::bridge::kDeviceBytes);
  }

 private:
  Encoder encoder_{kEncoderA, kEncoderB};
  uint32_t sampled_us_ = 0;
};

Paddle* board = nullptr;
palpate::bridge::Firmware<Paddle>* firmware = nullptr;

void setup() {
  Serial.begin(1000000);
  board = new Paddle;
  firmware = new palpate::bridge::Firmware<Paddle>(*board, kMost_uN);
}

void loop() { firmware->loop(); }
