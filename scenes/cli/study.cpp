// palpate study: the force-discrimination study without a window. Runs it in a terminal,
// analyses the files of real subjects, simulates subjects.
#include <poll.h>
#include <unistd.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "devices/bridge/bridge_target.h"
#include "engine/base/atomic_file.h"
#include "engine/base/signals.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"
#include "scenes/scene/user_folders.h"
#include "scenes/study/discrimination.h"
#include "scenes/study/live_study.h"
#include "scenes/study/prepare_strokes.h"
#include "scenes/study/simulated_subject.h"
#include "scenes/study/study_figure.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

struct StudyOptions {
  int resamples = 999;  // of the subjects, for the interval of all together
  bool with_published = false;
  std::string out = ".";
  bool force = false;
  std::vector<std::string> files;  // analyse
  bool rehearsals = false;         // also answers that nobody could feel
  int subjects = 12;               // simulate
  std::uint64_t seed = 1;
  SubjectTraits traits{{0.05, 0.113}, 0.0, 0.01};  // 13.3 % at 2.5 N, as the paper's
  bool discriminates = false;
  std::string recording;  // to discriminate; empty: virtual
  std::string strokes_scene = "silicone_block";
  std::vector<std::string> models;
  std::string device = "auto";  // run
  std::string subject;
  bool bridge_remote = false;
};

constexpr std::uint64_t kPopulationStream = 51;
constexpr int kPause_ms = 10;

// What may be typed now, by StudyState; Enter ends a line.
constexpr const char* kChoices[] = {" [y: I have read this and agree]",
                                    " [Enter: go on]",
                                    "",
                                    " [1 or 2]",
                                    " [r: try again]",
                                    " [Enter: go on]",
                                    "",
                                    ""};

void print_analysis(const StudyAnalysis& analysis) {
  std::printf("%-13s %8s %12s %22s\n", "reference [N]", "subjects", "mean JND [%]", "all answers [%], 95 %");
  for (const PooledJnd& pooled : analysis.pooled) {
    const double percent = 100.0 / pooled.rendered_N;
    std::printf("%-13.4g %8zu %7.1f ±%4.1f %9.1f (%.1f to %.1f)\n", pooled.reference_N, pooled.subjects,
                percent * pooled.mean_N, percent * pooled.standard_error_N, percent * pooled.jnd_N.value,
                percent * pooled.jnd_N.low, percent * pooled.jnd_N.high);
  }
  if (analysis.subjects.size() > 1) {
    std::printf(
        "all answers: one function for everybody; at the larger forces above the mean, because a subject's few "
        "answers\ndo not tell a miss from a lapse, and each miss taken for a lapse makes that subject's JND smaller\n");
  }
  for (const SubjectJnd& subject : analysis.subjects) {
    if (subject.unusable == 0) continue;
    std::printf("%s: %zu trials left out, their forces were not rendered\n", subject.subject.c_str(), subject.unusable);
  }
  if (!analysis.lines.ok()) return;
  const JndLines& lines = *analysis.lines;
  std::printf("fitted       %.4f N + %.2f %%\nconservative %.4f N + %.2f %%\n", lines.fitted.offset_N,
              100.0 * lines.fitted.weber_fraction, lines.conservative.offset_N,
              100.0 * lines.conservative.weber_fraction);
}

Status make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{"cannot make the folder " + folder + ": " + error.message()};
  return {};
}

// Table, JND file, figures.
Status write_analysis(const StudyAnalysis& analysis, const StudyOptions& options) {
  if (const Status made = make_folder(options.out); !made) return made;
  print_analysis(analysis);
  const Status table = write_file_atomically(options.out + "/results.csv", analysis_table(analysis), options.force);
  if (!table) return table;
  if (analysis.lines.ok()) {
    std::vector<std::string> subjects;
    for (const SubjectJnd& subject : analysis.subjects) subjects.push_back(subject.subject);
    const std::string text = jnd_file_text(*analysis.lines, analysis.points, subjects);
    const Status jnd = write_file_atomically(options.out + "/jnd.json", text, options.force);
    if (!jnd) return jnd;
  }
  if (const Status figures = write_study_figures(analysis, options.out, options.force); !figures) return figures;
  if (!analysis.lines.ok()) return Error{"no JND file: " + analysis.lines.error().message};
  return {};
}

