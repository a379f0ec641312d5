// Every sample of a session into a recording file, not one lost.
//
// The loop puts samples into a ring (engine/live/live_tick.h); a thread of the recorder's own empties it
// every 20 ms into a RecordingWriter; from the 1000th row on the file is there under its name, whole rows
// at every moment. Time begins at 0; where a new stream begins (a replay that starts over, a seek) it goes
// on kStreamGap_s later, by which the filters of whoever reads the file have forgotten what was before, as
// the loop's had. Samples that the loop could not use (not finite, not later) or without a force are left out.
// Thread guarantee: one thread, slow side, but for the loop's own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/result.h"
#include "engine/live/haptics_loop.h"
#include "engine/recording/recording_writer.h"
#include "scenes/live/force_history.h"
#include "scenes/live/notices.h"

namespace palpate {

struct RecordingStatus {
  bool active = false;
  bool saving = false;  // stopped, on its way to the disk
  std::string path;
  std::uint64_t rows = 0;
  double seconds = 0.0;  // of motion: gaps between streams do not count
};

struct RecorderRequest {
  std::string path;
  ReferenceKind force = ReferenceKind::truth;  // which of the sample's is written
  RecordingColumns columns;
  std::vector<std::string> comments;
  bool overwrite = false;
};

inline constexpr double kStreamGap_s = 30.0;

// The time column: strictly increasing, whatever the device's clock does.
class RecordingTime {
 public:
  // The time to write for a sample; nothing when it is not later than the last
  // one of its stream.
  std::optional<double> place(double time_s, bool restart) noexcept;
  double last_s() const noexcept { return last_s_; }
  double gaps_s() const noexcept { return gaps_s_; }

 private:
  double origin_s_ = 0.0;  // device time of the stream's first sample
  double start_s_ = 0.0;   // where that stands in the file
  double last_s_ = 0.0;
  double gaps_s_ = 0.0;
  bool started_ = false;
};

class SessionRecorder {
 public:
  // `loop` outlives this; nobody else reads its samples.
  explicit SessionRecorder(HapticsLoop& loop);
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;
  // Stops and waits until the file is on the disk.
  ~SessionRecorder();

  // Then set LoopControls::recording to `number()`. Errors: a recording is being
  // made or saved, the file exists or cannot be created, no thread.
  Status start(const RecorderRequest& request);
  // Of the recording; 0: none is being made.
  std::uint32_t number() const noexcept { return status().active ? number_ : 0; }

  // Ends the recording with the samples that the loop has published by now; does not wait.
  void stop();
  // Blocks until a recording that was stopped, or gave up, is on the disk or gone.
  void wait();

  RecordingStatus status() const;
  // What became of the recording, once, after it ended: by `stop`, or since the disk refused.
  std::optional<Notice> read_outcome();

 private:
  struct Counts {
    std::uint64_t without_force = 0;
    std::uint64_t unusable = 0;
  };
  void work();
  void drain();
  void write(const RecordedSample& sample);
  void publish();
  Notice finish();

  HapticsLoop& loop_;
  RecorderRequest request_;
  std::uint32_t number_ = 0;
  std::optional<RecordingWriter> writer_;
  RecordingTime time_;
  Counts counts_;
  bool restart_pending_ = false;
  int rounds_ = 0;
  std::uint64_t dropped_before_ = 0;
  std::vector<RecordedSample> buffer_;
  std::thread thread_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;              // by mutex_; only the slow side changes it
  std::optional<Notice> outcome_;  // by mutex_
  std::atomic<std::uint64_t> rows_{0};
  std::atomic<double> seconds_{0.0};
};

}  // namespace palpate
