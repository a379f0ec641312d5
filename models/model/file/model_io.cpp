#include "models/model/file/model_io.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"
#include "models/model/correction.h"
#include "models/model/file/model_description.h"

namespace palpate {
namespace {

using namespace model_file;

constexpr int kModelVersion = 1;
constexpr int kModelNesting = 16;  // limit of lists and objects inside each other; the format needs four
constexpr const char* kFitAgain = "; fit the model again";
constexpr const char* kDamaged = "; the file is damaged: copy it again or fit the model again";

// Reads untrusted text: every value is checked.
class ModelReader {
 public:
  ModelReader(const nlohmann::json& document, std::string_view text, const std::string& path)
      : fields_(text, path, kFitAgain), top_{&document, ""}, at_(top_) {}

  std::optional<Error> read(ModelData& data) {
    if (!read_format()) return fields_.error();
    describe_model(*this, data);
    // After another error some known members were not read and would seem unknown.
    if (fields_.error_count() == 0) fields_.refuse_unknown(top_);
    return fields_.error();
  }

  // The members of the object that is being read. `has`: whether there is such a member.
  bool has(const char* key, bool) { return fields_.optional_member(at_, key).value != nullptr; }
  void value(const char* key, std::string& text) { text = fields_.text(at_, key); }
  void value(const char* key, std::uint64_t& count) { count = fields_.count(at_, key); }
  void value(const char* key, double& number, NumberRange range = {}) { number = fields_.number(at_, key, range); }
  template <std::size_t n>
  void value(const char* key, std::array<double, n>& values, NumberRange range = {}) {
    fields_.fill(fields_.member(at_, key, "a list of numbers"), n, "coefficients", values.data(), range);
  }
  void value(const char* key, std::vector<std::string>& values) {
    const JsonNode list = fields_.list(at_, key, "a list of names");
    for (std::size_t i = 0; list.value != nullptr && i < list.value->size(); ++i) {
      const JsonNode name = JsonFields::entry(list, i);
      if (!name.value->is_string()) return fields_.complain(name.pointer, found(*name.value) + ", expected a text");
      values.push_back(name.value->get<std::string>());
    }
  }
  // The name of a model or a method: it is the header of a column of a CSV file.
  void name(const char* key, std::string& text) {
    value(key, text);
    const bool plain = std::ranges::none_of(
        text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"'; });
    if (plain && !text.empty() && text.size() <= kModelNameBytes) return;
    fields_.complain(std::string("/") + key, found(text) + ", expected 1 to " + std::to_string(kModelNameBytes) +
                                                 " bytes without control characters, commas and quotes");
  }
  // Exactly `size` numbers, which error messages call `words`.
  void numbers(const char* key, Eigen::VectorXd& values, Eigen::Index size, const char* words, NumberRange range = {}) {
    values = Eigen::VectorXd::Zero(size);
    fields_.fill(fields_.member(at_, key, "a list of numbers"), static_cast<std::size_t>(size), words, values.data(),
                 range);
  }

  // One column for each point.
  void points(const char* key, Eigen::MatrixXd& values, Eigen::Index dimension) {
    const std::string expected = "a list of at least one point";
    const JsonNode node = fields_.list(at_, key, expected);
    if (node.value == nullptr) return;
    if (node.value->empty()) fields_.complain(node.pointer, "found an empty list, expected " + expected);
    // The parsed list was in memory, so a matrix of as many points fits, too.
    values.resize(dimension, static_cast<Eigen::Index>(node.value->size()));
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      const JsonNode point = JsonFields::entry(node, static_cast<std::size_t>(j));
      if (!fields_.fill(point, static_cast<std::size_t>(dimension), kOnePerFeature, values.col(j).data())) return;
    }
  }

  // `facts`: those of the enumerators, in their order.
  template <typename Enum>
  bool choice(const char* key, Enum& value, const auto& facts) {
    std::vector<std::string> names;
    for (const auto& one : facts) names.emplace_back(one.name);
    const auto known = fields_.choice(fields_.member(at_, key, "a text"), names);
    if (known) value = static_cast<Enum>(*known);
    return known.has_value();
  }

  void object(const char* key, const char* expected, const auto& body) {
    inside(fields_.member(at_, key, expected), body);
  }

