// The firmware of a Hapkit, without the hardware: hapkit.cpp gives it an ATmega328P, the
// tests give it a simulated board. It speaks devices/README.md#bridge.
//
// A frame without drive, or with it and newer than the last, is obeyed. The motor stops by
// itself when there was no such frame, or no new heartbeat, for HostWatch::kSilent_us, until
// there is. Thread guarantee: one thread.
#pragma once

#include "devices/firmware/hapkit/bridge_protocol.h"

namespace palpate {
namespace hapkit {

// `Board`:
//   uint32_t now_us();                                   wraps
//   bool receive(uint8_t& byte);                         false: none
//   bool sample(uint32_t& time_us, int32_t& position_nm, int32_t& force_uN);
//                                                        true: a new one, at its rate
//   void push(int32_t force_uN);                         positive: out of the block
//   void send(const uint8_t* frame);                     bridge::kDeviceBytes
template <typename Board>
class Firmware {
 public:
  // `most_uN`: what the motor bears.
  Firmware(Board& board, int32_t most_uN) : board_(board), most_uN_(most_uN), host_(board.now_us()) { board_.push(0); }

  // As often as possible.
  void loop() {
    uint8_t byte = 0;
    while (board_.receive(byte)) {
      if (finder_.add(byte)) obey(finder_.frame());
    }
    if (host_.silent(board_.now_us())) stop();
    bridge::FromDevice in = bridge::FromDevice();
    if (!board_.sample(in.time_us, in.position_nm, in.force_uN)) return;
    in.sequence = ++sequence_;
    in.status = static_cast<uint8_t>((driving_ ? bridge::kDriving : 0) | (stopped_ ? bridge::kStopped : 0));
    in.confirmed = static_cast<uint16_t>(host_.sequence());
    uint8_t frame[bridge::kDeviceBytes];
    bridge::encode(in, frame);
    board_.send(frame);
  }

 private:
  void obey(const uint8_t* frame) {
    bridge::FromHost out;
    if (!bridge::decode(frame, out)) return;
    const bool drive = (out.flags & bridge::kDrive) != 0;
    const uint32_t now_us = board_.now_us();
    if (!host_.accept(now_us, out.sequence, out.heartbeat, drive) || host_.silent(now_us)) return;
    stopped_ = false;
    driving_ = drive;
    const int32_t force_uN = drive ? out.force_uN : 0;
    board_.push(force_uN > most_uN_ ? most_uN_ : (force_uN < -most_uN_ ? -most_uN_ : force_uN));
  }

  void stop() {
    stopped_ = stopped_ || host_.heard();
    driving_ = false;
    board_.push(0);
    host_.forget();
  }

  Board& board_;
  int32_t most_uN_;
  wire::HostWatch host_;
  bridge::FrameFinder<bridge::kHostBytes, bridge::kFromHost> finder_;
  uint32_t sequence_ = 0;
  bool driving_ = false;
  bool stopped_ = false;
};

}  // namespace hapkit
}  // namespace palpate
