#include "scenes/live/convert_recording.h"

#include <filesystem>
#include <string_view>

#include "engine/base/csv_scanner.h"
#include "engine/base/whole_file.h"
#include "engine/import/import_table.h"
#include "engine/recording/recording.h"
#include "scenes/scene/folders.h"

namespace palpate {
namespace {

// Whether the file has the header of a recording, so that its errors are reported as those of a recording.
bool has_our_columns(const std::string& path) {
  auto file = open_plain_file(path, "a recording");
  if (!file) return false;
  LineScanner lines(std::move(*file), path);
  CsvLine line;
  while (lines.next(line)) {
    if (line.text.empty() || line.text.front() != '#') break;
  }
  const auto has = [&](const char* name) { return line.text.find(name) != std::string_view::npos; };
  return has("time_s") && has("position_m") && has("force_N");
}

}  // namespace

bool may_be_recording(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return !ending.empty() && ending != ".json";
}

Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder) {
  const auto recording = read_recording(path);
  if (recording) return ConvertedRecording{path, {}};
  std::error_code missing;
  if (has_our_columns(path) || !std::filesystem::exists(path, missing)) return recording.error();
  const ImportRequest request;
  const auto table = import_table(path, request);
  if (!table) return table.error();
  ConvertedRecording converted;
  converted.path = folder + "/" + std::filesystem::path(path).stem().string() + local_time_text("-%Y%m%d-%H%M%S.csv");
  if (Status status = write_recording(converted.path, table->recording, import_origin(path, request, *table), true);
      !status)
    return status.error();
  converted.words.push_back(table->layout.words(table->encoding));
  for (std::size_t role = 0; role < kRoles; ++role)
    converted.words.push_back(std::string(kRoleNames[role]) + ": " + column_words(table->columns[role]));
  converted.words.insert(converted.words.end(), table->notes.begin(), table->notes.end());
  return converted;
}

}  // namespace palpate
