#include "models/model/file/model_io.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "engine/base/atomic_file.h"
#include "models/model/file/model_json.h"

namespace palpate {
namespace {

Error cannot_open(const std::string& path, int error_number) {
  if (error_number == ENOENT || error_number == ENOTDIR) {
    return Error{path + ": found no such file, expected a model file; check the path, or make one with palpate fit"};
  }
  return Error{path + ": the file cannot be read (" + std::strerror(error_number) + "); check its permissions"};
}

// A pipe or a device could block for ever or never end; the question comes
// before the opening, which can do things to a device.
Status check_is_model_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return cannot_open(path, errno);
  if (S_ISDIR(status.st_mode)) return Error{path + ": found a folder, expected a model file; name a file in it"};
  if (!S_ISREG(status.st_mode)) {
    return Error{path + ": found a pipe or a device, expected a model file; save it to a file first"};
  }
  if (static_cast<std::uintmax_t>(status.st_size) > kMaximumModelFileBytes) {
    return Error{path + ": found " + std::to_string(status.st_size) + " bytes, expected at most " +
                 std::to_string(kMaximumModelFileBytes) + "; name a file that palpate fit wrote"};
  }
  return {};
}

Result<std::string> read_file(const std::string& path) {
  if (const Status file = check_is_model_file(path); !file) return file.error();
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return cannot_open(path, errno);
  std::string text;
  int error_number = 0;
  std::string chunk(std::size_t{1} << 18, '\0');
  // The limit again, for a file that grows while it is read.
  while (text.size() <= kMaximumModelFileBytes) {
    const ssize_t count = ::read(descriptor, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) error_number = errno;
    if (count <= 0) break;
    text.append(chunk, 0, static_cast<std::size_t>(count));
  }
  ::close(descriptor);
  if (error_number != 0) return cannot_open(path, error_number);
  return text;
}

}  // namespace

Status save_model(const std::string& path, const ModelData& data, bool overwrite) {
  const Result<std::string> text = write_model_text(data);
  if (!text) return Error{"cannot write " + path + ": " + text.error().message};
  return write_file_atomically(path, *text, overwrite);
}

Result<std::shared_ptr<const FittedModel>> load_model(const std::string& path) try {
  const Result<std::string> text = read_file(path);
  if (!text) return text.error();
  Result<ModelData> data = read_model_text(*text, path);
  if (!data) return data.error();
  return std::make_shared<const FittedModel>(std::move(*data));
} catch (const std::bad_alloc&) {
  return Error{path + ": found more data than memory holds, expected a model file; name a file that palpate fit wrote"};
}

}  // namespace palpate
