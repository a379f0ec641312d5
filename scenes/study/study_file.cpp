#include "scenes/study/study_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/random_stream.h"
#include "engine/base/text.h"

namespace palpate {

double interval_share(std::uint32_t tick) noexcept {
  const std::uint32_t from_edge = std::min(tick, kInterval_ticks - 1 - tick);
  if (from_edge >= kRamp_ticks) return 1.0;
  return 0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(from_edge) / kRamp_ticks);
}

double Stimulus::force_N(std::uint32_t tick) const noexcept {
  const double now_N = size * interval_share(tick);
  if (stroke_N == nullptr) return now_N;
  return tick < stroke_N->size() ? now_N * (*stroke_N)[tick] : 0.0;
}

std::uint64_t StudyPresenter::present(const Stimuli& stimuli) noexcept {
  orders_.write({++ordered_, stimuli});
  return ordered_;
}

void StudyPresenter::record(double rendered_N) noexcept {
  if (state_.interval < 0 || !std::isfinite(rendered_N)) return;
  state_.worst_N = std::max(state_.worst_N, std::abs(rendered_N - commanded_N_));
  if (is_held(in_interval_)) state_.rendered_N[static_cast<std::size_t>(state_.interval)] += rendered_N / kHold_ticks;
}

double StudyPresenter::next_command_N() noexcept {
  state_.interval = -1;
  if (stopped_.load(std::memory_order_acquire) || state_.presentation == 0 || state_.finished_at > 0) return 0.0;
  const std::uint32_t now = played_++;
  if (now < kLeadIn_ticks) return 0.0;
  const Stimuli& stimuli = orders_.value().stimuli;
  const std::uint32_t since = now - kLeadIn_ticks, period = kInterval_ticks + kPause_ticks;
  const std::uint32_t interval = since / period + (has_reminder(stimuli) ? 0 : 1);
  in_interval_ = since % period;
  if (in_interval_ < kInterval_ticks) {
    state_.interval = static_cast<int>(interval);
    return stimuli[interval].force_N(in_interval_);
  }
  if (interval == 2) state_.finished_at = state_.tick;
  return 0.0;
}

double StudyPresenter::tick(double rendered_N) noexcept {
  record(rendered_N);
  if (orders_.refresh()) {
    state_ = {.presentation = orders_.value().presentation, .tick = state_.tick};
    played_ = 0;
  }
  commanded_N_ = next_command_N();
  const double force_N = limiter_.limit(commanded_N_, kHapticTick_s);
  const auto changed = force_limit::kClamped | force_limit::kSlewed | force_limit::kNotFinite;
  if ((limiter_.flags() & changed) != 0) state_.limited = true;
  ++state_.tick;
  states_.write(state_);
  return force_N;
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JndLine, offset_N, weber_fraction)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StrokePair, reference, comparison, recording, from_s, checksum, jnd, mean_over_jnd,
                                   max_over_jnd, reference_mean_N, comparison_mean_N)

namespace {

// Fixed, so that the plan depends on the subject code only.
constexpr std::uint64_t kStudySeed = 0x70a1fa7e5eed0001u;
constexpr double kEasyShare = 0.5;

// Random numbers of this subject; each use has its own `stream`.
RandomStream subject_random(const std::string& code, std::uint64_t stream) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char letter : code) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  return {hash ^ kStudySeed, stream};
}

template <typename T>
void shuffle(std::vector<T>& values, RandomStream& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.index(i)]);
}

// The trial `count` times (even), the comparison first in half of them, shuffled.
std::vector<StudyTrial> balanced(StudyTrial trial, std::size_t count, RandomStream& random) {
  std::vector<StudyTrial> trials(count, trial);
  for (std::size_t i = 0; i < count / 2; ++i) trials[i].comparison_first = true;
  shuffle(trials, random);
  return trials;
}

using Trials = std::vector<StudyTrial>;

void append(Trials& trials, const Trials& more) { trials.insert(trials.end(), more.begin(), more.end()); }

// The training, with each reference against 60 % and 140 % of it, then the study.
Trials constant_trials(const std::string& code) {
  RandomStream random = subject_random(code, 2);
  Trials all = balanced({0.0, 0.0, false, true}, 2 * kReferenceForces_N.size(), random);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int percent = i % 2 == 0 ? kComparisonPercent.front() : kComparisonPercent.back();
    all[i].reference_N = kReferenceForces_N[i / 2];
    all[i].comparison_N = percent_of(kReferenceForces_N[i / 2], percent);
  }
  shuffle(all, random);
  random = subject_random(code, 1);
  std::vector<Trials> rounds(kRepetitions);
  for (const double reference_N : kReferenceForces_N) {
    for (const int percent : kComparisonPercent) {
      const Trials trials = balanced({reference_N, percent_of(reference_N, percent)}, kRepetitions, random);
      for (std::size_t i = 0; i < rounds.size(); ++i) rounds[i].push_back(trials[i]);
    }
  }
  for (Trials& round : rounds) {
    shuffle(round, random);
    append(all, round);
  }
  return all;
}