  // `most`: the largest number of items; 0: any number, or none. False after an error in the list.
  bool each(const char* key, std::size_t& count, std::size_t most, const auto& body) {
    const std::size_t before = fields_.error_count();
    const std::string expected = most == 0 ? "a list" : "a list of 1 to " + std::to_string(most) + " " + key;
    const JsonNode list = fields_.list(at_, key, expected);
    count = list.value != nullptr ? list.value->size() : 0;
    if (list.value != nullptr && most > 0 && (count == 0 || count > most)) {
      fields_.complain(list.pointer, found(*list.value) + ", expected " + expected);
      count = 0;
    }
    for (std::size_t i = 0; i < count; ++i) inside(JsonFields::entry(list, i), [&] { body(i); });
    return fields_.error_count() == before;
  }

  // Reads the correction from the one member that identifies its kind.
  void correction(CorrectionPtr& value, Eigen::Index dimension) {
    std::vector<std::string> present;
    for (const char* key : {"centres", "grid", "trend_alone"})
      if (at_.value->contains(key)) present.emplace_back(key);
    if (present.size() != 1) {
      const std::string given = present.empty() ? "none" : '"' + joined(present, "\" and \"") + '"';
      fields_.complain("", "found " + given + R"(, expected one of "centres", "grid", "trend_alone")");
    } else if (present[0] == "centres") {
      RbfFunction function;
      describe_rbf(*this, function, dimension);
      if (!fields_.error()) value = std::make_shared<const RbfCorrection>(std::move(function));
    } else if (present[0] == "grid") {
      VoxelGrid grid;
      read_grid(grid, static_cast<std::size_t>(dimension));
      if (!fields_.error()) value = std::make_shared<const GridCorrection>(std::move(grid));
    } else if (!fields_.boolean(at_, "trend_alone")) {
      fields_.complain("/trend_alone", "found false, expected true, or another correction");
    }
  }

 private:
  void inside(const JsonNode& node, const auto& body) {
    const JsonNode outer = std::exchange(at_, node);
    body();
    at_ = outer;
  }

  bool read_format() {
    const JsonNode format = fields_.optional_member(top_, "format");
    const bool none = format.value == nullptr;
    if (none || *format.value != "palpate-model") {
      fields_.complain(none ? "" : format.pointer,
                       (none ? "found no \"format\"" : found(*format.value)) + ", expected \"palpate-model\"",
                       "; name a file that palpate fit wrote");
      return false;
    }
    const JsonNode version = fields_.member(top_, "version", std::to_string(kModelVersion));
    if (version.value != nullptr && *version.value != kModelVersion) {
      fields_.complain(version.pointer, found(*version.value) + ", expected " + std::to_string(kModelVersion),
                       "; fit the model again with this program, or read it with the one that wrote it");
    }
    return !fields_.error();
  }

  void read_grid(VoxelGrid& grid, std::size_t dimension) {
    const JsonNode node = fields_.member(at_, "grid", "an object");
    const JsonNode axes = fields_.list(node, "nodes", "a list of axes");
    if (axes.value == nullptr) return;
    if (axes.value->size() != dimension) {
      const std::string expected = " axes, expected " + std::to_string(dimension) + ", one per feature";
      return fields_.complain(axes.pointer, found(*axes.value) + expected);
    }
    const JsonNode values = fields_.list(node, "values_N", "a list of numbers");
    if (values.value == nullptr) return;
    std::size_t product = 1;
    // Compared at every step, because the product of eight sizes may overflow.
    for (std::size_t k = 0; k < dimension && product <= values.value->size(); ++k) {
      if (!read_axis(JsonFields::entry(axes, k), grid.nodes.emplace_back())) return;
      product *= grid.nodes.back().size();
    }
    if (product != values.value->size())
      return fields_.complain(values.pointer, found(*values.value) + ", expected as many as the grid has nodes");
    grid.values_N.resize(product);
    fields_.fill(values, product, "numbers", grid.values_N.data());
  }

  // False after an error.
  bool read_axis(const JsonNode& node, std::vector<double>& axis) {
    const std::string expected = ", expected at least 2 numbers, each above the last";
    if (!node.value->is_array() || node.value->size() < 2) {
      fields_.complain(node.pointer, found(*node.value) + expected);
      return false;
    }
    axis.resize(node.value->size());
    if (!fields_.fill(node, axis.size(), "numbers", axis.data())) return false;
    const auto falls = std::adjacent_find(axis.begin(), axis.end(), std::greater_equal<>());
    if (falls == axis.end()) return true;
    const JsonNode wrong = JsonFields::entry(node, static_cast<std::size_t>(falls - axis.begin()) + 1);
    fields_.complain(wrong.pointer, found(*wrong.value) + expected);
    return false;
  }

  JsonFields fields_;
  JsonNode top_;
  JsonNode at_;
};

class ModelWriter {
 public:
  // One number a line, so that models can be compared by lines. Numbers read back as the same double.
  std::string write(ModelData& data) {
    value("format", "palpate-model");
    value("version", kModelVersion);
    describe_model(*this, data);
    return document_.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }

