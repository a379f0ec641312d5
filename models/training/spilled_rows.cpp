#include "models/training/spilled_rows.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

namespace palpate {
namespace {

static_assert(std::is_trivially_copyable_v<SpilledRows::Row>);

constexpr std::size_t kWaitingRows = 65536;
constexpr double kLeftOnDisk = 1e9;  // bytes

bool has_room(int file) {
  struct statvfs disk {};
  return fstatvfs(file, &disk) == 0 &&
         static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) > kLeftOnDisk;
}

// Calls `transfer(address, size)` until all is done; interrupted calls go on.
template <typename Byte, typename Transfer>
bool transfer_all(Byte* at, std::size_t size, Transfer transfer) {
  while (size > 0) {
    const ssize_t done = transfer(at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    size -= static_cast<std::size_t>(done);
  }
  return true;
}

}  // namespace

std::optional<SpilledRows> SpilledRows::create() {
  const char* folder = std::getenv("TMPDIR");
  std::string path = std::string(folder != nullptr ? folder : "/var/tmp") + "/palpate-rows-XXXXXX";
  const int file = mkostemp(path.data(), O_CLOEXEC);
  if (file < 0) return std::nullopt;
  unlink(path.c_str());
  return SpilledRows(file);
}

SpilledRows::SpilledRows(SpilledRows&& other) noexcept
    : file_(std::exchange(other.file_, -1)), count_(other.count_), waiting_(std::move(other.waiting_)) {}

SpilledRows& SpilledRows::operator=(SpilledRows&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(count_, other.count_);
  std::swap(waiting_, other.waiting_);
  return *this;
}

SpilledRows::~SpilledRows() {
  if (file_ >= 0) close(file_);
}

bool SpilledRows::add(const Row& row) {
  waiting_.push_back(row);
  ++count_;
  return waiting_.size() < kWaitingRows || flush();
}

bool SpilledRows::flush() {
  if (!has_room(file_)) return false;
  const bool written = transfer_all(reinterpret_cast<const char*>(waiting_.data()), waiting_.size() * sizeof(Row),
                                    [&](const char* at, std::size_t size) { return write(file_, at, size); });
  waiting_.clear();
  return written;
}

Status SpilledRows::read(std::size_t first, std::span<Row> rows) const {
  auto offset = static_cast<off_t>(first * sizeof(Row));
  errno = 0;
  const bool there =
      transfer_all(reinterpret_cast<char*>(rows.data()), rows.size_bytes(), [&](char* at, std::size_t size) {
        const ssize_t done = pread(file_, at, size, offset);
        if (done > 0) offset += done;
        return done;
      });
  if (there) return {};
  return Error{std::string("cannot read back the temporary file of a long recording: ") +
               (errno != 0 ? std::strerror(errno) : "it has become shorter") +
               "; check the disk of $TMPDIR or /var/tmp"};
}

}  // namespace palpate
