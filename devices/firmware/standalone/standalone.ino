// A haptic paddle that renders a fitted model on the board, for a Teensy 4.x. Copy the
// headers of ../paddle and this folder into the sketch, and beside them
//   palpate export MODEL.json --float --encoder-step METRES --c model.c
// with the metres of one encoder count. Pins and figures are those of one paddle: set
// them to yours, measure kSettings, and never try it first with a hand on the handle.
#include <Encoder.h>

#include "wire.h"
#include "paddle_protocol.h"
#include "paddle_firmware.h"
#include "model_firmware.h"

extern "C" {
float palpate_force_after(float step_s, float position_m);
void palpate_reset(void);
}

constexpr int kEncoderA = 2, kEncoderB = 3;
constexpr int kPwm = 5, kDirection = 6, kMotorFaultPin = 7;  // low: fault
constexpr int kGripPin = 8;                                   // low: held
constexpr int kFullScale_mA = 2000;                           // at a duty cycle of 100 %
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
  bool receive(uint8_t*) override { return false; }
  void send(const uint8_t*) override {}

 private:
  Encoder encoder_{kEncoderA, kEncoderB};
};

Teensy* board = nullptr;
palpate::paddle::ModelFirmware* firmware = nullptr;

void setup() {
  pinMode(kDirection, OUTPUT);
  pinMode(kPwm, OUTPUT);
  digitalWrite(kPwm, LOW);
  pinMode(kMotorFaultPin, INPUT_PULLUP);
  pinMode(kGripPin, INPUT_PULLUP);
  analogWriteResolution(12);
  analogWriteFrequency(kPwm, 20000);
  board = new Teensy;
  palpate::paddle::StandaloneSettings settings;
  settings.metres_per_count = 1e-5F;
  settings.mA_per_N = 150.0F;
  firmware = new palpate::paddle::ModelFirmware(*board, {palpate_force_after, palpate_reset}, settings);
}

void loop() { firmware->loop(); }
