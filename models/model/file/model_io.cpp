#include "models/model/file/model_io.h"

#include <filesystem>
#include <new>
#include <system_error>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/whole_file.h"
#include "models/model/file/model_json.h"

namespace palpate {
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
  if (!data) return data.error();
  return std::make_shared<const FittedModel>(std::move(*data));
} catch (const std::bad_alloc&) {
  return Error{path + ": found more data than memory holds, expected a model file; name a file that palpate fit wrote"};
}

}  // namespace palpate