Trials stroke_trials(const std::string& code, const StrokePair& strokes) {
  const double reference_N = strokes.reference_mean_N;
  RandomStream random = subject_random(code, 5);
  Trials all = balanced({reference_N, percent_of(reference_N, 100.0 * kEasyShare), false, true}, 4, random);
  random = subject_random(code, 4);
  for (std::size_t i = 0; i < kDiscriminationTrials; i += kDiscriminationBlock)
    append(all, balanced({reference_N, strokes.comparison_mean_N}, kDiscriminationBlock, random));
  return all;
}

constexpr double kLargestRendered_N = 10.0;  // more than any device renders in a study

std::string column_names(bool strokes) {
  return std::string(
             "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,answer,"
             "response_ms,") +
         (strokes ? "reminder_rendered_N,worst_N," : "") + "device,rendered";
}

// The first five columns of a row, which the plan determines.
std::string planned_columns(const StudyTrial& trial) {
  return std::string(trial.training ? "training," : "study,") + std::to_string(trial.number) + "," +
         shortest(trial.reference_N) + "," + shortest(trial.comparison_N) + (trial.comparison_first ? ",1," : ",0,");
}

std::string_view whole_lines(std::string_view text) { return text.substr(0, text.rfind('\n') + 1); }

// The rest of the line that begins with `key`; empty without one.
std::string value_of(std::string_view text, const std::string& key) {
  const std::size_t at = text.find("\n" + key);
  if (at == std::string_view::npos) return "";
  text.remove_prefix(at + 1 + key.size());
  return std::string(text.substr(0, text.find('\n')));
}

// The answer of a row. A field that has no valid value is ignored.
StudyRecord record_of(const StudyTrial& trial, std::string_view row, bool strokes) {
  std::vector<std::string> fields;
  std::istringstream rest{std::string(row)};
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  fields.resize(14);
  const auto force_N = [&](std::size_t i) {
    double value_N = 0.0;
    std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), value_N);
    return value_N >= 0.0 && value_N <= kLargestRendered_N ? value_N : 0.0;
  };
  StudyRecord record{trial, force_N(5), force_N(6), fields[7] == "1", fields[8] == "second"};
  std::from_chars(fields[9].data(), fields[9].data() + fields[9].size(), record.response_ms);
  if (strokes) {
    record.reminder_rendered_N = force_N(10);
    record.worst_N = force_N(11);
  }
  const std::size_t device = strokes ? 12 : 10;
  if (!fields[device].empty()) record.device = fields[device];
  record.rendered = fields[device + 1] == "true";
  return record;
}

// The first field where `found` is not `expected`, with the rest of its line.
Error difference(std::string_view found, std::string_view expected, const std::string& path) {
  const auto at = static_cast<std::size_t>(
      std::mismatch(found.begin(), found.end(), expected.begin(), expected.end()).first - found.begin());
  const std::size_t field = found.substr(0, at).find_last_of(",\n") + 1;
  const auto shown = [&](std::string_view text) {
    return '"' + printable(text.substr(field, text.find('\n', field) - field), 60) + '"';
  };
  return Error{position_prefix(path, found, field) + "found " + shown(found) + ", expected " + shown(expected) +
               " or the like; was the file changed, or made by another version?"};
}

// The procedure and, with strokes, their names and figures, which include a checksum of the forces.
std::string procedure_lines(const StudyHeader& header) {
  const std::string name = header.strokes == nullptr ? "constant" : "discriminate";
  return "# procedure " + name + "\n# timing_ms lead_in " + std::to_string(kLeadIn_ticks) + " ramp " +
         std::to_string(kRamp_ticks) + " hold " + std::to_string(kHold_ticks) + " pause " +
         std::to_string(kPause_ticks) + "\n" +
         (header.strokes == nullptr ? "" : "# strokes " + nlohmann::json(*header.strokes).dump() + "\n");
}

}  // namespace

double percent_of(double reference_N, double percent) noexcept {
  return std::round(reference_N * percent * 100.0) / 1e4;
}

Status check_subject_code(const std::string& code) {
  static const std::regex kCode("[A-Z]{1,3}[0-9]{1,4}");
  if (std::regex_match(code, kCode)) return {};
  return Error{"found the subject \"" + code +
               "\", expected a code of one to three capital letters and one to four digits, such as S01; names are "
               "not stored"};
}

std::vector<StudyTrial> plan_study(const std::string& code, const StrokePair* strokes) {
  Trials trials = strokes == nullptr ? constant_trials(code) : stroke_trials(code, *strokes);
  std::size_t training = 0, study = 0;
  for (StudyTrial& trial : trials) trial.number = trial.training ? ++training : ++study;
  return trials;
}

Stimuli stimuli_of(const StudyTrial& trial, const StrokePair* strokes) {
  if (strokes == nullptr) return {Stimulus{}, Stimulus{trial.first_N()}, Stimulus{trial.second_N()}};
  const Stimulus reference{1.0, &strokes->reference_N};
  const Stimulus comparison =
      trial.training ? Stimulus{kEasyShare, &strokes->reference_N} : Stimulus{1.0, &strokes->comparison_N};
  return {reference, trial.comparison_first ? comparison : reference, trial.comparison_first ? reference : comparison};
}

