#include "devices/link/device_protocol.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

// The largest depth of nesting; the format needs one level.
constexpr int kCalibrationNesting = 4;

// Reads what only a device that renders force has.
void read_force(JsonFields& fields, const JsonNode& top, DeviceCalibration& calibration) {
  const auto number = [&](const char* key, double low, double high) { return fields.number(top, key, {low, high}); };
  ForceLimits& limits = calibration.limits;
  const std::size_t before = fields.error_count();
  calibration.fastest_m_per_s = number("fastest_m_per_s", 0.01, 100.0);
  calibration.force_N_per_unit = calibration.protocol->absolute ? 1e-6 : number("force_N_per_unit", 1e-9, 1e3);
  calibration.stuck_after_s = number("stuck_after_s", 0.05, 60.0);
  limits.largest_N = number("peak_N", 1e-3, 100.0);
  limits.continuous_N = number("continuous_N", 1e-3, 100.0);
  limits.thermal_time_s = number("thermal_time_s", 0.1, 1e4);
  limits.fastest_N_per_s = number("fastest_N_per_s", 1.0, 1e6);
  limits.ramp_s = number("ramp_s", 0.05, 10.0);
  limits.stale_after_s = number("stale_after_s", 0.002, 0.01);
  if (fields.error_count() == before && limits.continuous_N > limits.largest_N) {
    fields.complain("/continuous_N", found(top.value->at("continuous_N")) + ", expected at most peak_N");
  }
}

}  // namespace

Result<DeviceCalibration> read_calibration(const std::string& folder, const DeviceProtocol& protocol) {
  const std::string path = folder + "/" + protocol.name + ".json";
  const std::optional<std::string> text = read_whole_file(path);
  if (!text) return Error{path + ": cannot be read; set PALPATE_ASSETS to the assets folder (with assets/devices/)"};
  const Result<nlohmann::json> document = parse_json(*text, path, kCalibrationNesting, {});
  if (!document) return document.error();
  JsonFields fields(*text, path, "");
  const JsonNode top{&*document, ""};
  DeviceCalibration calibration;
  calibration.protocol = &protocol;
  fields.choice(fields.member(top, "kind", "the kind of device"), {protocol.name});
  if (protocol.absolute) {
    calibration.counts_per_metre = 1e9;
    calibration.encoder_step_m = fields.number(top, "encoder_step_m", {1e-9, 1e-3});
  } else {
    calibration.counts_per_metre = fields.number(top, "counts_per_metre", {1.0, 1e9});
  }
  calibration.direction = fields.number(top, "direction", {-1.0, 1.0});
  const JsonNode direction = fields.optional_member(top, "direction");
  if (direction.value != nullptr && std::abs(calibration.direction) != 1.0)
    fields.complain(direction.pointer, found(*direction.value) + ", expected 1 or -1");
  calibration.rest_position_m = fields.number(top, "rest_position_m", {-1.0, 1.0});
  if (protocol.renders_force) read_force(fields, top, calibration);
  fields.refuse_unknown(top);
  if (std::optional<Error> wrong = fields.error()) return *wrong;
  return calibration;
}

}  // namespace palpate
