// An emulated OpenFFBoard: sysfs entries and a hidraw node made by umockdev, which
// the real libhidapi enumerates, opens, reads and writes. A model of its firmware
// (tests/support/simulated_device.h) answers.
//
// Limitation of umockdev 0.17: poll() never reports its node as readable, so that
// only a blocking hid_read gets a report.
#pragma once

#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/simulated_device.h"

namespace palpate::test {

// Vendor-defined page 0xFF00, usage 1, report 0xA1 of 24 bytes each way.
inline constexpr guint8 kDescriptor[] = {0x06, 0x00, 0xFF, 0x09, 0x01, 0xA1, 0x01, 0x85, 0xA1, 0x75,
                                         0x08, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x95, 0x18, 0x09, 0x01,
                                         0x81, 0x02, 0x95, 0x18, 0x09, 0x02, 0x91, 0x02, 0xC0};

inline constexpr char kDescription[] =
    "P: /devices/usb1/1-1\n"
    "N: bus/usb/001/002\n"
    "E: DEVTYPE=usb_device\n"
    "E: SUBSYSTEM=usb\n"
    "A: idVendor=1209\n"
    "A: idProduct=ffb0\n"
    "A: bcdDevice=0100\n"
    "A: manufacturer=OpenFFBoard\n"
    "A: product=FFBoard\n"
    "A: serial=12345\n"
    "\n"
    "P: /devices/usb1/1-1/1-1:1.0\n"
    "E: DEVTYPE=usb_interface\n"
    "E: SUBSYSTEM=usb\n"
    "A: bInterfaceNumber=00\n"
    "\n"
    "P: /devices/usb1/1-1/1-1:1.0/0003:1209:FFB0.0001\n"
    "E: SUBSYSTEM=hid\n"
    "E: HID_ID=0003:00001209:0000FFB0\n"
    "E: HID_NAME=FFBoard\n"
    "E: HID_UNIQ=12345\n"
    "H: report_descriptor=0600FF0901A10185A17508150026FF00951809018102951809029102C0\n"
    "\n"
    "P: /devices/usb1/1-1/1-1:1.0/0003:1209:FFB0.0001/hidraw/hidraw0\n"
    "N: hidraw0\n"
    "L: device=../../../0003:1209:FFB0.0001\n"
    "E: SUBSYSTEM=hidraw\n"
    "E: DEVNAME=/dev/hidraw0\n";

// A subclass of UMockdevIoctlBase that forwards all calls to an EmulatedBoard.
class EmulatedBoard;
struct NodeHandler {
  UMockdevIoctlBase parent;
  EmulatedBoard* board;
};
struct NodeHandlerClass {
  UMockdevIoctlBaseClass parent;
};

G_GNUC_BEGIN_IGNORE_DEPRECATIONS
G_DEFINE_TYPE(NodeHandler, node_handler, UMOCKDEV_TYPE_IOCTL_BASE)
G_GNUC_END_IGNORE_DEPRECATIONS

class EmulatedBoard {
 public:
  EmulatedBoard()
      : testbed_(umockdev_testbed_new()),
        handler_(UMOCKDEV_IOCTL_BASE(g_object_new(node_handler_get_type(), nullptr))) {
    reinterpret_cast<NodeHandler*>(handler_)->board = this;
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(testbed_, kDescription, &error) ||
        !umockdev_testbed_attach_ioctl(testbed_, "/dev/hidraw0", handler_, &error)) {
      g_error("umockdev: %s", error->message);
    }
  }
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;
  ~EmulatedBoard() {
    umockdev_testbed_detach_ioctl(testbed_, "/dev/hidraw0", nullptr);
    g_object_unref(handler_);
    g_object_unref(testbed_);
  }

  // Called by the node, on the thread of umockdev.
  bool ioctl(UMockdevIoctlClient* client) {
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const gulong request = umockdev_ioctl_client_get_request(client);
    if (request == HIDIOCGRDESCSIZE) {
      int size = sizeof kDescriptor;
      UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof size, nullptr);
      umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&size), sizeof size);
      umockdev_ioctl_data_unref(data);
    } else if (request == HIDIOCGRDESC) {
      UMockdevIoctlData* const data =
          umockdev_ioctl_data_resolve(argument, 0, sizeof(hidraw_report_descriptor), nullptr);
      std::vector<guint8> bytes(kDescriptor, kDescriptor + sizeof kDescriptor);
      umockdev_ioctl_data_update(data, offsetof(hidraw_report_descriptor, value), bytes.data(),
                                 static_cast<gint>(bytes.size()));
      umockdev_ioctl_data_unref(data);
    } else {
      return false;
    }
    umockdev_ioctl_client_complete(client, 0, 0);
    return true;
  }
  bool read(UMockdevIoctlClient* client) {
    if (gone) {
      umockdev_ioctl_client_complete(client, -1, EIO);
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const auto since = std::chrono::steady_clock::now() - start_;
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since).count();
    board_.step(static_cast<std::uint32_t>(us), 1000);
    motor_units = board_.force_units();
    board_.be_asked();
    Report report = board_.outbox.back();
    board_.outbox.clear();
    UMockdevIoctlData* const data = umockdev_ioctl_client_get_arg(client);
    const gint size = std::min(data->data_len, static_cast<gint>(report.size()));
    umockdev_ioctl_data_update(data, 0, report.data(), size);
    umockdev_ioctl_client_complete(client, size, 0);
    return true;
  }
  bool write(UMockdevIoctlClient* client) {
    UMockdevIoctlData* const data = umockdev_ioctl_client_get_arg(client);
    ++writes;
    last_write_size = static_cast<std::size_t>(data->data_len);
    if (gone) {
      umockdev_ioctl_client_complete(client, -1, EIO);
      return true;
    }
    const bool force = wire::read16(data->data + 2) == 0xA03 && wire::read32(data->data + 5) == 4;
    if (force) told_units = static_cast<int>(wire::read32(data->data + 9));
    board_.hear(Report(data->data, data->data + data->data_len));
    umockdev_ioctl_client_complete(client, data->data_len, 0);
    return true;
  }

  std::atomic<bool> gone{false};  // reads and writes fail
  std::atomic<double> motor_units{0.0};
  std::atomic<int> told_units{0};  // the last force written
  std::atomic<int> writes{0};
  std::atomic<std::size_t> last_write_size{0};

 private:
  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  OpenFfBoardModel board_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

template <bool (EmulatedBoard::*call)(UMockdevIoctlClient*)>
gboolean forward(UMockdevIoctlBase* self, UMockdevIoctlClient* client) {
  return (reinterpret_cast<NodeHandler*>(self)->board->*call)(client);
}
static void node_handler_init(NodeHandler*) {}
static void node_handler_class_init(NodeHandlerClass* type) {
  type->parent.handle_ioctl = forward<&EmulatedBoard::ioctl>;
  type->parent.handle_read = forward<&EmulatedBoard::read>;
  type->parent.handle_write = forward<&EmulatedBoard::write>;
}

}  // namespace palpate::test