Status analyse(const std::vector<StudyData>& files, const StudyOptions& options) {
  Result<StudyAnalysis> analysis = Error{""};
  {
    ProgressLine line("analysing");
    analysis = analyse_study(files, options.resamples, options.with_published,
                             [&](double share) { return line.update(share); });
  }
  if (!analysis) return analysis.error();
  return write_analysis(*analysis, options);
}

void print_discrimination(const DiscriminationAnalysis& analysis) {
  const StrokePair& strokes = *analysis.strokes;
  std::printf("reference    %s\ncomparison   %s\nstroke       %s, %.2f to %.2f s\n", strokes.reference.c_str(),
              strokes.comparison.c_str(), strokes.recording.c_str(), strokes.from_s, strokes.to_s);
  std::printf("error/JND    mean %.2f, max %.2f, as predicted (JND %.4g N + %.4g %%)\n", strokes.mean_over_jnd,
              strokes.max_over_jnd, strokes.jnd.offset_N, 100.0 * strokes.jnd.weber_fraction);
  if (analysis.all.unusable > 0)
    std::printf("%zu trials left out, their forces were not rendered\n", analysis.all.unusable);
  std::printf("%s\n", discrimination_verdict(analysis.all, strokes).c_str());
}

Status analyse_strokes(const std::vector<StudyData>& files, const StudyOptions& options) {
  const auto analysis = analyse_discrimination(files);
  if (!analysis) return analysis.error();
  if (const Status made = make_folder(options.out); !made) return made;
  print_discrimination(*analysis);
  return write_file_atomically(options.out + "/results.csv", discrimination_table(*analysis), options.force);
}

// By what the first file is.
Status analyse_files(const std::vector<StudyData>& files, const StudyOptions& options) {
  const bool strokes = !files.empty() && files.front().header.strokes != nullptr;
  return strokes ? analyse_strokes(files, options) : analyse(files, options);
}

Status run_analyse(const StudyOptions& options) {
  std::vector<StudyData> files;
  for (const std::string& path : options.files) {
    Result<StudyData> data = read_study(path);
    if (!data) return data.error();
    const std::size_t left_out = options.rehearsals ? 0 : remove_rehearsals(*data);
    if (left_out > 0) {
      std::fprintf(stderr, "%s: %zu answers left out, given without a force device (--rehearsals takes them)\n",
                   path.c_str(), left_out);
      if (data->records.empty()) continue;
    }
    files.push_back(std::move(*data));
  }
  if (files.empty())
    return Error{"all answers are rehearsals, given without a force device; pass --rehearsals to take them"};
  return analyse_files(files, options);
}

Result<StudyHeader> study_header(const StudyOptions& options) {
  StudyHeader header;
  if (!options.discriminates) return header;
  const Result<Scene> scene = load_scene(options.strokes_scene);
  if (!scene) return scene.error();
  const auto strokes = prepare_strokes({*scene, options.models, options.recording});
  if (!strokes) return strokes.error();
  header.strokes = *strokes;
  return header;
}

void obey(LiveStudy& study, const std::string& line) {
  StudySession& session = study.session();
  switch (line.empty() ? '\n' : std::tolower(static_cast<unsigned char>(line.front()))) {
    case 'y':
      return session.accept_consent(local_time_text("%Y-%m-%d %H:%M"));
    case '\n':
      return session.proceed();
    case '1':
    case '2':
      return session.answer(line.front() == '2');
    case 'r':
      return session.retry();
    case 'z':
      return study.start_zeroing();
    case 'q':
      return session.abort();
    default:
      return;
  }
}

