#include "scenes/live/session_recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/import_table.h"
#include "models/samples/samples.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr std::size_t kSamplesAtOnce = 1024;
constexpr auto kPause = std::chrono::milliseconds(20);
constexpr int kRoundsToDisk = 10;  // rows are written to the disk after so many rounds

// The force to record, indexed by ReferenceKind.
constexpr double RecordedSample::*kForces[] = {&RecordedSample::measured_N, &RecordedSample::reference_N,
                                               &RecordedSample::model_N};

std::string counted(std::uint64_t count, const char* words) {
  return count > 0 ? "; " + std::to_string(count) + " samples " + words : std::string();
}

}  // namespace

std::optional<double> RecordingTime::file_time_s(double time_s, bool restart) noexcept {
  if (!started_) origin_s_ = time_s;
  double at_s = start_s_ + (time_s - origin_s_);
  if (started_ && !(at_s > last_s_)) {
    if (!restart) return std::nullopt;
    at_s = start_s_ = last_s_ + kStreamGap_s;
    gaps_s_ += kStreamGap_s;
    origin_s_ = time_s;
  }
  started_ = true;
  last_s_ = at_s;
  return at_s;
}

SessionRecorder::SessionRecorder(HapticsLoop& loop) : loop_(loop), buffer_(kSamplesAtOnce) {}

SessionRecorder::~SessionRecorder() {
  stop();
  wait();
}

Status SessionRecorder::start(const RecorderRequest& request) {
  if (running_.valid()) return Error{"already recording into " + request_.path + "; stop that one first"};
  Result<RecordingWriter> writer =
      RecordingWriter::create(request.path, request.columns, request.comments, request.overwrite, true);
  if (!writer) return writer.error();
  writer_.emplace(std::move(*writer));
  request_ = request;
  ++number_;
  time_ = {};
  without_force_ = unusable_ = 0;
  restart_pending_ = false;
  dropped_before_ = loop_.recorded().dropped();
  rows_.store(0, std::memory_order_relaxed);
  seconds_.store(0.0, std::memory_order_relaxed);
  stop_ = false;
  try {
    running_ = std::async(std::launch::async, [this] { return work(); });
  } catch (const std::system_error& error) {
    writer_.reset();
    return Error{std::string("cannot start the recorder's thread: ") + error.what() + "; close other programs"};
  }
  return {};
}

Notice SessionRecorder::work() {
  int rounds = 0;
  for (bool last = false; !last && !writer_->failed();) {
    static_cast<void>(wake_.try_acquire_for(kPause));
    last = stop_;
    drain();
    // A write error is persistent: this loop ends, and `finish` reports it.
    if (++rounds % kRoundsToDisk == 0) static_cast<void>(writer_->flush());
  }
  Notice outcome = finish();
  writer_.reset();
  return outcome;
}

void SessionRecorder::drain() {
  // Reads at most as many samples as the ring holds, so that `stop` ends even if the loop fills the ring faster than
  // the disk takes it.
  for (std::size_t round = 0; round <= kRecordedRing / kSamplesAtOnce; ++round) {
    const std::size_t count = loop_.recorded().pop(buffer_.data(), buffer_.size());
    for (std::size_t i = 0; i < count; ++i) write(buffer_[i]);
    if (count < buffer_.size()) break;
  }
  rows_.store(writer_->rows(), std::memory_order_relaxed);
  seconds_.store(time_.last_s() - time_.gaps_s(), std::memory_order_relaxed);
}

void SessionRecorder::write(const RecordedSample& sample) {
  // The ring may still hold samples of an earlier recording.
  if (sample.recording != number_) return;
  restart_pending_ = restart_pending_ || sample.restart;
  if (!sample.usable || !std::isfinite(sample.tool.time_s)) {
    ++unusable_;
    return;
  }
  const double force_N = request_.columns.force ? sample.*kForces[static_cast<std::size_t>(request_.force)] : 0.0;
  if (!std::isfinite(force_N)) {
    ++without_force_;
    return;
  }
  const std::optional<double> time_s = time_.file_time_s(sample.tool.time_s, restart_pending_);
  restart_pending_ = false;
  if (!time_s) {
    ++unusable_;
    return;
  }
  const ToolSample& tool = sample.tool;
  if (!writer_->add({*time_s, tool.position_m, force_N, tool.velocity_m_per_s, tool.acceleration_m_per_s2}))
    ++unusable_;
}

