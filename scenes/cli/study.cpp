// palpate study: analyses the files of subjects in the force-discrimination study, or simulates subjects.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "engine/base/files.h"
#include "engine/base/random_stream.h"
#include "models/fit/fit.h"
#include "scenes/cli/verbs.h"
#include "scenes/study/study_analysis.h"
#include "scenes/study/study_file.h"

namespace palpate::cli {
namespace {

struct StudyOptions {
  bool with_published = false;
  bool json = false;
  std::string out = ".";
  bool force = false;
  std::vector<std::string> files;  // for `analyse`
  int subjects = 12;               // for `simulate`
  std::uint64_t seed = 1;
  SubjectTraits traits = kSubjectOf2009;
  std::optional<std::string> discriminate;  // the recording; empty: a virtual one
  std::string strokes_scene = "silicone_block";
  std::vector<std::string> models;
};

constexpr std::uint64_t kPopulationStream = 51;

// Writes a file into the folder for the results, which it creates.
Status write_result(const std::string& name, const std::string& text, const StudyOptions& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) return Error{"cannot make the folder " + options.out + ": " + error.message()};
  return write_file_atomically(options.out + "/" + name, text, options.force);
}

void print_left_out(const std::string& subject, std::size_t unusable) {
  if (unusable > 0)
    std::printf("%s: %zu trials were left out because their forces were not rendered\n", subject.c_str(), unusable);
}

void print_analysis(const StudyAnalysis& analysis) {
  std::printf("%-13s %8s %12s\n", "reference [N]", "subjects", "mean JND [%]");
  for (const ReferenceJnd& mean : analysis.mean.references) {
    if (mean.rendered_N == 0.0) continue;
    const double percent = 100.0 / mean.rendered_N;
    std::printf("%-13.4g %8zu %7.1f ±%4.1f\n", mean.reference_N, mean.count, percent * mean.jnd_N,
                percent * mean.standard_error_N);
  }
  for (const SubjectJnd& subject : analysis.subjects) print_left_out(subject.subject, subject.unusable);
  if (!analysis.lines.ok()) return;
  const auto print_line = [](const char* name, const JndLine& line) {
    std::printf("%-12s %.4f N + %.2f %%\n", name, line.offset_N, 100.0 * line.weber_fraction);
  };
  print_line("fitted", analysis.lines->fitted);
  print_line("conservative", analysis.lines->conservative);
}

nlohmann::ordered_json discrimination_json(const std::vector<Discrimination>& results, const StrokePair& strokes) {
  nlohmann::ordered_json subjects = nlohmann::ordered_json::array();
  for (const Discrimination& one : results) {
    const CorrectShare share = correct_share(one);
    subjects.push_back({{"subject", one.subject},
                        {"trials", one.trials},
                        {"correct", one.correct},
                        {"unusable", one.unusable},
                        {"share", share.share},
                        {"share_low", share.low},
                        {"share_high", share.high}});
  }
  return {{"reference", strokes.reference},
          {"comparison", strokes.comparison},
          {"recording", strokes.recording},
          {"mean_error_over_jnd", strokes.mean_over_jnd},
          {"max_error_over_jnd", strokes.max_over_jnd},
          {"verdict", discrimination_verdict(results.back(), strokes)},
          {"subjects", subjects}};
}

Status analyse_strokes(const std::vector<StudyData>& files, const StudyOptions& options) {
  const auto results = analyse_discrimination(files);
  if (!results) return results.error();
  const StrokePair& strokes = *files.front().header.strokes;
  const Discrimination& all = results->back();
  if (const Status written = write_result("results.csv", discrimination_table(*results, strokes), options); !written)
    return written;
  if (options.json) {
    print_json(discrimination_json(*results, strokes));
    return {};
  }
  std::printf("reference    %s\ncomparison   %s\nstroke       %s, from %.2f s\n", strokes.reference.c_str(),
              strokes.comparison.c_str(), strokes.recording.c_str(), strokes.from_s);
  std::printf("error/JND    mean %.2f, max %.2f, as predicted (JND %.4g N + %.4g %%)\n", strokes.mean_over_jnd,
              strokes.max_over_jnd, strokes.jnd.offset_N, 100.0 * strokes.jnd.weber_fraction);
  print_left_out(all.subject, all.unusable);
  std::printf("%s\n", discrimination_verdict(all, strokes).c_str());
  return {};
}

// Analyses all files by the procedure of the first one. Writes the table and, for constant stimuli, the JND file.
Status analyse(const std::vector<StudyData>& files, const StudyOptions& options) {
  if (const Status checked = check_study_files(files); !checked) return checked;
  if (files.front().header.strokes != nullptr) return analyse_strokes(files, options);
  const auto analysis = analyse_study(files, options.with_published);
  if (!analysis) return analysis.error();
  if (!options.json) print_analysis(*analysis);
  if (Status written = write_result("results.csv", analysis_table(*analysis), options); !written) return written;
  if (!analysis->lines.ok()) return Error{"no JND file: " + analysis->lines.error().message};
  const std::string text = jnd_file_text(*analysis);
  if (options.json) std::fputs(text.c_str(), stdout);
  return write_result("jnd.json", text, options);
}

Status run_analyse(const StudyOptions& options) {
  std::vector<StudyData> files;
  for (const std::string& path : options.files) {
    Result<StudyData> data = read_study(path);
    if (!data) return data.error();
    files.push_back(std::move(*data));
  }
  return analyse(files, options);
}

// Writes and analyses the file of each subject.
Status run_simulate(const StudyOptions& options) {
  StudyHeader header;
  if (options.discriminate) {
    auto strokes = prepare_strokes(options.strokes_scene, options.models, *options.discriminate);
    if (!strokes) return strokes.error();
    header.strokes = std::move(*strokes);
  }
  std::optional<ProgressLine> line("simulating");
  std::vector<StudyData> files;
  for (int i = 1; i <= options.subjects; ++i) {
    if (!line->update(static_cast<double>(i - 1) / options.subjects)) return Error{"interrupted"};
    RandomStream random(options.seed, kPopulationStream + static_cast<std::uint64_t>(i));
    header.subject = (i < 10 ? "S0" : "S") + std::to_string(i);
    files.push_back({header, simulated_answers(header, options.traits, random.next())});
    std::string text = study_header_text(header, "simulated");
    for (const StudyRecord& record : files.back().records) text += study_row(record, header.strokes != nullptr);
    if (Status written = write_result(header.subject + ".csv", text, options); !written) return written;
  }
  line.reset();  // Ctrl-C ends the program again
  return analyse(files, options);
}

void add_output_options(CLI::App* verb, StudyOptions& options) {
  verb->add_flag("--pang", options.with_published,
                 "Fit the line to the point of Pang, Tan & Durlach (1991) as well: 9 % at 2.5 N");
  verb->add_option("--out", options.out, "Folder for results.csv and, for a JND, jnd.json")->required();
  verb->add_flag("--json", options.json, "Print one JSON object");
  verb->add_flag("--force", options.force, "Replace files that exist");
}

void add_stroke_options(CLI::App* verb, StudyOptions& options) {
  CLI::Option* discriminate =
      verb->add_option_function<std::string>(
              "--discriminate", [&options](const std::string& recording) { options.discriminate = recording; },
              "Discriminate two renderings of a stroke of this recording, in 100 trials [a virtual one]")
          ->type_name("[REC.csv]")
          ->expected(0, 1);
  verb->add_option("--scene", options.strokes_scene, "Scene of the strokes")
      ->capture_default_str()
      ->check(scene_name())
      ->needs(discriminate);
  verb->add_option("--model", options.models,
                   "The model to compare with the recorded force, or two models [the scene's first]")
      ->type_name("FILE_OR_METHOD")
      ->needs(discriminate);
}

void add_simulate_options(CLI::App* verb, StudyOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help, double low, double high) {
    verb->add_option(name, value, help)->check(number_from(low, high))->capture_default_str();
  };
  verb->add_option("--subjects", options.subjects, "Number of subjects")
      ->check(number_from(1.0, 99.0))
      ->capture_default_str();
  add_stroke_options(verb, options);
  verb->add_option("--seed", options.seed, "Seed of the subjects")
      ->check(CLI::Validator([](const std::string& text) { return option_error("seed", text); }, ""))
      ->capture_default_str();
  add("--offset", options.traits.jnd.offset_N, "Their JND at 0 N, N", 0.001, 1.0);
  add("--weber", options.traits.jnd.weber_fraction, "Increase of their JND with the force", 0.0, 1.0);
  add("--bias", options.traits.order_bias_jnd, "Bias added to the second force, in multiples of the JND", -2.0, 2.0);
  add("--lapse", options.traits.lapse_rate, "Share of answers that are wrong whatever the force", 0.0, 0.2);
}

}  // namespace

void add_study(CLI::App& app, Verbs& verbs) {
  CLI::App* study = app.add_subcommand(
      "study", "Analyse or simulate the force-discrimination study (palpate-demo --scene jnd_study)");
  study->require_subcommand(1);
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* analyses = study->add_subcommand(
      "analyse", "Files of subjects to the JND line, its file, or to the share of correct discriminations");
  analyses->add_option("files", options->files, "Study files, one per subject (CSV)")->required();
  add_output_options(analyses, *options);
  analyses->footer("Example:\n  palpate study analyse S01.csv S02.csv S03.csv --out results");
  CLI::App* simulates =
      study->add_subcommand("simulate", "A whole study with simulated subjects, from the first trial to the JND");
  add_simulate_options(simulates, *options);
  add_output_options(simulates, *options);
  simulates->footer("Example:\n  palpate study simulate --subjects 12 --out simulated");
  verbs.emplace_back(study, [=] { return analyses->parsed() ? run_analyse(*options) : run_simulate(*options); });
}

}  // namespace palpate::cli
