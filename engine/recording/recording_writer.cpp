#include "engine/recording/recording_writer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"

namespace palpate {
namespace {

// The longest comment: '#', a blank and the text fit in one line.
constexpr std::size_t kMaximumCommentBytes = kMaximumLineBytes - 2;

constexpr std::uint64_t kMostNotes = 20;

// Appends one '#' line for each line of `comment`, up to the longest comment. Control characters become blanks, because
// the reader would refuse them or take them for line ends.
void append_comment(std::string& out, std::string_view comment) {
  for (;;) {
    const std::size_t newline = comment.find('\n');
    out += "# ";
    for (const char c : comment.substr(0, std::min(newline, kMaximumCommentBytes)))
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    out += '\n';
    if (newline == std::string_view::npos) return;
    comment.remove_prefix(newline + 1);
  }
}

// A line with a field for each column that the file has.
template <typename Field>
std::string line_of(RecordingColumns columns, const Field& field) {
  const std::array present = {true, true, columns.force, columns.velocity, columns.acceleration};
  std::string line;
  line.reserve(128);  // five doubles of at most 24 characters
  for (std::size_t i = 0; i < present.size(); ++i)
    if (present[i]) line.append(i > 0 ? "," : "").append(field(i));
  return line + '\n';
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::string& path, RecordingColumns columns,
                                                const std::vector<std::string>& comments, bool overwrite,
                                                bool in_part) {
  auto file = in_part ? AtomicFile::create_in_part(path, overwrite) : AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  std::string head;
  for (const std::string& comment : comments) append_comment(head, comment);
  file->write(head + line_of(columns, [](std::size_t i) { return kColumnNames[i]; }));
  return RecordingWriter(std::move(*file), path, columns, overwrite);
}

Status RecordingWriter::add(const RecordingRow& row) {
  if (const auto fault = rules_.check(row))
    return Error{path_ + ": cannot write row " + std::to_string(rules_.rows() + 1) + ": " + fault->text};
  const auto values = column_values(row);
  file_.write(line_of(columns_, [&](std::size_t i) { return shortest(values[i]); }));
  return {};
}

void RecordingWriter::note(const std::string& comment) {
  if (++noted_ <= kMostNotes) append_comment(notes_, comment);
}

Status RecordingWriter::flush() {
  Status flushed = file_.flush_part();
  if (flushed) flushed_rows_ = rules_.rows();
  return flushed;
}

Status RecordingWriter::commit() {
  if (file_.failed()) return file_.commit();
  if (const auto fault = rules_.finish()) {
    const AtomicFile given_up = std::move(file_);
    return Error{path_ + ": cannot write: " + fault->text};
  }
  if (notes_.empty()) return file_.commit();
  if (noted_ > kMostNotes) append_comment(notes_, std::to_string(noted_ - kMostNotes) + " more such notes");
  if (const Status flushed = flush(); !flushed) return flushed;
  const auto rows =
      read_plain_file(AtomicFile::part_of(path_), "the recording", "", std::numeric_limits<std::size_t>::max());
  if (!rows || !write_file_atomically(path_, notes_ + *rows, overwrite_)) return file_.commit();
  const AtomicFile copied = std::move(file_);
  return {};
}

}  // namespace palpate
