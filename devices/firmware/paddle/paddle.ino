// Reference firmware of a haptic paddle for a Teensy 3.x or 4.x. In the Arduino
// IDE: Tools > USB Type > Raw HID; the library Encoder comes with Teensyduino.
// The pins and kMost_mA are those of one paddle: set them to yours, measure
// kMost_mA, and never try it first with a hand on the handle.
#include <EEPROM.h>
#include <Encoder.h>

#include "wire.h"
#include "paddle_protocol.h"
#include "paddle_firmware.h"

constexpr int kEncoderA = 2, kEncoderB = 3;
constexpr int kPwm = 5, kDirection = 6, kMotorFaultPin = 7;  // low: fault
constexpr int kGripPin = 8;                                   // low: held
constexpr int16_t kMost_mA = 1500;
constexpr int kFullScale_mA = 2000;  // at a duty cycle of 100 %
constexpr int kPwmSteps = 4096;

class Teensy final : public palpate::paddle::Board {
 public:
  uint32_t now_us() override { return micros(); }
  int32_t counts() override { return encoder_.read(); }
  bool encoder_fault() override { return false; }  // a plain quadrature encoder cannot tell
  bool motor_fault() override { return digitalRead(kMotorFaultPin) == LOW; }
  bool grip() override { return digitalRead(kGripPin) == LOW; }
  void set_current_mA(int16_t current_mA) override {
    digitalWrite(kDirection, current_mA < 0 ? HIGH : LOW);
    const int32_t size_mA = current_mA < 0 ? -static_cast<int32_t>(current_mA) : current_mA;
    analogWrite(kPwm, size_mA * (kPwmSteps - 1) / kFullScale_mA);
  }
  bool receive(uint8_t* report) override { return RawHID.recv(report, 0) > 0; }
  void send(const uint8_t* report) override { RawHID.send(report, 0); }

 private:
  Encoder encoder_{kEncoderA, kEncoderB};
};

Teensy* board = nullptr;
palpate::paddle::Firmware* firmware = nullptr;

void setup() {
  pinMode(kDirection, OUTPUT);
  pinMode(kPwm, OUTPUT);
  digitalWrite(kPwm, LOW);
  pinMode(kMotorFaultPin, INPUT_PULLUP);
  pinMode(kGripPin, INPUT_PULLUP);
  analogWriteResolution(12);
  analogWriteFrequency(kPwm, 20000);
  uint16_t boot = 0;
  EEPROM.get(0, boot);
  EEPROM.put(0, ++boot);
  board = new Teensy;
  firmware = new palpate::paddle::Firmware(*board, kMost_mA, boot);
}

void loop() { firmware->loop(); }
