// Reading a study file: header, then rows, each checked in every field.
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <sstream>
#include <utility>

#include "engine/base/whole_file.h"
#include "engine/json/json_position.h"
#include "scenes/study/study_file.h"

namespace palpate {
namespace {

constexpr std::size_t kColumnCount = 12;
constexpr std::size_t kMostColumns = kColumnCount + 2;  // with strokes

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
    const Result<ProcedureKind> procedure = find_procedure(next_line("# procedure "));
    if (!procedure) return refuse("\"# procedure \" and constant or discriminate");
    data_.header.procedure = *procedure;
    if (!read_timing(next_line("# timing_ms "))) {
      return refuse("\"# timing_ms lead_in 400 ramp 100 hold 900 pause 500\" or such");
    }
    const bool strokes = *procedure == ProcedureKind::discriminate;
    if (strokes) {
      if (const Status read = read_strokes(); !read) return read.error();
      columns_ = kMostColumns;
    }
    data_.consent = next_line("# consent accepted, ");
    if (failed_) return refuse("\"# consent accepted, \" and which text");
    const std::string columns = study_columns(*procedure);
    if (next_line(columns) != "") return refuse("the columns " + columns);
    data_.whole_bytes = next_;
    while (text_.find('\n', next_) != std::string_view::npos) {
      if (const Status row = read_row(); !row) return row.error();
      data_.whole_bytes = next_;
    }
    return data_;
  }

 private:
  // What follows `start` in the next line, which must begin so.
  std::string next_line(std::string_view start) {
    line_start_ = next_;
    const std::size_t end = text_.find('\n', next_);
    const std::string_view line = text_.substr(next_, end == std::string_view::npos ? end : end - next_);
    failed_ = end == std::string_view::npos || line.substr(0, start.size()) != start;
    if (failed_) return "?";
    next_ = end + 1;
    return std::string(line.substr(start.size()));
  }

  Error refuse(const std::string& expected) const {
    std::string_view line = text_.substr(line_start_, text_.find('\n', line_start_) - line_start_);
    return refuse_at(line_start_, line, expected);
  }

  Error refuse_at(std::size_t offset, std::string_view what, const std::string& expected) const {
    const std::string shown = what.size() > 60 ? std::string(what.substr(0, 57)) + "..." : std::string(what);
    return Error{position_prefix(path_, position_of_offset(text_, offset)) + "found \"" + shown + "\", expected " +
                 expected};
  }

  // "name number name number ..." in this order.
  template <typename T>
  static bool read_named(std::istream& words, std::initializer_list<std::pair<const char*, T*>> parts) {
    for (const auto& part : parts) {
      std::string name, number;
      words >> name >> number;
      if (name != part.first || !read_number(number, *part.second)) return false;
    }
    return true;
  }

  bool read_timing(const std::string& text) {
    StudyTiming& timing = data_.header.timing;
    std::istringstream words(text);
    return read_named<std::uint32_t>(words, {{"lead_in", &timing.lead_in},
                                             {"ramp", &timing.ramp},
                                             {"hold", &timing.hold},
                                             {"pause", &timing.pause}}) &&
           check_study_timing(timing).ok();
  }

  Status read_strokes() {
    StrokePair strokes;
    strokes.reference = next_line("# reference ");
    if (failed_) return refuse("\"# reference \" and whose force");
    strokes.comparison = next_line("# comparison ");
    if (failed_) return refuse("\"# comparison \" and whose force");
    std::istringstream stroke(next_line("# stroke "));
    std::string of;
    const bool placed = read_named<double>(stroke, {{"from_s", &strokes.from_s}, {"to_s", &strokes.to_s}}) &&
                        stroke >> of && of == "of" && stroke.get() == ' ';
    if (!placed || !std::getline(stroke, strokes.recording))
      return refuse("\"# stroke from_s 1.5 to_s 3 of \" and a recording");
    std::istringstream forces(next_line("# forces "));
    if (!read_named<double>(forces, {{"reference_mean_N", &strokes.reference_mean_N},
                                     {"comparison_mean_N", &strokes.comparison_mean_N}}) ||
        !read_named<std::uint32_t>(forces, {{"checksum", &strokes.checksum}})) {
      return refuse("\"# forces reference_mean_N 1.2 comparison_mean_N 1.3 checksum 4711\" or such");
    }
    std::istringstream predicted(next_line("# predicted "));
    if (!read_named<double>(predicted, {{"mean_over_jnd", &strokes.mean_over_jnd},
                                        {"max_over_jnd", &strokes.max_over_jnd},
                                        {"jnd_offset_N", &strokes.jnd.offset_N},
                                        {"jnd_weber_fraction", &strokes.jnd.weber_fraction}})) {
      return refuse(
          "\"# predicted mean_over_jnd 0.2 max_over_jnd 0.9 jnd_offset_N 0.065 jnd_weber_fraction 0.0633\" or such");
    }
    data_.header.strokes = std::make_shared<const StrokePair>(std::move(strokes));
    return {};
  }

