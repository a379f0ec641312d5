#include "engine/recording/recording_writer.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
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

// Reserves the name of a file by an abstract Unix address, which the system frees with its descriptor, made of the
// file's folder, as the disk knows it, and its name. A system without such addresses reserves nothing.
Result<std::shared_ptr<void>> claim_name(const std::string& path) {
  const std::filesystem::path file(path);
  struct stat folder {};
  stat(file.has_parent_path() ? file.parent_path().c_str() : ".", &folder);
  const std::string name = "palpate-recording-" + std::to_string(folder.st_dev) + "-" + std::to_string(folder.st_ino) +
                           "-" + std::to_string(std::hash<std::string>()(file.filename().string()));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(name, address.sun_path + 1);
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::shared_ptr<void> claim(nullptr, [descriptor](void*) { ::close(descriptor); });
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), size) == 0 || errno != EADDRINUSE) return claim;
  return Error{path + ": another recording is being written into it; choose another name, or end that one"};
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::string& path, RecordingColumns columns,
                                                const std::vector<std::string>& comments, bool overwrite) {
  auto file = AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  auto claim = claim_name(path);
  if (!claim) return claim.error();
  std::string head;
  for (const std::string& comment : comments) append_comment(head, comment);
  file->write(head + line_of(columns, [](std::size_t i) { return kColumnNames[i]; }));
  return RecordingWriter(std::move(*claim), std::move(*file), path, columns);
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

Status RecordingWriter::publish() {
  if (rules_.rows() < kRateRows) return {};
  Status published = file_.publish();
  if (published) published_rows_ = rules_.rows();
  return published;
}

Status RecordingWriter::commit() {
  if (file_.failed()) return file_.commit();
  if (const auto fault = rules_.finish()) {
    const AtomicFile given_up = std::move(file_);
    return Error{path_ + ": cannot write: " + fault->text};
  }
  Status committed = file_.commit();
  if (!committed || notes_.empty()) return committed;
  if (noted_ > kMostNotes) append_comment(notes_, std::to_string(noted_ - kMostNotes) + " more such notes");
  if (const auto text = read_plain_file(path_, "the recording", "", std::numeric_limits<std::size_t>::max()))
    static_cast<void>(write_file_atomically(path_, notes_ + *text, true));
  return {};
}

}  // namespace palpate
