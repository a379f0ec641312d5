#include "devices/hid/hid_protocols.h"

#include <utility>

namespace palpate {

const DeviceProtocol* hid_protocol_of(const DeviceNode& node) {
  for (const DeviceProtocol* protocol : kHidProtocols) {
    if (protocol->matches(node)) return protocol;
  }
  return nullptr;
}

std::vector<HidDiagnosis> diagnose(DeviceBus& bus) {
  std::vector<HidDiagnosis> all;
  for (const DeviceNode& node : bus.list()) {
    HidDiagnosis diagnosis{node, "not supported", ""};
    if (const DeviceProtocol* const protocol = hid_protocol_of(node)) {
      diagnosis.use = protocol->description;
      const Result<std::unique_ptr<DeviceConnection>> connection = bus.open(node);
      if (!connection) diagnosis.problem = connection.error().message;
    }
    all.push_back(std::move(diagnosis));
  }
  return all;
}

}  // namespace palpate
