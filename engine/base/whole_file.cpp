#include "engine/base/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "engine/base/csv_scanner.h"

namespace palpate {

Result<int> open_plain_file(const std::string& path, const std::string& expected, const std::string& or_else) {
  const auto wrong = [&](const std::string& found, const std::string& advice) {
    return Error{path + ": found " + found + ", expected " + expected + "; " + advice};
  };
  struct stat status {};
  // stat comes first, because opening can affect a device. O_NONBLOCK, in case a pipe has replaced the file meanwhile.
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return wrong("a folder", "name a file in it");
  if (exists && !S_ISREG(status.st_mode)) return wrong("a pipe or a device", "save it to a file first");
  const int descriptor = exists ? ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY) : -1;
  if (descriptor >= 0) return descriptor;
  if (errno == ENOENT || errno == ENOTDIR) return wrong("no such file", "check the path" + or_else);
  if (errno == EACCES || errno == EPERM) return wrong("no permission to read it", "change its permissions (chmod u+r)");
  return Error{path + ": the file cannot be opened (" + std::strerror(errno) + "); check the path"};
}

Result<std::string> read_plain_file(const std::string& path, const std::string& expected, const std::string& or_else,
                                    std::size_t most_bytes) {
  const Result<int> descriptor = open_plain_file(path, expected, or_else);
  if (!descriptor) return descriptor.error();
  DescriptorSource source(*descriptor);
  std::string text;
  std::string chunk(std::size_t{1} << 18, '\0');
  for (;;) {
    const Result<std::size_t> count = source.read(chunk.data(), chunk.size());
    if (!count) return Error{path + ": " + count.error().message};
    if (*count == 0) return text;
    if (text.size() + *count > most_bytes)
      return Error{path + ": found more than " + std::to_string(most_bytes) + " bytes, expected " + expected +
                   "; name another file"};
    text.append(chunk, 0, *count);
  }
}

std::optional<std::string> read_whole_file(const std::string& path) {
  Result<std::string> text = read_plain_file(path, "a small file");
  if (!text) return std::nullopt;
  return std::move(*text);
}

}  // namespace palpate
