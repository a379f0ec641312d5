// A study file is text: a header, then rows. Every field is checked.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/base/whole_file.h"
#include "engine/json/json_position.h"
#include "scenes/study/study_file.h"

namespace palpate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JndLine, offset_N, weber_fraction)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrokePair, reference, comparison, recording, from_s, to_s, checksum, jnd,
                                   mean_over_jnd, max_over_jnd, reference_mean_N, comparison_mean_N)

namespace {

// The header line with the timing of a presentation.
std::string timing_line() {
  const auto part = [](const char* name, std::uint32_t ticks) { return std::string(name) + std::to_string(ticks); };
  return "# timing_ms" + part(" lead_in ", kLeadIn_ticks) + part(" ramp ", kRamp_ticks) + part(" hold ", kHold_ticks) +
         part(" pause ", kPause_ticks);
}

template <typename T>
bool read_number(std::string_view text, T& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

class StudyReader {
 public:
  StudyReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Result<StudyData> read() {
    if (next_line("# palpate-study 1") != "") return refuse("the first line of a study file, \"# palpate-study 1\"");
    data_.header.subject = next_line("# subject ");
    if (!check_subject_code(data_.header.subject)) return refuse("\"# subject \" and a code such as S01");
    const std::string procedure = next_line("# procedure ");
    if (procedure != "constant" && procedure != "discriminate")
      return refuse("\"# procedure \" and constant or discriminate");
    if (next_line(timing_line()) != "") return refuse('"' + timing_line() + '"');
    if (procedure == "discriminate" && !read_strokes(next_line("# strokes ")))
      return refuse("\"# strokes \" and which, as JSON");
    data_.consent = next_line("# consent accepted, ");
    if (failed_) return refuse("\"# consent accepted, \" and which text");
    const std::string columns = study_columns(data_.header);
    if (next_line(columns) != "") return refuse("the columns " + columns);
    data_.whole_bytes = next_;
    while (text_.find('\n', next_) != std::string_view::npos) {
      read_row();
      if (wrong_) return *wrong_;
      data_.whole_bytes = next_;
    }
    return data_;
  }

 private:
  // Reads the next line, which must begin with `start`, and returns the rest of it.
  std::string next_line(std::string_view start) {
    const std::size_t end = text_.find('\n', next_);
    line_ = text_.substr(next_, end == std::string_view::npos ? end : end - next_);
    failed_ = end == std::string_view::npos || line_.substr(0, start.size()) != start;
    if (failed_) return "?";
    next_ = end + 1;
    return std::string(line_.substr(start.size()));
  }

  Error refuse(const std::string& expected) const { return refuse_part(line_, expected); }

  // `part`: a view into the text of the file.
  Error refuse_part(std::string_view part, const std::string& expected) const {
    const std::string shown = part.size() > 60 ? std::string(part.substr(0, 57)) + "..." : std::string(part);
    const auto offset = static_cast<std::size_t>(part.data() - text_.data());
    return Error{position_prefix(path_, position_of_offset(text_, offset)) + "found \"" + shown + "\", expected " +
                 expected};
  }

  bool read_strokes(const std::string& text) {
    try {
      data_.header.strokes = std::make_shared<const StrokePair>(nlohmann::json::parse(text).get<StrokePair>());
      return true;
    } catch (const nlohmann::json::exception&) {
      return false;
    }
  }

  // Returns the next field of the row. The first wrong field is reported.
  std::string_view field() {
    const std::size_t comma = rest_.find(',');
    const std::string_view one = rest_.substr(0, comma);
    rest_ = comma == std::string_view::npos ? std::string_view() : rest_.substr(comma + 1);
    return one;
  }

  void check(std::string_view one, bool good, const char* expected) {
    if (!good && !wrong_) wrong_ = refuse_part(one, expected);
  }

  bool flag(std::string_view no, std::string_view yes, const char* expected) {
    const std::string_view one = field();
    check(one, one == no || one == yes, expected);
    return one == yes;
  }

  template <typename T>
  void read_whole(T& value, T least, const char* expected) {
    const std::string_view one = field();
    check(one, read_number(one, value) && value >= least, expected);
  }

  double force(double least_N = 0.0) {
    const std::string_view one = field();
    double value_N = 0.0;
    const bool good = read_number(one, value_N) && std::isfinite(value_N) && value_N >= least_N && value_N <= 10.0;
    check(one, good, least_N > 0.0 ? "a force above 0 and up to 10 N" : "a force from 0 to 10 N");
    return value_N;
  }

  void read_row() {
    const bool strokes = data_.header.strokes != nullptr;
    next_line("");
    if (std::count(line_.begin(), line_.end(), ',') != (strokes ? 13 : 11)) {
      wrong_ = refuse(strokes ? "a row of fourteen fields" : "a row of twelve fields");
      return;
    }
    rest_ = line_;
    StudyRecord record;
    record.training = flag("study", "training", "training or study");
    read_whole<std::size_t>(record.number, 1, "a whole number above 0");
    record.trial.reference_N = force(1e-3);
    record.trial.comparison_N = force(1e-3);
    record.trial.comparison_first = flag("0", "1", "0 or 1");
    record.first_rendered_N = force();
    record.second_rendered_N = force();
    record.limited = flag("0", "1", "0 or 1");
    record.answered_second = flag("first", "second", "first or second");
    read_whole<std::uint32_t>(record.response_ms, 0, "a whole number of ms");
    if (strokes) {
      record.reminder_rendered_N = force();
      record.worst_N = force();
    }
    const std::string_view device = field();
    check(device, !device.empty(), "the name of a device");
    record.device = device;
    record.rendered = flag("false", "true", "true or false");
    data_.records.push_back(std::move(record));
  }

  std::string_view text_;
  const std::string& path_;
  StudyData data_;
  std::size_t next_ = 0;
  std::string_view line_, rest_;  // `rest_`: the part of the line that is not yet read
  bool failed_ = false;
  std::optional<Error> wrong_;
};

}  // namespace

std::string study_header_text(const StudyHeader& header) {
  std::string text = "# palpate-study 1\n# subject " + header.subject + "\n# procedure " + header.procedure() + "\n" +
                     timing_line() + "\n";
  if (header.strokes != nullptr) text += "# strokes " + nlohmann::json(*header.strokes).dump() + "\n";
  return text;
}

std::string study_columns(const StudyHeader& header) {
  std::string columns =
      "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,"
      "response_ms";
  if (header.strokes != nullptr) columns += ",reminder_rendered_N,worst_N";
  return columns + ",device,rendered";
}

std::string study_row(const StudyRecord& record, const StudyHeader& header) {
  std::string row = record.training ? "training," : "study,";
  row += std::to_string(record.number) + "," + shortest(record.trial.reference_N) + "," +
         shortest(record.trial.comparison_N) + (record.trial.comparison_first ? ",1," : ",0,") +
         shortest(record.first_rendered_N) + "," + shortest(record.second_rendered_N) +
         (record.limited ? ",1," : ",0,") + (record.answered_second ? "second," : "first,") +
         std::to_string(record.response_ms);
  if (header.strokes != nullptr) {
    row += ',';
    row += shortest(record.reminder_rendered_N) + "," + shortest(record.worst_N);
  }
  return row + "," + record.device + (record.rendered ? ",true\n" : ",false\n");
}

Result<StudyData> parse_study(std::string_view text, const std::string& path) { return StudyReader(text, path).read(); }

Result<StudyData> read_study(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "a study file");
  if (!text) return text.error();
  return parse_study(*text, path);
}

}  // namespace palpate
