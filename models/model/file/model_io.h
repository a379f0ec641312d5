// Model files: ModelData to JSON text and back. One object: "format": "palpate-model", "version": 1, then the members
// of model_description.h in its order; their schema is assets/formats/model.schema.json. Unknown members are errors.
// Every number has a line, and reads back as the same double, so the forces of a model that was read are bit-identical.
// The same fit gives the same bytes: no time is stored. Thread guarantee: slow side only (allocates, does I/O).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"

namespace palpate {

// Limit of the length of a model's name, bytes: it becomes part of column and file names.
inline constexpr std::size_t kModelNameBytes = 100;
// Larger files are rejected unread. A grid of ten million nodes, the largest that is saved, needs about half of it.
inline constexpr std::uintmax_t kMaximumModelFileBytes = std::uintmax_t{512} << 20;

// The text of a model file, with recording names without their folders. Errors: those of read_model_text for this text.
Result<std::string> write_model_text(const ModelData& data);
// Reads the text of a model file. `path` is the file in messages:
//   path:line:column: field[index]: found X, expected Y; advice
// Errors: text that is not JSON, a number beyond the range of a double, lists nested too deep, another format or
// version, a field that is missing, unknown, or of the wrong type, size or sign. All are reported, one a line.
Result<ModelData> read_model_text(std::string_view text, const std::string& path);
// Writes a model file atomically. Errors: data that the reader would refuse; the file exists and `overwrite` is false;
// input/output errors.
Status save_model(const std::string& path, const ModelData& data, bool overwrite);
// Reads a model file. Errors: no such file, not a regular file, larger than kMaximumModelFileBytes, or those of
// read_model_text.
Result<std::shared_ptr<const FittedModel>> load_model(const std::string& path);

}  // namespace palpate
