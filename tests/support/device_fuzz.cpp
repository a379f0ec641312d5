#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"
#include "devices/hid/hidapi_bus.h"
#include "devices/link/device_link.h"
#include "tests/support/fuzz_checks.h"
#include "tests/support/simulated_device.h"

namespace palpate::test {
namespace {

using DeviceFinder = bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice>;
using HostFinder = bridge::FrameFinder<bridge::kHostBytes, bridge::kFromHost>;

constexpr unsigned kChecksumAt = bridge::kDeviceBytes - 4;

bool has_checksum(const std::uint8_t* frame) {
  return wire::crc32(frame, kChecksumAt) == wire::read32(frame + kChecksumAt);
}

// An endpoint all of whose outputs are checked.
class CheckedEndpoint {
 public:
  explicit CheckedEndpoint(const DeviceProtocol* protocol)
      : protocol_(protocol), endpoint_(std::make_unique<DeviceEndpoint>(example_calibration(protocol))) {
    endpoint_->connected(now_s_);
  }

  DeviceEndpoint& endpoint() { return *endpoint_; }
  double now_s() const { return now_s_; }

  // A report that arrives `after_s` later, and a tick that asks for `force_N`.
  void take(const std::uint8_t* bytes, std::size_t size, double after_s, double force_N) {
    now_s_ += after_s;
    endpoint_->report_arrived(bytes, size, now_s_);
    DeviceSample sample;
    while (endpoint_->read(now_s_, sample)) {
      require(std::isfinite(sample.tool.position_m) && std::isfinite(sample.tool.time_s), "sample not finite");
      require(sample.tool.time_s > last_sample_s_, "time does not go on");
      last_sample_s_ = sample.tool.time_s;
    }
    const DeviceHealth health = endpoint_->health(now_s_);
    require((health.faults & ~fault_bits_of(FaultSource::device)) == 0, "unknown fault");
    require(health.sample_age_s >= 0.0, "a sample from the future");
    require(!std::isnan(health.zeroing_progress) && health.zeroing_progress <= 1.0F, "progress");
    endpoint_->write(force_N);
    check_sent(endpoint_->next(now_s_));
    endpoint_->written(now_s_);
  }

 private:
  void check_sent(const OutReports& reports) const {
    require(reports.count <= reports.sizes.size(), "too many reports");
    for (std::size_t i = 0; i < reports.count; ++i) require(reports.sizes[i] <= kLargestReport + 1, "too long");
    if (protocol_ != &kBridgeProtocol || reports.count == 0) return;
    bridge::FromHost out{};
    HostFinder finder;
    bool found = false;
    for (std::size_t i = 0; i < reports.sizes[0]; ++i) found = finder.add(reports.bytes[0][i]) == bridge::Found::frame;
    require(found && bridge::decode(finder.frame(), out), "sent a bad frame");
    require(std::abs(out.force_uN) <= 5'000'000, "above the peak");
  }

  const DeviceProtocol* protocol_;
  std::unique_ptr<DeviceEndpoint> endpoint_;
  double now_s_ = 100.0, last_sample_s_ = 0.0;
};

struct Stream {
  std::vector<std::uint8_t> bytes;
  std::uint32_t whole = 0;  // whole frames, numbered from 0
};

Stream expanded(const std::uint8_t* data, std::size_t size) {
  Stream stream;
  for (std::size_t i = 0; i < size; ++i) {
    if (i + 2 >= size || data[i] != 0x00 || data[i + 1] != 0xF5) {
      stream.bytes.push_back(data[i]);
      continue;
    }
    const std::uint32_t sequence = stream.whole++;
    std::uint8_t frame[bridge::kDeviceBytes];
    bridge::encode(bridge::FromDevice{sequence, 1000 * sequence, data[i + 2] * 100'000, 0, 0, 0}, frame);
    stream.bytes.insert(stream.bytes.end(), frame, frame + bridge::kDeviceBytes);
    i += 2;
  }
  return stream;
}

void check_decoder(const DeviceProtocol* protocol, const std::uint8_t* bytes, std::size_t size) {
  DeviceReading reading;
  const ReportVerdict verdict = protocol->decode(bytes, size, reading);
  DeviceReading again;
  require(protocol->decode(bytes, size, again) == verdict && again.counts == reading.counts, "not repeatable");
  if (verdict != ReportVerdict::position) return;
  if (protocol == &kSpaceMouseProtocol) require(std::abs(reading.counts) <= 1000, "beyond any deflection");
  if (protocol == &kOpenFfBoardProtocol) require(size == 25 && bytes[0] == 0xA1, "not a vendor report");
  if (protocol == &kBridgeProtocol) require(size == bridge::kDeviceBytes && has_checksum(bytes), "not a frame");
}

}  // namespace

std::size_t check_bridge_stream(const std::uint8_t* data, std::size_t size) {
  const Stream stream = expanded(data, size);
  DeviceFinder finder;
  HostFinder other;
  CheckedEndpoint host(&kBridgeProtocol);
  std::size_t found = 0;
  std::uint32_t next_whole = 0;
  for (const std::uint8_t byte : stream.bytes) {
    other.add(byte);
    if (finder.add(byte) != bridge::Found::frame) continue;
    ++found;
    const std::uint8_t* frame = finder.frame();
    require(has_checksum(frame) && frame[0] == 0x50 && frame[3] == 0x49, "checksum");
    if (next_whole < stream.whole && wire::read32(frame + 4) == next_whole) ++next_whole;
    host.take(frame, bridge::kDeviceBytes, 1e-3, 1e3);
  }
  // The last frame may still be inside an unfinished false frame.
  require(next_whole + 1 >= stream.whole, "a whole frame was not found");
  // Also feeds the raw bytes as a report of any length.
  host.take(data, std::min<std::size_t>(size, kLargestReport), 1e-3, 1e3);
  return found;
}

std::size_t check_hid_reports(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const DeviceProtocol* protocol = kHidProtocols[data[0] % kHidProtocols.size()];
  // Bit 2: frames of the bridge get a correct checksum.
  const bool mended = (data[0] & 4) != 0;
  CheckedEndpoint host(protocol);
  std::size_t count = 0;
  for (std::size_t at = 1; at + 2 <= size; ++count) {
    const std::size_t length = std::min<std::size_t>(data[at] % 80u, size - at - 2);
    const std::uint8_t step = data[at + 1];
    // A copy of the exact length, so that the address sanitizer detects overruns.
    std::vector<std::uint8_t> report(data + at + 2, data + at + 2 + length);
    if (mended && protocol == &kBridgeProtocol && length == bridge::kDeviceBytes) {
      const std::uint8_t header[] = {0x50, 0x42, bridge::kVersion, bridge::kFromDevice};
      std::copy(header, header + 4, report.begin());
      wire::write32(report.data() + kChecksumAt, wire::crc32(report.data(), kChecksumAt));
    }
    check_decoder(protocol, report.data(), report.size());
    if (step == 255) host.endpoint().start_zeroing();
    if (step == 254) host.endpoint().unplugged();
    host.take(report.data(), report.size(), 50e-6 * step, step * 1e3);
    at += 2 + length;
  }
  return count;
}

}  // namespace palpate::test