  bool has(const char*, bool there) { return there; }
  void value(const char* key, const auto& value, NumberRange = {}) { member(key) = value; }
  void name(const char* key, const std::string& name) { member(key) = name; }
  void numbers(const char* key, const Eigen::VectorXd& values, Eigen::Index, const char*, NumberRange = {}) {
    member(key) = Document::array_t(values.begin(), values.end());
  }
  void points(const char* key, const Eigen::MatrixXd& values, Eigen::Index) {
    Document& list = member(key) = Document::array();
    for (const auto& point : values.colwise()) list.push_back(Document::array_t(point.begin(), point.end()));
  }
  bool choice(const char* key, auto value, const auto& facts) {
    member(key) = facts[static_cast<std::size_t>(value)].name;
    return true;
  }

  void object(const char* key, const char*, const auto& body) { inside(member(key), body); }
  bool each(const char* key, std::size_t count, std::size_t, const auto& body) {
    Document& list = member(key) = Document::array();
    for (std::size_t i = 0; i < count; ++i) inside(list.emplace_back(), [&] { body(i); });
    return true;
  }

  void correction(const CorrectionPtr& value, Eigen::Index dimension) {
    if (const RbfFunction* rbf = rbf_of(value)) {
      RbfFunction function = *rbf;
      describe_rbf(*this, function, dimension);
    } else if (const VoxelGrid* grid = grid_of(value)) {
      member("grid") = {{"nodes", grid->nodes}, {"values_N", grid->values_N}};
    } else {
      if (value) std::abort();  // a kind without members: a mistake of the program
      member("trend_alone") = true;
    }
  }

 private:
  using Document = nlohmann::ordered_json;

  Document& member(const char* key) { return (*at_)[key]; }
  void inside(Document& node, const auto& body) {
    Document* outer = std::exchange(at_, &node);
    body();
    at_ = outer;
  }

  Document document_;
  Document* at_ = &document_;  // the object that is being written
};

}  // namespace

Result<ModelData> read_model_text(std::string_view text, const std::string& path) {
  const Result<nlohmann::json> document = parse_json(text, path, kModelNesting, {kFitAgain, kDamaged});
  if (!document) return document.error();
  ModelData data;
  if (const auto error = ModelReader(*document, text, path).read(data)) return *error;
  if (const Status forces = check_forces(data); !forces) return Error{path + ": " + forces.error().message + kFitAgain};
  return data;
}

Result<std::string> write_model_text(const ModelData& data) {
  if (const Status status = check_forces(data); !status) return status.error();
  ModelData written = data;
  const auto without_folders = [](std::string& name) { name.erase(0, name.find_last_of("/\\") + 1); };
  for (std::string& name : written.provenance.recordings) without_folders(name);
  for (RecordingOffset& surface : written.provenance.offsets) without_folders(surface.name);
  std::string text = ModelWriter().write(written);
  // What cannot be read is not written.
  if (const auto back = read_model_text(text, "its text"); !back) return back.error();
  return text;
}

Status save_model(const std::string& path, const ModelData& data, bool overwrite) {
  const Result<std::string> text = write_model_text(data);
  if (!text) return Error{"cannot write " + path + ": " + text.error().message};
  return write_file_atomically(path, *text, overwrite);
}

Result<std::shared_ptr<const FittedModel>> load_model(const std::string& path) try {
  std::error_code unknown;
  if (const auto bytes = std::filesystem::file_size(path, unknown); !unknown && bytes > kMaximumModelFileBytes) {
    return Error{path + ": found " + std::to_string(bytes) + " bytes, expected at most " +
                 std::to_string(kMaximumModelFileBytes) + "; name a file that palpate fit wrote"};
  }
  const Result<std::string> text =
      read_plain_file(path, "a model file", ", or make one with palpate fit", kMaximumModelFileBytes);
  if (!text) return text.error();
  Result<ModelData> data = read_model_text(*text, path);
  if (!data) {
    // One line, because the file can only be made again.
    const std::string& all = data.error().message;
    const auto lines = std::ranges::count(all, '\n');
    return Error{all.substr(0, all.find('\n')) +
                 (lines > 0 ? " (and " + std::to_string(lines) + " more errors)" : std::string())};
  }
  return std::make_shared<const FittedModel>(std::move(*data));
} catch (const std::bad_alloc&) {
  return Error{path + ": found more data than memory holds, expected a model file; name a file that palpate fit wrote"};
}

}  // namespace palpate
