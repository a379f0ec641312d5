#include "engine/recording/recording_writer.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/base/csv_scanner.h"

namespace palpate {
namespace {

// Text written at a time, so that a long recording is not in memory twice.
constexpr std::size_t kPieceBytes = 256 * 1024;

// The longest comment: '#', a blank and the text fit in one line.
constexpr std::size_t kMaximumCommentBytes = kMaximumLineBytes - 2;

// Appends one '#' line for each line of `comment`, up to the longest comment. Control characters become blanks, because
// the reader would refuse them or take them for line ends.
void append_comment(std::string& out, std::string_view comment) {
  for (;;) {
    const std::size_t newline = comment.find('\n');
    out += "# ";
    for (const char c : comment.substr(0, std::min(newline, kMaximumCommentBytes))) {
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    out += '\n';
    if (newline == std::string_view::npos) return;
    comment.remove_prefix(newline + 1);
  }
}

void append_header(std::string& out, RecordingColumns columns) {
  out += columns.force ? "time_s,position_m,force_N" : "time_s,position_m";
  if (columns.velocity) out += ",velocity_m_per_s";
  if (columns.acceleration) out += ",acceleration_m_per_s2";
  out += '\n';
}

void append_row(std::string& out, RecordingColumns columns, const RecordingRow& row) {
  out += shortest(row.time_s) + ',' + shortest(row.position_m);
  if (columns.force) out += ',' + shortest(row.force_N);
  if (columns.velocity) out += ',' + shortest(row.velocity_m_per_s);
  if (columns.acceleration) out += ',' + shortest(row.acceleration_m_per_s2);
  out += '\n';
}

}  // namespace

RecordingWriter::RecordingWriter(AtomicFile file, RecordingColumns columns)
    : file_(std::move(file)), columns_(columns) {
  piece_.reserve(kPieceBytes + kMaximumLineBytes);
}

Result<RecordingWriter> RecordingWriter::create(const std::string& path, RecordingColumns columns,
                                                const std::vector<std::string>& comments, bool overwrite) {
  auto file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  RecordingWriter writer(std::move(*file), columns);
  writer.path_ = path;
  for (const std::string& comment : comments) append_comment(writer.piece_, comment);
  append_header(writer.piece_, columns);
  return writer;
}

Status RecordingWriter::add(const RecordingRow& row) {
  if (const auto fault = rules_.check(row)) {
    return Error{path_ + ": cannot write row " + std::to_string(rules_.rows() + 1) + ": " + fault->text};
  }
  append_row(piece_, columns_, row);
  if (piece_.size() >= kPieceBytes) flush();
  return {};
}

void RecordingWriter::flush() {
  file_.write(piece_);
  piece_.clear();
}

Status RecordingWriter::publish() {
  if (rules_.rows() < kRateRows) return {};
  flush();
  Status published = file_.publish();
  if (published) published_rows_ = rules_.rows();
  return published;
}

Status RecordingWriter::commit() {
  flush();
  if (file_.failed()) return file_.commit();
  if (const auto fault = rules_.finish()) {
    const AtomicFile given_up = std::move(file_);
    return Error{path_ + ": cannot write: " + fault->text};
  }
  return file_.commit();
}

}  // namespace palpate
