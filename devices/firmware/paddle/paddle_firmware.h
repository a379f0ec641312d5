// The firmware of a haptic paddle, without the hardware: paddle.ino gives it a
// Teensy, the tests give it a simulated motor and time.
//
// A report from the host is obeyed when its checksum is right and it is newer
// than the last; one without drive stops the motor whatever its number, and the
// count goes on from that number, as for a host that starts again. The motor stops by itself when there was
// no such report, or no new heartbeat, for HostWatch::kSilent_us, and on a fault of motor or encoder. It starts again
// only after a report without drive, or with no current, so that it does not resume in the middle of a push. Thread
// guarantee: one thread.
#pragma once

#ifndef ARDUINO  // a sketch includes the files of its folder itself
#include "devices/firmware/paddle/paddle_protocol.h"
#endif

namespace palpate {
namespace paddle {

// What the firmware needs of a board.
class Board {
 public:
  virtual uint32_t now_us() = 0;  // wraps
  virtual int32_t counts() = 0;
  virtual bool encoder_fault() = 0;
  virtual bool motor_fault() = 0;
  virtual bool grip() = 0;
  virtual void set_current_mA(int16_t current_mA) = 0;
  // The next report from the host, kReportBytes; false: none.
  virtual bool receive(uint8_t* report) = 0;
  // May be refused when the host does not listen: the report is lost.
  virtual void send(const uint8_t* report) = 0;

 protected:
  ~Board() = default;
};

class Firmware {
 public:
  // `most_mA`: what motor and amplifier bear; `boot`: another number at each start.
  Firmware(Board& board, int16_t most_mA, uint16_t boot)
      : board_(board), most_mA_(most_mA), boot_(boot), host_(board.now_us()) {
    board_.set_current_mA(0);
    started_us_ = last_sent_us_ = board_.now_us();
  }

  // As often as possible.
  void loop() {
    uint8_t report[kReportBytes];
    while (board_.receive(report)) receive_command(report);
    const uint32_t now_us = board_.now_us();
    if (host_.silent(now_us)) stop(true);
    if (board_.motor_fault() || board_.encoder_fault()) stop(false);
    if (now_us - last_sent_us_ >= kReportPeriod_us) {
      last_sent_us_ += kReportPeriod_us;
      if (now_us - last_sent_us_ >= kReportPeriod_us) last_sent_us_ = now_us;  // never a burst
      send_state(now_us);
    }
  }

  int16_t current_mA() const { return current_mA_; }
  bool stopped() const { return stopped_; }

 private:
  void receive_command(const uint8_t* report) {
    FromHost out;
    const bool good = decode(report, out) == kGood;
    const bool drive = good && (out.flags & kDrive) != 0;
    if (!good || !host_.accept(board_.now_us(), out.sequence, out.heartbeat, drive)) {
      ++rejected_;
      return;
    }
    if (!drive || out.current_mA == 0) stopped_ = watchdog_ = false;
    drive_to(drive && !stopped_ ? out.current_mA : static_cast<int16_t>(0), drive && !stopped_);
  }

  void drive_to(int16_t current_mA, bool driving) {
    driving_ = driving;
    current_mA_ =
        current_mA > most_mA_ ? most_mA_ : (current_mA < -most_mA_ ? static_cast<int16_t>(-most_mA_) : current_mA);
    board_.set_current_mA(current_mA_);
  }

  void stop(bool by_watchdog) {
    stopped_ = true;
    watchdog_ = watchdog_ || by_watchdog;
    drive_to(0, false);
  }

  void send_state(uint32_t now_us) {
    FromDevice in;
    in.status = static_cast<uint8_t>((driving_ ? kDriving : 0) | (watchdog_ ? kStopped : 0) |
                                     (board_.motor_fault() ? kMotorFault : 0) |
                                     (board_.encoder_fault() ? kEncoderFault : 0) | (board_.grip() ? kGrip : 0));
    in.sequence = ++sequence_;
    in.time_us = now_us - started_us_;
    in.counts = board_.counts();
    in.current_mA = current_mA_;
    in.boot = boot_;
    in.confirmed = host_.sequence();
    in.rejected = rejected_;
    uint8_t report[kReportBytes];
    encode(in, report);
    board_.send(report);
  }

  Board& board_;
  int16_t most_mA_;
  uint16_t boot_;
  wire::HostWatch host_;
  uint32_t started_us_ = 0, last_sent_us_ = 0;
  uint32_t sequence_ = 0;
  uint16_t rejected_ = 0;
  int16_t current_mA_ = 0;
  bool driving_ = false;
  bool stopped_ = true;
  bool watchdog_ = false;
};

}  // namespace paddle
}  // namespace palpate