Notice SessionRecorder::finish() {
  const std::uint64_t dropped = loop_.recorded().dropped() - dropped_before_;
  const Status status = writer_->commit();
  if (!status && writer_->flushed_rows() == 0) return {"the recording was lost: " + status.error().message, true};
  if (!status) {
    return {"the recording ended early: " + status.error().message + "; " + AtomicFile::part_of(request_.path) +
                " has its first " + std::to_string(writer_->flushed_rows()) +
                " rows; make room, and record the rest into another file",
            true};
  }
  return {"recorded " + std::to_string(writer_->rows()) + " rows (" + fixed(time_.last_s() - time_.gaps_s(), 1) +
              " s) into " + request_.path + counted(dropped, "were lost because the disk was too slow") +
              counted(unusable_, "that the loop could not use were left out") +
              counted(without_force_, "without a force were left out") +
              (time_.gaps_s() > 0.0 ? "; the time of the device began again, after gaps of " +
                                          general(time_.gaps_s(), 3) + " s in all that were not measured"
                                    : ""),
          dropped > 0};
}

RecordingStatus SessionRecorder::status() const {
  if (!running_.valid()) return {};
  return {!stop_, stop_, request_.path, rows_.load(std::memory_order_relaxed),
          seconds_.load(std::memory_order_relaxed)};
}

std::optional<Notice> SessionRecorder::read_outcome() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return running_.get();
}

bool may_be_recording(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return !ending.empty() && ending != ".json";
}

Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder) {
  const auto recording = read_recording(path);
  if (recording) return ConvertedRecording{path, {}};
  // A file with the header of a recording is no table of another program.
  std::error_code missing;
  if (read_recording(path, 0) || !std::filesystem::exists(path, missing)) return recording.error();
  const ImportRequest request;
  const auto table = import_table(path, request);
  if (!table) return table.error();
  ConvertedRecording converted;
  converted.path = folder + "/" + std::filesystem::path(path).stem().string() + local_time_text("-%Y%m%d-%H%M%S.csv");
  if (Status status = check_limits(path, request, *table); !status) return status.error();
  if (Status status = write_recording(converted.path, table->recording, import_origin(path, request, *table), true);
      !status)
    return status.error();
  converted.words.push_back(layout_words(*table));
  for (const std::string& rows : row_words(*table)) converted.words.push_back("rows: " + rows);
  for (std::size_t role = 0; role < kRoles; ++role)
    converted.words.push_back(std::string(kRoleNames[role]) + ": " + column_words(table->columns[role]));
  converted.words.insert(converted.words.end(), table->notes.begin(), table->notes.end());
  return converted;
}

std::optional<Recording> take_test_part(Recording& recording) {
  constexpr std::size_t kLeastRows = 100;
  std::vector<RecordingRow>& rows = recording.rows;
  if (rows.size() < kLeastRows) return std::nullopt;
  const auto first = rows.begin() + static_cast<std::ptrdiff_t>(first_test_row(recording));
  Recording part{recording.name + ", last " + fixed(rows.back().time_s - first->time_s, 1) + " s",
                 recording.columns,
                 {first, rows.end()}};
  rows.erase(first, rows.end());
  return part;
}

bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand) {
  constexpr double kInside = 0.8;  // of the largest values, because the simulated hand overshoots
  constexpr double kSpan_s = 0.02;
  double strongest_N = 0.0, deepest_m = 0.0;
  std::vector<double> speeds_m_per_s;  // in contact
  for (const Recording& recording : recordings) {
    RecordingRow before = recording.rows.front();
    for (const RecordingRow& row : recording.rows) {
      strongest_N = std::max(strongest_N, row.force_N);
      deepest_m = std::max(deepest_m, row.position_m);
      const double span_s = row.time_s - before.time_s;
      if (span_s < kSpan_s) continue;
      if (row.position_m > 0.0) speeds_m_per_s.push_back(std::abs(row.position_m - before.position_m) / span_s);
      before = row;
    }
  }
  if (strongest_N <= 0.0) return false;
  hand.strongest_press_N = kInside * strongest_N;
  if (deepest_m > 0.0) hand.deepest_m = kInside * deepest_m;
  if (speeds_m_per_s.empty()) return true;
  hand.fastest_m_per_s = kInside * quantile_of(std::move(speeds_m_per_s), 99);
  return true;
}

}  // namespace palpate
