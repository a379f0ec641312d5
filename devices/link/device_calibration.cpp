#include "devices/link/device_calibration.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "engine/base/whole_file.h"
#include "engine/json/json_fields.h"

namespace palpate {
namespace {

// The largest depth of nesting; the format needs one level.
constexpr int kCalibrationNesting = 4;

class CalibrationReader : private JsonFields {
 public:
  CalibrationReader(std::string_view text, const std::string& path, const nlohmann::json& document,
                    const DeviceProtocol& protocol)
      : JsonFields(text, path, ""), top_{&document, ""} {
    calibration_.protocol = &protocol;
  }

  Result<DeviceCalibration> read() {
    choice(member(top_, "kind", "the kind of device"), {calibration_.protocol->name});
    if (calibration_.protocol->absolute) {
      calibration_.counts_per_metre = 1e9;
      calibration_.encoder_step_m = number(top_, "encoder_step_m", {1e-9, 1e-3});
    } else {
      calibration_.counts_per_metre = number(top_, "counts_per_metre", {1.0, 1e9});
    }
    calibration_.direction = number(top_, "direction", {-1.0, 1.0});
    if (calibration_.direction != 1.0 && calibration_.direction != -1.0) refuse("direction", "1 or -1");
    calibration_.rest_position_m = number(top_, "rest_position_m", {-1.0, 1.0});
    if (calibration_.protocol->renders_force) read_force();
    refuse_unknown(top_);
    if (std::optional<Error> wrong = error()) return *wrong;
    return calibration_;
  }

 private:
  void refuse(const char* key, const std::string& expected) {
    const JsonNode node = optional_member(top_, key);
    if (node.value != nullptr) complain(node.pointer, found(*node.value) + ", expected " + expected);
  }

  void read_force() {
    ForceLimits& limits = calibration_.limits;
    const std::size_t before = error_count();
    calibration_.fastest_m_per_s = number(top_, "fastest_m_per_s", {0.01, 100.0});
    calibration_.force_N_per_unit =
        calibration_.protocol->absolute ? 1e-6 : number(top_, "force_N_per_unit", {1e-9, 1e3});
    calibration_.stuck_after_s = number(top_, "stuck_after_s", {0.05, 60.0});
    limits.largest_N = number(top_, "peak_N", {1e-3, 100.0});
    limits.continuous_N = number(top_, "continuous_N", {1e-3, 100.0});
    limits.thermal_time_s = number(top_, "thermal_time_s", {0.1, 1e4});
    limits.fastest_N_per_s = number(top_, "fastest_N_per_s", {1.0, 1e6});
    limits.ramp_s = number(top_, "ramp_s", {0.05, 10.0});
    limits.stale_after_s = number(top_, "stale_after_s", {0.002, 0.01});
    const bool all_read = error_count() == before;
    if (all_read && limits.continuous_N > limits.largest_N) refuse("continuous_N", "at most peak_N");
  }

  JsonNode top_;
  DeviceCalibration calibration_;
};

}  // namespace

Result<DeviceCalibration> parse_calibration(std::string_view text, const std::string& path,
                                            const DeviceProtocol& protocol) {
  const Result<nlohmann::json> document = parse_json(text, path, kCalibrationNesting, {});
  if (!document) return document.error();
  return CalibrationReader(text, path, *document, protocol).read();
}

Result<DeviceCalibration> read_calibration(const std::string& folder, const DeviceProtocol& protocol) {
  const std::string path = folder + "/" + protocol.name + ".json";
  const std::optional<std::string> text = read_whole_file(path);
  if (!text) return Error{path + ": cannot read the calibration; put the file there, see assets/devices/"};
  return parse_calibration(*text, path, protocol);
}

}  // namespace palpate
