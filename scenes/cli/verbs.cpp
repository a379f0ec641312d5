#include "scenes/cli/verbs.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"

namespace palpate::cli {
namespace {

struct Called {
  std::string program = "palpate", line, kept;
  std::vector<std::string> verbs;
};
Called& called() {
  static Called one;
  return one;
}

constexpr auto kDrawInterval = std::chrono::milliseconds(100);
bool hidden = false;

// "label  37 %  12 s left"; the remaining time is shown after 2 % and 1 s.
std::string progress_text(const std::string& label, double fraction, double elapsed_s) {
  fraction = fraction > 0.0 ? std::min(fraction, 1.0) : 0.0;  // a NaN is 0
  char numbers[64];
  std::snprintf(numbers, sizeof numbers, "  %3.0f %%", 100.0 * fraction);
  std::string text = label + numbers;
  if (fraction >= 0.02 && elapsed_s >= 1.0)
    text += "  " + fixed(elapsed_s * (1.0 - fraction) / fraction, 0) + " s left";
  return text;
}

}  // namespace

const std::string& command_line() { return called().line; }
const std::string& kept_command() { return called().kept; }

void set_command_line(const CLI::App& app, const std::string& program, const std::vector<std::string>& words) {
  std::string line = shell_word(program), kept = "palpate";
  for (const std::string& word : words) {
    line += " " + shell_word(word);
    if (word != "--force" && word != "--json") kept += " " + shell_word(word);
  }
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  called() = {shell_word(program), line, kept, verbs};
}

std::string with_program_name(std::string text) {
  constexpr std::string_view kName = "palpate ";
  for (std::size_t at = 0; (at = text.find(kName, at)) != std::string::npos;) {
    const std::string rest = text.substr(at + kName.size());
    const std::string verb = rest.substr(0, rest.find_first_not_of("abcdefghijklmnopqrstuvwxyz"));
    const bool begins = at == 0 || std::string_view(" \n('`").find(text[at - 1]) != std::string_view::npos;
    const bool is_command = begins && std::ranges::count(called().verbs, verb) > 0;
    const std::string name = is_command ? called().program : "palpate";
    text.replace(at, kName.size() - 1, name);
    at += name.size() + 1;
  }
  return text;
}

CLI::Validator scene_name() {
  return {[](const std::string& name) {
            const auto names = scene_names();
            return !names || std::ranges::count(*names, name) > 0
                       ? std::string()
                       : "unknown scene \"" + name + "\"; known scenes: " + joined(*names);
          },
          ""};
}

CheckRequest check_request(const Scene& scene) { return check_request(scene.jnd, scene.features); }

Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request) {
  auto files = check_recording_files(paths, request);
  if (!files) return files.error();
  if (const Status usable = refuse_unusable(*files); !usable) return usable.error();
  for (const std::string& line : warning_lines(*files))
    std::fprintf(stderr, "warning: %s\n", printable(with_program_name(line), std::string::npos).c_str());
  return files;
}

Result<std::shared_ptr<const FittedModel>> load_model_file(const std::string& path, const std::string& advice) {
  auto model = load_model(path);
  if (model || !read_recording(path, 0)) return model;
  return Error{path + " is a recording, expected a model file (JSON, made by palpate fit); " + advice};
}

Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option) {
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (!std::filesystem::equivalent(out, input, missing)) continue;
    return Error{out + " is the file to read from, expected another one for " + option + "; name a new file"};
  }
  return {};
}

CLI::Validator number_from(double low, double high) {
  const std::string range = general(low, 12) + " to " + general(high, 12);
  return {[=](const std::string& text) {
            double value = 0.0;
            const char* const end = text.data() + text.size();
            if (parse_number(text.data(), end, value) == end && low <= value && value <= high) return std::string();
            return "found \"" + text + "\", expected a number from " + range;
          },
          range};
}

void print_json(const nlohmann::ordered_json& json) {
  std::printf("%s\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

// The number of characters of UTF-8 text.
static std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - width_of(row[i]), ' ');
      line += (i == 0 ? "" : "  ") + (numbers && i > 0 ? blanks + row[i] : row[i] + blanks);
    }
    std::printf("%s\n", line.substr(0, line.find_last_not_of(' ') + 1).c_str());
  }
}

void hide_progress() { hidden = true; }

ProgressLine::ProgressLine(std::string label)
    : label_(std::move(label)),
      start_(Clock::now()),
      last_drawn_(start_),
      terminal_(!hidden && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::update(double fraction) {
  const Clock::time_point now = Clock::now();
  most_ = std::max(most_, fraction);
  if (terminal_ && now - last_drawn_ >= kDrawInterval) {
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    std::fprintf(stderr, "\r\033[K%s", progress_text(label_, most_, elapsed_s).c_str());
    std::fflush(stderr);
    last_drawn_ = now;
    drawn_ = true;
  }
  return stop_requested() == 0;
}

}  // namespace palpate::cli