  Status read_row() {
    const std::size_t end = text_.find('\n', next_);
    std::array<std::string_view, kMostColumns> fields;
    std::array<std::size_t, kMostColumns> offsets{};
    std::size_t at = next_;
    for (std::size_t i = 0; i < columns_; ++i) {
      const std::size_t comma = text_.find(',', at);
      const std::size_t stop = comma == std::string_view::npos || comma > end ? end : comma;
      if ((stop == end) != (i + 1 == columns_)) {
        return refuse_at(next_, text_.substr(next_, end - next_),
                         columns_ == kMostColumns ? "a row of fourteen fields" : "a row of twelve fields");
      }
      fields[i] = text_.substr(at, stop - at);
      offsets[i] = at;
      at = stop + 1;
    }
    next_ = end + 1;
    return take_fields(fields, offsets);
  }

  Status take_fields(const std::array<std::string_view, kMostColumns>& fields,
                     const std::array<std::size_t, kMostColumns>& offsets) {
    StudyRecord record;
    std::size_t wrong = kMostColumns;
    std::string expected;
    const auto check = [&](std::size_t field, bool good, const char* words) {
      if (good || wrong < kMostColumns) return;
      wrong = field;
      expected = words;
    };
    const auto flag = [&](std::size_t field, std::string_view no, std::string_view yes, const char* words) {
      check(field, fields[field] == no || fields[field] == yes, words);
      return fields[field] == yes;
    };
    const auto force = [&](std::size_t field, double least_N) {
      double value = 0.0;
      const bool good = read_number(fields[field], value) && std::isfinite(value) && value >= least_N && value <= 10.0;
      check(field, good, least_N > 0.0 ? "a force above 0 and up to 10 N" : "a force from 0 to 10 N");
      return value;
    };
    record.training = flag(0, "study", "training", "training or study");
    check(1, read_number(fields[1], record.number) && record.number > 0, "a whole number above 0");
    record.trial = {force(2, 1e-3), force(3, 1e-3), false};
    record.trial.comparison_first = flag(4, "0", "1", "0 or 1");
    record.first_rendered_N = force(5, 0.0);
    record.second_rendered_N = force(6, 0.0);
    record.limited = flag(7, "0", "1", "0 or 1");
    record.answered_second = flag(8, "first", "second", "first or second");
    check(9, read_number(fields[9], record.response_ms), "a whole number of ms");
    if (data_.header.strokes != nullptr) {
      record.reminder_rendered_N = force(10, 0.0);
      record.worst_N = force(11, 0.0);
    }
    record.device = fields[columns_ - 2];
    check(columns_ - 2, !record.device.empty(), "the name of a device");
    record.rendered = flag(columns_ - 1, "false", "true", "true or false");
    if (wrong < kMostColumns) return refuse_at(offsets[wrong], fields[wrong], expected);
    data_.records.push_back(record);
    return {};
  }

  std::string_view text_;
  const std::string& path_;
  StudyData data_;
  std::size_t columns_ = kColumnCount;
  std::size_t next_ = 0;
  std::size_t line_start_ = 0;
  bool failed_ = false;
};

}  // namespace

Result<StudyData> parse_study(std::string_view text, const std::string& path) { return StudyReader(text, path).read(); }

Result<StudyData> read_study(const std::string& path) {
  const std::optional<std::string> text = read_whole_file(path);
  if (!text) return Error{"cannot read the study file " + path + "; does it exist?"};
  return parse_study(*text, path);
}

}  // namespace palpate
