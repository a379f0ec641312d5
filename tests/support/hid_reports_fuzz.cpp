#include "tests/support/hid_reports_fuzz.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "devices/bridge/bridge_bus.h"
#include "devices/firmware/bridge_protocol.h"
#include "devices/hid/hid_protocols.h"
#include "devices/link/device_endpoint.h"

namespace palpate::test {
namespace {

constexpr unsigned kChecksumAt = bridge::kDeviceBytes - 4;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "hid report: %s\n", what);
  std::abort();
}

DeviceCalibration calibration_of(const DeviceProtocol* protocol) {
  DeviceCalibration calibration;
  calibration.protocol = protocol;
  calibration.counts_per_metre = 50000.0;
  calibration.rest_position_m = -0.01;
  calibration.fastest_m_per_s = 5.0;
  calibration.force_N_per_unit = 0.004;
  calibration.stuck_after_s = 0.5;
  calibration.limits = {5.0, 200.0, 0.1};
  return calibration;
}

void check_decoder(const DeviceProtocol* protocol, const std::uint8_t* bytes, std::size_t size) {
  DeviceReading reading;
  const ReportVerdict verdict = protocol->decode(bytes, size, reading);
  DeviceReading again;
  require(protocol->decode(bytes, size, again) == verdict && again.counts == reading.counts, "not repeatable");
  if (verdict != ReportVerdict::position) return;
  if (protocol == &kSpaceMouseProtocol) require(std::abs(reading.counts) <= 1000, "beyond any deflection");
  if (protocol == &kOpenFfBoardProtocol) require(size == 25 && bytes[0] == 0xA1, "not a vendor report");
  if (protocol != &kBridgeProtocol) return;
  require(size == bridge::kDeviceBytes, "not a frame");
  require(wire::crc32(bytes, kChecksumAt) == wire::read32(bytes + kChecksumAt), "checksum");
}

void check_handed_over(DeviceEndpoint& endpoint, double now_s, double& last_sample_s) {
  DeviceSample sample;
  if (endpoint.read(now_s, sample)) {
    require(std::isfinite(sample.tool.position_m) && std::isfinite(sample.tool.time_s), "sample not finite");
    require(sample.tool.time_s > last_sample_s, "time does not go on");
    last_sample_s = sample.tool.time_s;
  }
  const DeviceHealth health = endpoint.health(now_s);
  require((health.faults & ~fault_bits_of(FaultSource::device)) == 0, "unknown fault");
  require(health.sample_age_s >= 0.0, "a sample from the future");
  require(!std::isnan(health.zeroing_progress) && health.zeroing_progress <= 1.0F, "progress");
}

void check_sent(const DeviceProtocol* protocol, const OutReports& reports) {
  require(reports.count <= reports.sizes.size(), "too many reports");
  for (std::size_t i = 0; i < reports.count; ++i) require(reports.sizes[i] <= kLargestReport + 1, "too long");
  if (protocol != &kBridgeProtocol || reports.count == 0) return;
  bridge::FromHost out{};
  require(bridge::decode(reports.bytes[0].data(), out), "sent a bad frame");
  require(std::abs(out.force_uN) <= 1250, "above the peak");
}

// Feeds a stream of reports to their decoder and to an endpoint.
class Stream {
 public:
  explicit Stream(const DeviceProtocol* protocol) : protocol_(protocol), endpoint_(calibration_of(protocol)) {
    endpoint_.connected(now_s_);
  }

  void take(const std::uint8_t* bytes, std::size_t size, std::uint8_t step) {
    now_s_ += 50e-6 * step;
    check_decoder(protocol_, bytes, size);
    if (step == 255) endpoint_.start_zeroing();
    if (step == 254) endpoint_.unplugged();
    endpoint_.report_arrived(bytes, size, now_s_);
    check_handed_over(endpoint_, now_s_, last_sample_s_);
    endpoint_.write(step * 1e3);
    check_sent(protocol_, endpoint_.next(now_s_));
    endpoint_.written(now_s_);
  }

 private:
  const DeviceProtocol* protocol_;
  DeviceEndpoint endpoint_;
  double now_s_ = 100.0;
  double last_sample_s_ = 0.0;
};

}  // namespace

std::size_t check_hid_reports(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const DeviceProtocol* protocol = kHidProtocols[data[0] % kHidProtocols.size()];
  // Bit 2: frames of the bridge get a correct checksum.
  const bool mended = (data[0] & 4) != 0;
  Stream stream(protocol);
  std::size_t count = 0;
  for (std::size_t at = 1; at + 2 <= size; ++count) {
    const std::size_t length = std::min<std::size_t>(data[at] % 80u, size - at - 2);
    // A copy of the exact length, so that the address sanitizer detects overruns.
    std::vector<std::uint8_t> report(data + at + 2, data + at + 2 + length);
    if (mended && protocol == &kBridgeProtocol && length == bridge::kDeviceBytes) {
      const std::uint8_t header[] = {0x50, 0x42, bridge::kVersion, bridge::kFromDevice};
      std::copy(header, header + 4, report.begin());
      wire::write32(report.data() + kChecksumAt, wire::crc32(report.data(), kChecksumAt));
    }
    stream.take(report.data(), report.size(), data[at + 1]);
    at += 2 + length;
  }
  return count;
}

}  // namespace palpate::test
