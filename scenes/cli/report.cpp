// palpate report: every method on the user's recordings, as a page.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "scenes/cli/check_recordings.h"
#include "scenes/cli/feature_list.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/report/report.h"

namespace palpate::cli {
namespace {

// One word of a command line as a shell would need it.
std::string shell_word(const std::string& word) {
  const char* const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted("'");
  for (const char letter : word) {
    if (letter == '\'') {
      quoted.append("'\\''");
    } else {
      quoted.push_back(letter);
    }
  }
  return quoted.append("'");
}

std::string command_line(const ReportRequest& request) {
  std::string text("palpate report");
  const auto add_list = [&](const char* option, const std::vector<std::string>& words) {
    if (words.empty()) return;
    text.append(option);
    for (const std::string& word : words) text.append(" ").append(shell_word(word));
  };
  add_list(" --train", request.train);
  add_list(" --test", request.test);
  text.append(" --scene ").append(shell_word(request.scene));
  text.append(" --out ").append(shell_word(request.out));
  const ReportRecipe& recipe = request.recipe;
  if (!recipe.paper || !recipe.palpate) text.append(recipe.paper ? " --recipe paper" : " --recipe palpate");
  const ReportRecipe defaults;
  if (recipe.features != defaults.features) text.append(" --features ").append(shell_word(recipe.features));
  if (recipe.reduction != defaults.reduction) text.append(" --reduction ").append(reduction_name(recipe.reduction));
  if (recipe.weighting != defaults.weighting) text.append(" --weighting ").append(weighting_name(recipe.weighting));
  if (recipe.kernel != defaults.kernel) text.append(" --kernel ").append(kernel_name(recipe.kernel));
  if (request.quick) text.append(" --quick");
  return text;
}

// As words on the command line.
struct RecipeWords {
  std::string recipe = "both";
  std::string reduction = "coverage";
  std::string weighting = "jnd";
  std::string kernel = "cubic";
  std::string features = "auto";
};

// Words that were checked already.
ReportRecipe recipe_of(const RecipeWords& words) {
  ReportRecipe recipe;
  recipe.paper = words.recipe != "palpate";
  recipe.palpate = words.recipe != "paper";
  recipe.reduction = static_cast<Reduction>(std::find(kReductionNames.begin(), kReductionNames.end(), words.reduction) - kReductionNames.begin());
  recipe.weighting = static_cast<Weighting>(std::find(kWeightingNames.begin(), kWeightingNames.end(), words.weighting) - kWeightingNames.begin());
  recipe.kernel = *kernel_from_name(words.kernel);
  recipe.features = words.features;
  if (words.features == "scene") {
    recipe.choice = FeatureChoice::scene;
  } else if (words.features != "auto") {
    recipe.choice = FeatureChoice::given;
    recipe.list = *parse_feature_list(words.features);
  }
  return recipe;
}

void add_recipe_options(CLI::App& verb, const std::shared_ptr<RecipeWords>& words) {
  verb.add_option("--recipe", words->recipe, "The paper's recipe, Palpate's, or both")
      ->check(CLI::IsMember({"paper", "palpate", "both"}))->capture_default_str();
  verb.add_option("--features", words->features,
                  std::string("Of Palpate's recipe: what the recordings support, the scene's, or a list such as ") +
                      kFeatureListExample)
      ->check(CLI::Validator(check_features, "auto|scene|LIST"))->capture_default_str();
  verb.add_option("--reduction", words->reduction, "Of Palpate's recipe: which samples become sites")
      ->check(CLI::IsMember({"coverage", "force", "none"}))->capture_default_str();
  verb.add_option("--weighting", words->weighting, "Of Palpate's recipe: what an error counts")
      ->check(CLI::IsMember({"jnd", "relative", "none"}))->capture_default_str();
  verb.add_option("--kernel", words->kernel, "Of both recipes")
      ->check(CLI::IsMember({"cubic", "linear", "thin-plate", "quintic"}))->capture_default_str();
}

Status run(ReportRequest request) {
  request.command_line = command_line(request);
  request.version = "palpate " PALPATE_VERSION;
  const auto scene = load_scene(request.scene);
  if (!scene) return scene.error();
  if (request.train.empty() && !request.test.empty()) {
    return Error{"found --test without --train, expected recordings to train on as well; give them with --train"};
  }
  std::vector<std::string> recordings = request.train;
  recordings.insert(recordings.end(), request.test.begin(), request.test.end());
  if (const auto checked = check_before_use(recordings, check_request(*scene)); !checked) return checked.error();
  Result<ReportSummary> summary = [&] {
    ProgressLine line("reporting");
    FitControl control;
    control.progress = [&](double fraction) { return line.update(fraction); };
    return make_report(request, control);
  }();
  if (!summary) return summary.error();
  for (const std::string& sentence : summary->findings) std::printf("%s\n", sentence.c_str());
  std::printf("written  %s/index.html and %zu more files\n", request.out.c_str(), summary->files.size() - 1);
  return {};
}

}  // namespace

void add_report(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("report", "Fit every method, measure speed and error, write a page");
  const auto request = std::make_shared<ReportRequest>();
  const auto words = std::make_shared<RecipeWords>();
  verb->add_option("--train", request->train, "Recordings to train on; none: the virtual silicone")->type_name("CSV");
  verb->add_option("--test", request->test, "Recordings to test on; none: k-fold over the training recordings")
      ->type_name("CSV");
  verb->add_option("--scene", request->scene, "Scene whose features and JND line count")->capture_default_str();
  verb->add_option("--out", request->out, "Folder to make")->required()->type_name("DIR");
  add_recipe_options(*verb, words);
  verb->add_flag("--quick", request->quick, "Fewer sizes: some 20 seconds instead of minutes");
  verb->add_flag("--force", request->force, "Replace an earlier report");
  verbs.emplace_back(verb, [request, words] {
    request->recipe = recipe_of(*words);
    return run(*request);
  });
}

}  // namespace palpate::cli
