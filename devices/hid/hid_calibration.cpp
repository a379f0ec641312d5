#include "devices/hid/hid_calibration.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "devices/hid/hid_drivers.h"
#include "engine/base/json_message.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

class CalibrationReader {
 public:
  CalibrationReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Result<HidCalibration> read() {
    Result<Json> document = parse_json_document<Json>(text_, path_);
    if (!document) return document.error();
    document_ = std::move(*document);
    if (!document_.is_object())
      return Error{position_prefix(path_, {}) + found(document_) + ", expected an object"};
    read_kind();
    calibration_.counts_per_metre = number("counts_per_metre", {1.0, 1e9});
    calibration_.direction = number("direction", {-1.0, 1.0});
    if (!error_ && calibration_.direction != 1.0 && calibration_.direction != -1.0) {
      complain("direction", found(document_["direction"]) + ", expected 1 or -1");
    }
    calibration_.rest_position_m = number("rest_position_m", {-1.0, 1.0});
    if (!error_ && calibration_.driver->renders_force) read_force();
    refuse_others();
    if (error_) return *error_;
    return calibration_;
  }

 private:
  void complain(const std::string& key, const std::string& words) {
    if (!error_)
      error_ = Error{position_prefix(path_, position_of_value(text_, "/" + key)) + key + ": " + words};
  }

  void read_kind() {
    known_.push_back("kind");
    std::string expected;
    for (const HidDriver* driver : kHidDrivers) {
      expected += expected.empty() ? "" : driver == kHidDrivers.back() ? " or " : ", ";
      expected += '"' + std::string(driver->name) + '"';
      if (document_.contains("kind") && document_["kind"] == driver->name) calibration_.driver = driver;
    }
    if (calibration_.driver != nullptr) return;
    complain("kind", (document_.contains("kind") ? found(document_["kind"]) : "missing") + ", expected " + expected);
  }

  double number(const char* key, const NumberRange& range) {
    known_.emplace_back(key);
    const std::string expected = ", expected " + range.words();
    if (!document_.contains(key)) {
      complain(key, "missing" + expected);
      return range.low;
    }
    const Json& value = document_[key];
    if (value.is_number() && range.holds(value.get<double>())) return value.get<double>();
    complain(key, found(value) + expected);
    return range.low;
  }

  void read_force() {
    ForceLimits& limits = calibration_.limits;
    calibration_.fastest_m_per_s = number("fastest_m_per_s", {0.01, 100.0});
    calibration_.force_N_per_unit = number("force_N_per_unit", {1e-9, 1e3});
    calibration_.stuck_after_s = number("stuck_after_s", {0.05, 60.0});
    limits.largest_N = number("peak_N", {1e-3, 100.0});
    limits.continuous_N = number("continuous_N", {1e-3, 100.0});
    limits.thermal_time_s = number("thermal_time_s", {0.1, 1e4});
    limits.fastest_N_per_s = number("fastest_N_per_s", {1.0, 1e6});
    limits.ramp_s = number("ramp_s", {0.05, 10.0});
    limits.stale_after_s = number("stale_after_s", {0.002, 0.01});
    if (!error_ && limits.continuous_N > limits.largest_N) {
      complain("continuous_N", found(document_["continuous_N"]) + ", expected at most peak_N");
    }
  }

  void refuse_others() {
    for (const auto& entry : document_.items()) {
      if (std::find(known_.begin(), known_.end(), entry.key()) != known_.end()) continue;
      complain(entry.key(), "unknown; expected " + list_of_known());
    }
  }

  std::string list_of_known() const {
    std::string list;
    for (const std::string& key : known_) list += (list.empty() ? "" : ", ") + key;
    return list;
  }

  std::string_view text_;
  std::string path_;
  Json document_;
  HidCalibration calibration_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace

Result<HidCalibration> parse_hid_calibration(std::string_view text, const std::string& path) {
  try {
    return CalibrationReader(text, path).read();
  } catch (const std::exception& error) {
    return Error{path + ": " + error.what()};
  }
}

Result<HidCalibration> read_hid_calibration(const std::string& folder, const HidDriver& driver) {
  const std::string path = folder + "/" + driver.name + ".json";
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path + ": cannot read the calibration; put the file there, see assets/devices/"};
  std::ostringstream text;
  text << file.rdbuf();
  Result<HidCalibration> calibration = parse_hid_calibration(text.str(), path);
  if (calibration && calibration->driver != &driver) {
    return Error{path + ": found the calibration of \"" + calibration->driver->name +
                 "\", expected \"" + std::string(driver.name) + "\", as the file's name says"};
  }
  return calibration;
}

}  // namespace palpate
