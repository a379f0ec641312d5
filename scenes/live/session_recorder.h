// Writes every sample of a session into a recording file.
// The loop puts samples into a ring (engine/live/live_tick.h). The recorder's thread empties it every 20 ms into a
// RecordingWriter, which writes whole rows to the disk about every 0.2 s. The ring holds half a minute at 1 kHz;
// a full ring loses samples, which are counted. Time begins at 0. After a pause the time is that of the device if it
// went on. If it began again (a replay restarts, a seek backwards), the new stream begins kStreamGap_s after the last
// sample, so that features computed from the file forget the stream before, and a comment in the file says so. Samples
// that the loop could not use (not finite, not later) or without a force are omitted.
// Thread guarantee: one thread, slow side; beside it the recorder's own.
#pragma once

#include <atomic>
#include <cstdint>
#include <future>
#include <optional>
#include <semaphore>
#include <string>
#include <vector>

#include "devices/virtual/simulated_devices.h"
#include "engine/base/result.h"
#include "engine/live/haptics_loop.h"
#include "engine/recording/recording.h"
#include "scenes/live/comparison.h"

namespace palpate {

struct RecordingStatus {
  bool active = false;
  bool saving = false;  // stopped, and not yet completely on the disk
  std::string path;
  std::uint64_t rows = 0;
  double seconds = 0.0;  // duration without the gaps between streams
};

struct RecorderRequest {
  std::string path;
  ReferenceKind force = ReferenceKind::truth;  // the force that is written
  RecordingColumns columns;
  std::vector<std::string> comments;
  bool overwrite = false;
};

inline constexpr double kStreamGap_s = 30.0;

// Computes the time column, which increases strictly, from device times.
class RecordingTime {
 public:
  // The time to write for a sample; empty when it is not later than the last one of its stream.
  std::optional<double> file_time_s(double time_s, bool restart) noexcept;
  double last_s() const noexcept { return last_s_; }
  double gaps_s() const noexcept { return gaps_s_; }

 private:
  double origin_s_ = 0.0;  // device time of the stream's first sample
  double start_s_ = 0.0;   // time of that sample in the file
  double last_s_ = 0.0, gaps_s_ = 0.0;
  bool started_ = false;
};

class SessionRecorder {
 public:
  // `loop` outlives this; no other object reads its samples.
  explicit SessionRecorder(HapticsLoop& loop);
  // Stops and waits until the file is on the disk.
  ~SessionRecorder();

  // Starts a recording; then set LoopControls::recording to `number()`. Errors: a recording is
  // running or being saved, the file exists or cannot be created, the thread cannot be started.
  Status start(const RecorderRequest& request);
  // Number of the recording that is running; 0: none.
  std::uint32_t number() const noexcept { return status().active ? number_ : 0; }

  // Ends the recording with the samples that the loop has published so far; does not wait.
  void stop() {
    stop_ = true;
    wake_.release();
  }
  // Blocks until a recording that was stopped or has failed is finished.
  void wait() {
    if (running_.valid()) running_.wait();
  }

  RecordingStatus status() const;
  // The outcome of a recording, once, after it ended by `stop` or by a write error.
  std::optional<Notice> read_outcome();

 private:
  Notice work();
  void drain();
  void write(const RecordedSample& sample);
  Notice finish();

  HapticsLoop& loop_;
  RecorderRequest request_;
  std::uint32_t number_ = 0;
  std::optional<RecordingWriter> writer_;
  RecordingTime time_;
  std::uint64_t without_force_ = 0, unusable_ = 0;  // samples that were left out
  bool restart_pending_ = false;
  std::uint64_t dropped_before_ = 0;
  std::vector<RecordedSample> buffer_;
  std::future<Notice> running_;
  std::atomic<bool> stop_{false};
  std::counting_semaphore<> wake_{0};  // so that `stop` ends a pause; a release that is left over only shortens one
  std::atomic<std::uint64_t> rows_{0};
  std::atomic<double> seconds_{0.0};
};

// The recordings of a session: what the user drops on the window or names, the test part for a user with a single
// recording, and the limits of the simulated hand. They do I/O; any thread.
struct ConvertedRecording {
  std::string path;                // of the recording
  std::vector<std::string> words;  // the columns that were found and the guesses; empty: the file was a recording
};

// Whether a file may be a recording: it has an extension other than .json (models).
bool may_be_recording(const std::string& path);

// Converts a table of another program to a recording file in `folder` (engine/import); a recording stays as it is.
// Errors: those of read_recording or import_table; the new file cannot be written.
Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder);

// The part from the row of least force between 60 % and 80 % of the rows on, where the tool is in air if it ever leaves
// the material there, is removed from `recording` and returned. Its name says which part it is. Empty for a recording
// of fewer than 100 rows, which stays as it is.
std::optional<Recording> take_test_part(Recording& recording);

// Limits the simulated hand to the forces, depths and speeds of the training data. Returns whether there is any force.
// Where no position is positive (a surface at negative positions), only the force is limited.
// Speeds are differences over at least 20 ms, to suppress encoder steps. The fastest 1 % are ignored as noise.
// The rows of a recording are not empty (read_recording).
bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand);

}  // namespace palpate