// A line of standard input, where there is one; false: there will be none.
bool read_line(std::string& typed, bool& whole) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  whole = false;
  if (poll(&input, 1, kPause_ms) <= 0) return true;
  char letter = '\0';
  if (::read(STDIN_FILENO, &letter, 1) != 1) return false;
  whole = letter == '\n';
  if (!whole && typed.size() < 80) typed += letter;
  return true;
}

// What there is to say, each time that it changes.
std::string words_of(LiveStudy& study) {
  const StudyView view = study.session().view();
  std::string words;
  if (view.trials > 0 && view.state == StudyState::answering) {
    words = std::string(view.training ? "training " : "") + std::to_string(view.answered + 1) + " of " +
            std::to_string(view.trials) + ": ";
  }
  words += view.message + kChoices[static_cast<std::size_t>(view.state)];
  if (const std::string device = study.device_words(); !device.empty()) words += "\n" + device;
  if (study.newest().device.zeroing == Zeroing::needed) words += " [z: zero here]";
  return words;
}

void converse(LiveStudy& study) {
  std::string said, typed;
  const auto over = [&] {
    return study.session().state() == StudyState::done || study.session().state() == StudyState::aborted;
  };
  for (bool input = true; !over();) {
    study.update();
    if (const std::string words = words_of(study); words != said) std::printf("%s\n", (said = words).c_str());
    std::fflush(stdout);
    bool whole = false;
    input = read_line(typed, whole);
    if (whole) obey(study, typed);
    if (whole) typed.clear();
    if (!input || stop_requested() != 0) study.session().abort();
  }
  std::printf("%s\n", study.session().view().message.c_str());
}

Status run_study_session(const StudyOptions& options) {
  const StopListener listener;
  Result<StudyHeader> header = study_header(options);
  if (!header) return header.error();
  LiveStudyRequest request;
  request.device = options.bridge_remote ? with_remote_bridge(options.device) : options.device;
  request.header = *header;
  request.header.subject = options.subject;
  request.path = options.out + (options.discriminates ? "/discriminate-" : "/study-") + options.subject + ".csv";
  const auto study = LiveStudy::open(request);
  if (!study) return study.error();
  if (!(*study)->device_pushes()) std::printf("%s\n", kRehearsal);
  converse(**study);
  std::printf("%s\n", request.path.c_str());
  return {};
}

Status run_simulate(const StudyOptions& options) {
  Result<StudyHeader> header = study_header(options);
  if (!header) return header.error();
  if (const Status made = make_folder(options.out); !made) return made;
  std::vector<StudyData> files;
  {
    ProgressLine line("simulating");
    for (int i = 1; i <= options.subjects; ++i) {
      if (!line.update(static_cast<double>(i - 1) / options.subjects)) return Error{"interrupted"};
      RandomStream random(options.seed, kPopulationStream + static_cast<std::uint64_t>(i));
      char code[16];
      std::snprintf(code, sizeof code, "S%02d", i);
      header->subject = code;
      StudyData data{*header, "simulated", simulated_answers(*header, options.traits, random.next()), 0};
      std::string text =
          study_header_text(data.header) + "# consent accepted, simulated\n" + study_columns(data.header) + "\n";
      for (const StudyRecord& record : data.records) text += study_row(record, data.header);
      const Status written = write_file_atomically(options.out + "/" + code + ".csv", text, options.force);
      if (!written) return written;
      files.push_back(std::move(data));
    }
  }
  return analyse_files(files, options);
}

void add_output_options(CLI::App* verb, StudyOptions& options) {
  verb->add_option("--resamples", options.resamples, "Of the subjects, for the interval of all together")
      ->check(CLI::Range(50, 100000))
      ->capture_default_str();
  verb->add_flag("--pang", options.with_published,
                 "The line goes below Pang, Tan & Durlach's point (1991) too: 9 % at 2.5 N");
  verb->add_option("--out", options.out, "Folder for results.csv and, for a JND, jnd.json and figure 3 (a) and (b)")
      ->required();
  verb->add_flag("--force", options.force, "Replace files that exist");
}

