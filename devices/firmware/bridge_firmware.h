// The hardware-independent firmware of a board for the bridge protocol (devices/README.md#bridge). hapkit.cpp uses it
// on an ATmega328P, paddle.ino on a Teensy, the tests on a simulated board.
// A frame without drive flag is always obeyed, so that a host can stop or restart; a frame with it is obeyed if its
// sequence is newer than the last one, or after a stop. The motor is off after kTimeout_us without such a frame or
// without a new heartbeat, until both return, and while motor or sensor has a fault.
// Thread guarantee: one thread.
#pragma once

#ifndef ARDUINO  // a sketch includes the files of its folder itself
#include "devices/firmware/bridge_protocol.h"
#endif

namespace palpate {
namespace bridge {

// `Board`:
//   uint32_t now_us();                                   wraps
//   bool receive(uint8_t& byte);                         false: none
//   bool sample(uint32_t& time_us, int32_t& position_nm, int32_t& force_uN);
//                                                        true: there is a new sample
//   uint8_t condition();                                 kMotorFault, kSensorFault, kGrip
//   void push(int32_t force_uN);                         positive: out of the block
//   void send(const uint8_t* frame);                     kDeviceBytes
template <typename Board>
class Firmware {
 public:
  static constexpr uint32_t kTimeout_us = 50000;

  // `most_uN`: largest force of the motor.
  Firmware(Board& board, int32_t most_uN)
      : board_(board), most_uN_(most_uN), obeyed_us_(board.now_us()), beat_us_(obeyed_us_) {
    board_.push(0);
  }

  // Call it as often as possible.
  void loop() {
    condition_ = board_.condition();
    uint8_t byte = 0;
    while (board_.receive(byte)) {
      if (finder_.add(byte) == Found::frame) obey(finder_.frame());
    }
    if (timed_out(board_.now_us())) stop();
    if (faulty()) push(0, false);
    FromDevice in = FromDevice();
    if (!board_.sample(in.time_us, in.position_nm, in.force_uN)) return;
    in.sequence = ++sequence_;
    in.status = static_cast<uint8_t>(condition_ | (driving_ ? kDriving : 0) | (stopped_ ? kStopped : 0));
    in.confirmed = static_cast<uint16_t>(host_sequence_);
    uint8_t frame[kDeviceBytes];
    encode(in, frame);
    board_.send(frame);
  }

 private:
  void obey(const uint8_t* frame) {
    FromHost out;
    if (!decode(frame, out)) return;
    const bool drive = (out.flags & kDrive) != 0;
    if (drive && !any_sequence_ && !wire::later(out.sequence, host_sequence_)) return;
    const uint32_t now_us = board_.now_us();
    if (!any_frame_ || out.heartbeat != heartbeat_) beat_us_ = now_us;
    obeyed_us_ = now_us;
    heartbeat_ = out.heartbeat;
    host_sequence_ = out.sequence;
    any_frame_ = true;
    any_sequence_ = false;
    if (timed_out(now_us)) return;
    stopped_ = false;
    push(drive && !faulty() ? out.force_uN : 0, drive && !faulty());
  }

  void push(int32_t force_uN, bool driving) {
    driving_ = driving;
    board_.push(force_uN > most_uN_ ? most_uN_ : (force_uN < -most_uN_ ? -most_uN_ : force_uN));
  }

  void stop() {
    stopped_ = stopped_ || any_frame_;
    push(0, false);
    any_sequence_ = true;
  }

  bool timed_out(uint32_t now_us) const {
    return now_us - obeyed_us_ >= kTimeout_us || now_us - beat_us_ >= kTimeout_us;
  }

  bool faulty() const { return (condition_ & (kMotorFault | kSensorFault)) != 0; }

  Board& board_;
  int32_t most_uN_;
  uint32_t obeyed_us_, beat_us_;  // of the last obeyed frame and of the last new heartbeat
  uint32_t host_sequence_ = 0;    // of the last obeyed frame
  uint16_t heartbeat_ = 0;
  bool any_frame_ = false;    // a frame was obeyed
  bool any_sequence_ = true;  // the next frame may have any sequence: the host may have restarted
  FrameFinder<kHostBytes, kFromHost> finder_;
  uint32_t sequence_ = 0;
  uint8_t condition_ = 0;
  bool driving_ = false;
  bool stopped_ = false;
};

}  // namespace bridge
}  // namespace palpate
