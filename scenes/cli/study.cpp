// palpate study: analyses the files of subjects in the force-discrimination study, or simulates subjects.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/atomic_file.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"
#include "scenes/study/discrimination.h"
#include "scenes/study/prepare_strokes.h"
#include "scenes/study/simulated_subject.h"
#include "scenes/study/study_figure.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

struct StudyOptions {
  bool with_published = false;
  std::string out = ".";
  bool force = false;
  std::vector<std::string> files;  // for `analyse`
  int subjects = 12;               // for `simulate`
  std::uint64_t seed = 1;
  SubjectTraits traits{{0.05, 0.113}, 0.0, 0.01};  // 13.3 % at 2.5 N, as in the paper
  bool discriminates = false;
  std::string recording;  // for --discriminate; empty: a virtual recording
  std::string strokes_scene = "silicone_block";
  std::vector<std::string> models;
};

constexpr std::uint64_t kPopulationStream = 51;
void print_analysis(const StudyAnalysis& analysis) {
  std::printf("%-13s %8s %12s\n", "reference [N]", "subjects", "mean JND [%]");
  for (const MeanJnd& mean : analysis.means) {
    const double percent = 100.0 / mean.rendered_N;
    std::printf("%-13.4g %8zu %7.1f ±%4.1f\n", mean.reference_N, mean.subjects, percent * mean.jnd_N,
                percent * mean.standard_error_N);
  }
  for (const SubjectJnd& subject : analysis.subjects) {
    if (subject.unusable == 0) continue;
    std::printf("%s: %zu trials were left out because their forces were not rendered\n", subject.subject.c_str(),
                subject.unusable);
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

// Writes the table, the JND file and the figures.
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
  const auto analysis = analyse_study(files, options.with_published);
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
    std::printf("%zu trials were left out because their forces were not rendered\n", analysis.all.unusable);
  std::printf("%s\n", discrimination_verdict(analysis.all, strokes).c_str());
}

Status analyse_strokes(const std::vector<StudyData>& files, const StudyOptions& options) {
  const auto analysis = analyse_discrimination(files);
  if (!analysis) return analysis.error();
  if (const Status made = make_folder(options.out); !made) return made;
  print_discrimination(*analysis);
  return write_file_atomically(options.out + "/results.csv", discrimination_table(*analysis), options.force);
}

// Analyses all files by the kind of the first one.
Status analyse_files(const std::vector<StudyData>& files, const StudyOptions& options) {
  const bool strokes = !files.empty() && files.front().header.strokes != nullptr;
  return strokes ? analyse_strokes(files, options) : analyse(files, options);
}

Status run_analyse(const StudyOptions& options) {
  std::vector<StudyData> files;
  for (const std::string& path : options.files) {
    Result<StudyData> data = read_study(path);
    if (!data) return data.error();
    files.push_back(std::move(*data));
  }
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
  verb->add_flag("--pang", options.with_published,
                 "Keep the JND line also below the point of Pang, Tan & Durlach (1991): 9 % at 2.5 N");
  verb->add_option("--out", options.out, "Folder for results.csv, and for a JND also jnd.json and figure 3 (a) and (b)")
      ->required();
  verb->add_flag("--force", options.force, "Replace files that exist");
}

void add_analyse(CLI::App& study, Verbs& verbs) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = study.add_subcommand(
      "analyse", "Analyse the files of the subjects: the JND line, its file and figures, or a discrimination");
  verb->add_option("files", options->files, "Study files, one per subject (CSV)")->required();
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
              "Discriminate two renderings of a stroke of this recording in 100 trials [a virtual recording]")
          ->type_name("[REC.csv]")
          ->expected(0, 1);
  verb->add_option("--scene", options->strokes_scene, "Scene of the discrimination")
      ->capture_default_str()
      ->needs(discriminate);
  verb->add_option("--model", options->models,
                   "Model to compare with the recorded force, or two models to compare [the scene's first]")
      ->type_name("FILE_OR_METHOD")
      ->needs(discriminate);
}

void add_simulate(CLI::App& study, Verbs& verbs) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* verb = study.add_subcommand("simulate", "Simulate the subjects of a study and analyse their answers");
  verb->add_option("--subjects", options->subjects, "Number of subjects")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  add_stroke_options(verb, options);
  verb->add_option("--seed", options->seed, "Seed of the subjects")->capture_default_str();
  verb->add_option("--offset", options->traits.jnd.offset_N, "JND of the subjects at 0 N, in N")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  verb->add_option("--weber", options->traits.jnd.weber_fraction,
                   "Weber fraction of the subjects: JND per newton of force")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--bias", options->traits.order_bias_jnd, "Bias added to the second force, in multiples of the JND")
      ->check(CLI::Range(-2.0, 2.0))
      ->capture_default_str();
  verb->add_option("--lapse", options->traits.lapse_rate, "Lapse rate: share of answers that are wrong at any force")
      ->check(CLI::Range(0.0, 0.2))
      ->capture_default_str();
  add_output_options(verb, *options);
  verbs.emplace_back(verb, [options] { return run_simulate(*options); });
}

}  // namespace

void add_study(CLI::App& app, Verbs& verbs) {
  CLI::App* study = app.add_subcommand(
      "study", "Analyse or simulate the force-discrimination study (palpate-demo --scene jnd_study)");
  study->require_subcommand(1);
  verbs.emplace_back(study, [] { return Status(); });
  Verbs parts;
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
