// Reference firmware of a haptic paddle (teensy_paddle.h) as a device of `bridge:`, with 1000 samples per second over
// the Teensy's USB serial port: `--device bridge:/dev/ttyACM0`. Copy the headers of .. and of this folder into the
// sketch. The position is 0 where the board started. Measure kMost_uN.
#include "wire.h"
#include "bridge_protocol.h"
#include "bridge_firmware.h"
#include "teensy_paddle.h"

constexpr int32_t kNmPerCount = 20000;  // counts increase inward
constexpr int32_t kuNPerMilliampere = 4000;
constexpr int32_t kMost_uN = 5000000;

class Paddle : public TeensyPaddle {
 public:
  bool receive(uint8_t& byte) {
    if (Serial.available() == 0) return false;
    byte = static_cast<uint8_t>(Serial.read());
    return true;
  }
  bool sample(uint32_t& time_us, int32_t& position_nm, int32_t& force_uN) {
    if (micros() - sampled_us_ < 1000) return false;
    time_us = sampled_us_ = micros();
    position_nm = counts() * kNmPerCount;
    force_uN = palpate::bridge::kNoForce;
    return true;
  }
  // Out of the block is towards smaller counts.
  void push(int32_t force_uN) { set_current_mA(-force_uN / kuNPerMilliampere); }
  // A frame for which there is no room is dropped; the next one replaces it.
  void send(const uint8_t* frame) {
    if (Serial.availableForWrite() >= static_cast<int>(palpate::bridge::kDeviceBytes))
      Serial.write(frame, palpate::bridge::kDeviceBytes);
  }

 private:
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
