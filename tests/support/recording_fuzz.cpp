#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "tests/support/fuzz_checks.h"

namespace palpate::test {
namespace {

Result<Recording> parse(const std::string& text, std::size_t most_rows) {
  std::istringstream stream(text);
  return read_recording(stream, "rec.csv", most_rows);
}

void check_rows(const std::vector<RecordingRow>& rows) {
  require(rows.size() >= kRecordingMinimumRows, "too few rows accepted");
  double last_time_s = -HUGE_VAL;
  for (const RecordingRow& row : rows) {
    require(std::isfinite(row.time_s) && row.time_s > last_time_s, "time not increasing");
    require(std::abs(row.position_m) <= kMaximumPosition_m, "position out of range");
    require(std::abs(row.force_N) <= kMaximumForce_N, "force out of range");
    require(std::isfinite(row.velocity_m_per_s), "velocity not finite");
    require(std::isfinite(row.acceleration_m_per_s2), "acceleration not finite");
    last_time_s = row.time_s;
  }
}

void check_message(const std::string& message) {
  require(message.starts_with("rec.csv:"), "message without a place");
  require(message.find("expected") != std::string::npos, "message without what was expected");
  require(message.size() < 400, "message too long");
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  require(std::none_of(message.begin(), message.end(), is_control), "message not printable");
}

bool same_row(const RecordingRow& a, const RecordingRow& b) { return column_values(a) == column_values(b); }

}  // namespace

std::size_t check_recording(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const Result<Recording> whole = parse(text, kAllRows);
  if (!whole) {
    check_message(whole.error().message);
    const Result<Recording> first = parse(text, 1);
    require(first.ok() || first.error().message == whole.error().message, "the message depends on the number of rows");
    return 0;
  }
  check_rows(whole->rows);
  const std::size_t half = whole->rows.size() / 2;
  const Result<Recording> part = parse(text, half);
  require(part.ok() && part->rows.size() == half &&
              std::equal(part->rows.begin(), part->rows.end(), whole->rows.begin(), same_row),
          "the rows depend on the number of rows in a call");
  return whole->rows.size();
}

}  // namespace palpate::test