double StudyRecord::rendered_difference() const noexcept {
  const double reference_N = reference_rendered_N();
  return (first_rendered_N + second_rendered_N - 2.0 * reference_N) / reference_N;
}

std::string study_header_text(const StudyHeader& header, const std::string& consent) {
  return "# palpate-study 1\n# subject " + header.subject + "\n" + procedure_lines(header) + "# consent accepted, " +
         consent + "\n" + column_names(header.strokes != nullptr) + "\n";
}

std::string study_row(const StudyRecord& record, bool strokes) {
  return planned_columns(record.trial) + shortest(record.first_rendered_N) + "," + shortest(record.second_rendered_N) +
         (record.limited ? ",1," : ",0,") + (record.answered_second ? "second," : "first,") +
         std::to_string(record.response_ms) + "," +
         (strokes ? shortest(record.reminder_rendered_N) + "," + shortest(record.worst_N) + "," : "") + record.device +
         (record.rendered ? ",true\n" : ",false\n");
}

// The text is valid if the data that were read have the same text.
Result<StudyData> parse_study(const std::string& text, const std::string& path) {
  StudyData data;
  StudyHeader& header = data.header;
  const std::string_view found = whole_lines(text);
  const std::string begin = "# palpate-study 1\n# subject ";
  if (found.substr(0, begin.size()) != begin) return difference(found, begin, path);
  header.subject = value_of(found, "# subject ");
  if (const Status code = check_subject_code(header.subject); !code)
    return Error{path + ":2:1: " + code.error().message};
  if (const std::string strokes = value_of(found, "# strokes "); !strokes.empty()) {
    try {
      header.strokes = std::make_shared<const StrokePair>(nlohmann::json::parse(strokes).get<StrokePair>());
    } catch (const nlohmann::json::exception&) {
      return Error{path + ":5:1: found \"" + printable(strokes, 60) +
                   "\", expected the figures of two strokes as JSON"};
    }
  }
  std::string expected = study_header_text(header, value_of(found, "# consent accepted, "));
  for (const StudyTrial& trial : plan_study(header.subject, header.strokes.get())) {
    if (found.size() <= expected.size()) break;
    const std::string_view row = found.substr(expected.size());
    data.records.push_back(record_of(trial, row.substr(0, row.find('\n')), header.strokes != nullptr));
    expected += study_row(data.records.back(), header.strokes != nullptr);
  }
  if (found != expected) return difference(found, expected, path);
  return data;
}

Result<StudyData> read_study(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "a study file");
  if (!text) return text.error();
  return parse_study(*text, path);
}

Status check_study_files(const std::vector<StudyData>& files) {
  std::set<std::string> seen;
  for (const StudyData& file : files) {
    if (!seen.insert(file.header.subject).second)
      return Error{"found two files of subject " + file.header.subject + ", expected one; leave one of them out"};
    if (procedure_lines(file.header) != procedure_lines(files.front().header)) {
      return Error{"found another procedure or other strokes in the file of subject " + file.header.subject +
                   " than in that of subject " + files.front().header.subject +
                   ", expected the same; analyse them in separate commands"};
    }
  }
  return {};
}

Result<StudyFile> StudyFile::open(const std::string& path, const StudyHeader& header) {
  if (const Status code = check_subject_code(header.subject); !code) return code.error();
  StudyFile file(path, header);
  std::error_code missing;
  if (!std::filesystem::exists(path, missing)) return file;
  const Result<std::string> text = read_plain_file(path, "a study file");
  if (!text) return text.error();
  Result<StudyData> data = parse_study(*text, path);
  if (!data) return data.error();
  if (data->header.subject != header.subject || procedure_lines(data->header) != procedure_lines(header)) {
    return Error{path + ": found the answers of subject " + data->header.subject +
                 " or another study, expected subject " + header.subject +
                 " and the same forces; take another folder or subject code"};
  }
  file.text_ = *text;
  file.records_ = std::move(data->records);
  return file;
}

Status StudyFile::replace(const std::string& text) {
  if (read_whole_file(path_).value_or("") != text_)
    return Error{path_ + " was changed by another session in the meantime; start again to resume it"};
  if (Status written = write_file_atomically(path_, text, consented()); !written) return written;
  text_ = text;
  return {};
}

Status StudyFile::consent(const std::string& when) {
  return consented() ? Status() : replace(study_header_text(header_, when));
}

Status StudyFile::append(StudyRecord record) {
  if (!consented()) return Error{"cannot write " + path_ + ": there is no consent yet"};
  record.device = header_.device;
  std::replace(record.device.begin(), record.device.end(), ',', ';');  // a comma separates columns
  record.rendered = header_.rendered;
  const std::string row = study_row(record, header_.strokes != nullptr);
  if (Status stored = replace(std::string(whole_lines(text_)) + row); !stored) return stored;
  records_.push_back(std::move(record));
  return {};
}

}  // namespace palpate
