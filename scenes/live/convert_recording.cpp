#include "scenes/live/convert_recording.h"

#include <filesystem>

#include "engine/import/import_table.h"
#include "engine/recording/recording_reader.h"
#include "scenes/scene/folders.h"

namespace palpate {
bool may_be_recording(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return !ending.empty() && ending != ".json";
}

Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder) {
  const auto recording = read_recording(path);
  if (recording) return ConvertedRecording{path, {}};
  // A file with the header of a recording is no table of another program.
  std::error_code missing;
  if (RecordingReader::open(path) || !std::filesystem::exists(path, missing)) return recording.error();
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
