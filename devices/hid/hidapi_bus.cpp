#include "devices/hid/hidapi_bus.h"

#include <fcntl.h>
#include <hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>

namespace palpate {
namespace {

// hidapi keeps the error of hid_enumerate and hid_open_path in one global.
std::mutex hidapi_mutex;

std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != L'\0'; ++text)
    result += *text >= L' ' && *text < 0x7F ? static_cast<char>(*text) : '?';
  return result;
}

class HidapiConnection final : public DeviceConnection {
 public:
  HidapiConnection(hid_device* reader, int descriptor, int wait_ms) noexcept
      : reader_(reader), descriptor_(descriptor), wait_ms_(wait_ms) {}
  HidapiConnection(const HidapiConnection&) = delete;
  HidapiConnection& operator=(const HidapiConnection&) = delete;
  ~HidapiConnection() override {
    hid_close(reader_);
    ::close(descriptor_);
  }

  int read(std::uint8_t* bytes, std::size_t capacity) noexcept override {
    return wait_ms_ < 0 ? hid_read(reader_, bytes, capacity) : hid_read_timeout(reader_, bytes, capacity, wait_ms_);
  }
  // As hid_write of hidraw, but without the handle's last error, which has no lock.
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept override {
    return ::write(descriptor_, bytes, size) >= 0;
  }
  int descriptor() const noexcept override { return descriptor_; }

 private:
  hid_device* reader_;
  int descriptor_, wait_ms_;
};

}  // namespace

std::string open_error_words(const std::string& path, int error_number) {
  switch (error_number) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return path +
             ": the device is plugged in but has no node; unplug it and plug it in again (in a container, pass the "
             "node in)";
    case EACCES:
    case EPERM:
      return path +
             ": no permission; install assets/udev/70-palpate.rules in /etc/udev/rules.d, then plug the "
             "device in again";
    case EBUSY:
    case EWOULDBLOCK:
      return path + ": in use by another program; close it";
    default:
      return path + ": " + std::strerror(error_number);
  }
}

std::vector<DeviceNode> HidapiBus::list() {
  const std::lock_guard<std::mutex> lock(hidapi_mutex);
  std::vector<DeviceNode> all;
  hid_device_info* const first = hid_enumerate(0, 0);
  for (const hid_device_info* entry = first; entry != nullptr; entry = entry->next) {
    const DeviceNode info{entry->path != nullptr ? entry->path : "",
                          narrow(entry->product_string),
                          entry->vendor_id,
                          entry->product_id,
                          entry->usage_page,
                          entry->usage};
    // hidapi lists a node once for each usage in its descriptor, one after the other; one with a protocol is preferred.
    if (all.empty() || all.back().path != info.path) {
      all.push_back(info);
    } else if (hid_protocol_of(info) != nullptr) {
      all.back() = info;
    }
  }
  hid_free_enumeration(first);
  return all;
}

Result<std::unique_ptr<DeviceConnection>> HidapiBus::open(const DeviceNode& info) {
  if (info.path.empty()) return Error{open_error_words(info.product, ENOENT)};
  const int descriptor = ::open(info.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0 || flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int error_number = errno;
    ::close(descriptor);
    return Error{open_error_words(info.path, error_number)};
  }
  const std::lock_guard<std::mutex> lock(hidapi_mutex);
  hid_device* const reader = hid_open_path(info.path.c_str());
  if (reader == nullptr) {
    const std::string words = narrow(hid_error(nullptr));
    ::close(descriptor);
    return Error{info.path + ": cannot be opened as a HID device (" + words + "); plug it in again"};
  }
  return Result<std::unique_ptr<DeviceConnection>>(std::make_unique<HidapiConnection>(reader, descriptor, wait_ms_));
}

DeviceBus& system_hid_bus() {
  static HidapiBus bus;
  return bus;
}

}  // namespace palpate
