#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "engine/recording/recording_reader.h"
#include "tests/support/fuzz_checks.h"

namespace palpate::test {
namespace {

struct Outcome {
  std::vector<RecordingRow> rows;
  std::string message;  // empty: accepted
};

Outcome parse(const std::string& text, std::size_t batch_rows) {
  Outcome outcome;
  auto parser = RecordingReader::from(std::make_unique<std::istringstream>(text), "rec.csv");
  if (!parser) return {{}, parser.error().message};
  for (;;) {
    const std::size_t before = outcome.rows.size();
    const auto count = parser->read(outcome.rows, batch_rows);
    if (!count) {
      outcome.message = count.error().message;
      require(!parser->read(outcome.rows, batch_rows).ok(), "an error was forgotten");
      return outcome;
    }
    if (*count == 0) return outcome;
    require(*count <= batch_rows, "more rows than asked for");
    require(outcome.rows.size() == before + *count, "another number of rows than returned");
  }
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
  const Outcome whole = parse(text, 4096);
  const Outcome single = parse(text, 1);
  require(whole.message == single.message, "the verdict depends on the number of rows in a call");
  if (!whole.message.empty()) {
    check_message(whole.message);
    return whole.rows.size();
  }
  require(whole.rows.size() == single.rows.size() &&
              std::equal(whole.rows.begin(), whole.rows.end(), single.rows.begin(), same_row),
          "the rows depend on the number of rows in a call");
  check_rows(whole.rows);
  return whole.rows.size();
}

}  // namespace palpate::test
