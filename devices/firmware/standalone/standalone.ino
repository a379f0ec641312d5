// A haptic paddle (../paddle/teensy_paddle.h) that renders a fitted model on the board, for a
// Teensy 4.x. Copy the headers of .., of ../paddle and of this folder into the sketch, and
// beside them
//   palpate export MODEL.json --float --encoder-step METRES --c model.c
// with the metres of one encoder count. Measure the settings below.
#include "wire.h"
#include "bridge_protocol.h"
#include "teensy_paddle.h"
#include "model_firmware.h"

extern "C" {
float palpate_force_after(float step_s, float position_m);
void palpate_reset(void);
}

using Firmware = palpate::standalone::ModelFirmware<TeensyPaddle>;

TeensyPaddle* board = nullptr;
Firmware* firmware = nullptr;

void setup() {
  board = new TeensyPaddle;
  palpate::standalone::Settings settings;
  settings.metres_per_count = 1e-5F;
  settings.mA_per_N = 150.0F;
  firmware = new Firmware(*board, {palpate_force_after, palpate_reset}, settings);
}

void loop() { firmware->loop(); }
