#include "tests/support/bridge_stream_fuzz.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"
#include "devices/link/device_endpoint.h"

namespace palpate::test {
namespace {

using DeviceFinder = bridge::FrameFinder<bridge::kDeviceBytes, bridge::kFromDevice>;
using HostFinder = bridge::FrameFinder<bridge::kHostBytes, bridge::kFromHost>;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "bridge stream: %s\n", what);
  std::abort();
}

DeviceCalibration calibration() {
  DeviceCalibration calibration;
  calibration.protocol = &kBridgeProtocol;
  calibration.counts_per_metre = 1e9;
  calibration.fastest_m_per_s = 5.0;
  calibration.force_N_per_unit = 1e-6;
  calibration.stuck_after_s = 0.5;
  calibration.limits = {5.0, 200.0, 0.1};
  return calibration;
}

struct Stream {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint32_t> whole;  // sequence numbers of whole frames
};

Stream expanded(const std::uint8_t* data, std::size_t size) {
  Stream stream;
  for (std::size_t i = 0; i < size; ++i) {
    if (i + 2 >= size || data[i] != 0x00 || data[i + 1] != 0xF5) {
      stream.bytes.push_back(data[i]);
      continue;
    }
    const auto sequence = static_cast<std::uint32_t>(stream.whole.size());
    std::uint8_t frame[bridge::kDeviceBytes];
    bridge::encode(bridge::FromDevice{sequence, 1000 * sequence, data[i + 2] * 100'000, 0, 0, 0}, frame);
    stream.bytes.insert(stream.bytes.end(), frame, frame + bridge::kDeviceBytes);
    stream.whole.push_back(sequence);
    i += 2;
  }
  return stream;
}

class Host {
 public:
  Host() : endpoint_(std::make_unique<DeviceEndpoint>(calibration())) { endpoint_->connected(now_s_); }

  void take(const std::uint8_t* frame, std::size_t size) {
    now_s_ += 1e-3;
    endpoint_->report_arrived(frame, size, now_s_);
    DeviceSample sample;
    while (endpoint_->read(now_s_, sample)) {
      require(std::isfinite(sample.tool.position_m) && sample.tool.time_s > last_s_, "sample");
      last_s_ = sample.tool.time_s;
    }
    const DeviceHealth health = endpoint_->health(now_s_);
    require((health.faults & ~fault_bits_of(FaultSource::device)) == 0 && health.sample_age_s >= 0.0, "health");
    endpoint_->write(1e3);
    const OutReports out = endpoint_->next(now_s_);
    if (out.count == 0) return;
    bridge::FromHost command{};
    HostFinder finder;
    bool found = false;
    for (std::size_t i = 0; i < out.sizes[0]; ++i) found = finder.add(out.bytes[0][i]);
    require(found && bridge::decode(finder.frame(), command), "sent a bad frame");
    require(std::abs(command.force_uN) <= 5'000'000, "above the peak");
    endpoint_->written(now_s_);
  }

 private:
  std::unique_ptr<DeviceEndpoint> endpoint_;
  double now_s_ = 100.0, last_s_ = 0.0;
};

}  // namespace

std::size_t check_bridge_stream(const std::uint8_t* data, std::size_t size) {
  const Stream stream = expanded(data, size);
  DeviceFinder finder;
  HostFinder other;
  Host host;
  std::size_t found = 0, next_whole = 0;
  for (const std::uint8_t byte : stream.bytes) {
    other.add(byte);
    if (!finder.add(byte)) continue;
    ++found;
    const std::uint8_t* frame = finder.frame();
    require(wire::crc32(frame, 24) == wire::read32(frame + 24) && frame[0] == 0x50 && frame[3] == 0x49, "checksum");
    if (next_whole < stream.whole.size() && wire::read32(frame + 4) == stream.whole[next_whole]) ++next_whole;
    host.take(frame, bridge::kDeviceBytes);
  }
  const std::size_t counted = found * bridge::kDeviceBytes + finder.skipped();
  require(counted <= stream.bytes.size() && counted + bridge::kDeviceBytes > stream.bytes.size(), "bytes lost");
  // The last frame may still be inside an unfinished false frame.
  require(next_whole + 1 >= stream.whole.size(), "a whole frame was not found");
  // Also feeds the raw bytes as a report of any length.
  host.take(data, size < kLargestReport ? size : kLargestReport);
  return found;
}

}  // namespace palpate::test
