#include "engine/base/whole_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace palpate {

Result<std::unique_ptr<std::istream>> open_plain_file(const std::string& path, const std::string& expected,
                                                      const std::string& or_else) {
  const auto wrong = [&](const std::string& found, const std::string& advice) {
    return Error{path + ": found " + found + ", expected " + expected + "; " + advice};
  };
  struct stat status {};
  // stat comes first, because opening can block and can affect a device.
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return wrong("a folder", "name a file in it");
  if (exists && !S_ISREG(status.st_mode)) return wrong("a pipe or a device", "save it to a file first");
  if (exists) {
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (*file) return Result<std::unique_ptr<std::istream>>(std::move(file));
  }
  if (errno == ENOENT || errno == ENOTDIR) return wrong("no such file", "check the path" + or_else);
  if (errno == EACCES || errno == EPERM) return wrong("no permission to read it", "change its permissions (chmod u+r)");
  return Error{path + ": the file cannot be opened (" + std::strerror(errno) + "); check the path"};
}

Error unreadable(const std::string& path) {
  return Error{path + ": the file cannot be read (" + std::strerror(errno) +
               "); check the disk or copy the file elsewhere"};
}

Result<std::string> read_plain_file(const std::string& path, const std::string& expected, const std::string& or_else,
                                    std::size_t most_bytes) {
  const auto file = open_plain_file(path, expected, or_else);
  if (!file) return file.error();
  std::string text;
  std::string chunk(std::size_t{1} << 18, '\0');
  while (**file) {
    (*file)->read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if ((*file)->bad()) return unreadable(path);
    text.append(chunk, 0, static_cast<std::size_t>((*file)->gcount()));
    if (text.size() > most_bytes)
      return Error{path + ": found more than " + std::to_string(most_bytes >> 20) + " MiB, expected " + expected +
                   "; split the file or name another one"};
  }
  return text;
}

std::optional<std::string> read_whole_file(const std::string& path) {
  Result<std::string> text = read_plain_file(path, "a small file");
  if (!text) return std::nullopt;
  return std::move(*text);
}

}  // namespace palpate
