// A haptic paddle on a Teensy 3.x or 4.x: an encoder, a motor with an H bridge, a switch on the handle. Pins and
// constants are those of one paddle: set them to yours, and do the first test without a hand on the handle. For the
// Arduino IDE; the library Encoder is part of Teensyduino.
#pragma once

#include <Encoder.h>

constexpr int kEncoderA = 2, kEncoderB = 3;
constexpr int kPwm = 5, kDirection = 6, kMotorFaultPin = 7;  // low: fault
constexpr int kGripPin = 8;                                  // low: held
constexpr int kFullScale_mA = 2000;                          // at a duty cycle of 100 %
constexpr int kPwmSteps = 4096;

class TeensyPaddle {
 public:
  TeensyPaddle() {
    pinMode(kDirection, OUTPUT);
    pinMode(kPwm, OUTPUT);
    digitalWrite(kPwm, LOW);
    pinMode(kMotorFaultPin, INPUT_PULLUP);
    pinMode(kGripPin, INPUT_PULLUP);
    analogWriteResolution(12);
    analogWriteFrequency(kPwm, 20000);
  }
  uint32_t now_us() { return micros(); }
  int32_t counts() { return encoder_.read(); }
  // A quadrature encoder cannot report faults.
  uint8_t condition() {
    return (digitalRead(kMotorFaultPin) == LOW ? palpate::bridge::kMotorFault : 0) |
           (digitalRead(kGripPin) == LOW ? palpate::bridge::kGrip : 0);
  }
  void set_current_mA(int32_t current_mA) {
    digitalWrite(kDirection, current_mA < 0 ? HIGH : LOW);
    analogWrite(kPwm, abs(current_mA) * (kPwmSteps - 1) / kFullScale_mA);
  }

 private:
  Encoder encoder_{kEncoderA, kEncoderB};
};