void add_analyse(CLI::App& study, Verbs& verbs) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = study.add_subcommand(
      "analyse", "From the files of the subjects to the JND line, its file and figure, or to who told strokes apart");
  verb->add_option("files", options->files, "Study files, one per subject (CSV)")->required();
  verb->add_flag("--rehearsals", options->rehearsals, "Also answers that were given without a force device");
  add_output_options(verb, *options);
  verbs.emplace_back(verb, [options] { return run_analyse(*options); });
}

void add_stroke_options(CLI::App* verb, const std::shared_ptr<StudyOptions>& options) {
  CLI::Option* discriminate =
      verb->add_option_function<std::string>(
              "--discriminate",
              [options](const std::string& recording) {
                options->discriminates = true;
                options->recording = recording;
              },
              "Which of two renderings of a stroke is which (100 trials), of this recording [a virtual one]")
          ->type_name("[REC.csv]")
          ->expected(0, 1);
  verb->add_option("--scene", options->strokes_scene, "To discriminate in")->capture_default_str()->needs(discriminate);
  verb->add_option("--model", options->models,
                   "To tell from the recorded force, or two to tell apart [the scene's first]")
      ->type_name("FILE_OR_METHOD")
      ->needs(discriminate);
}

void add_run(CLI::App& study, Verbs& verbs) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = study.add_subcommand("run", "One subject at a device, in this terminal; takes up where it ended");
  verb->add_option("--device", options->device, "As palpate-demo takes it; palpate devices lists them")
      ->capture_default_str()
      ->type_name("NAME");
  verb->add_option("--subject", options->subject, "The code that stands for the person, such as S01")->required();
  add_stroke_options(verb, options);
  verb->add_option("--out", options->out, "Folder for study-CODE.csv or discriminate-CODE.csv")->capture_default_str();
  verb->add_flag("--bridge-remote", options->bridge_remote, "bridge:tcp: may name another computer");
  verbs.emplace_back(verb, [options] { return run_study_session(*options); });
}

void add_simulate(CLI::App& study, Verbs& verbs) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb =
      study.add_subcommand("simulate", "A whole study with simulated subjects, from the first trial to the figure");
  verb->add_option("--subjects", options->subjects, "How many")->check(CLI::Range(1, 99))->capture_default_str();
  add_stroke_options(verb, options);
  verb->add_option("--seed", options->seed, "Which subjects")->capture_default_str();
  verb->add_option("--offset", options->traits.jnd.offset_N, "Their JND at no force, N")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  verb->add_option("--weber", options->traits.jnd.weber_fraction, "What it grows by with the force")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--bias", options->traits.order_bias_jnd, "What they add to the second force, multiples of the JND")
      ->check(CLI::Range(-2.0, 2.0))
      ->capture_default_str();
  verb->add_option("--lapse", options->traits.lapse_rate, "Share of answers that are wrong whatever the force")
      ->check(CLI::Range(0.0, 0.2))
      ->capture_default_str();
  add_output_options(verb, *options);
  verbs.emplace_back(verb, [options] { return run_simulate(*options); });
}

}  // namespace

void add_study(CLI::App& app, Verbs& verbs) {
  CLI::App* study = app.add_subcommand("study", "The force-discrimination study: run, analyse, simulate");
  study->require_subcommand(1);
  verbs.emplace_back(study, [] { return Status(); });
  Verbs parts;
  add_run(*study, parts);
  add_analyse(*study, parts);
  add_simulate(*study, parts);
  verbs.back().second = [parts] {
    for (const auto& [command, run] : parts) {
      if (command->parsed()) return run();
    }
    return Status();
  };
}

}  // namespace palpate::cli
