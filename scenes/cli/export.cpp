// palpate export: writes a model as one self-contained C99 file.
#include <cstdio>
#include <memory>
#include <string>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "models/export/export_c.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

struct ExportArguments {
  std::string model, out;
  double encoder_step_m = 0.0;
  bool single_precision = false, force = false;
};

void print_summary(const ExportArguments& arguments, const ModelData& data, const SensorSpec& sensor,
                   std::size_t bytes) {
  std::printf("%s: %s in %s precision, %zu bytes of C\n", arguments.out.c_str(), data.name.c_str(),
              arguments.single_precision ? "single" : "double", bytes);
  std::printf(
      "expects positions in steps of %g um with an additional noise of %g um (%s);\n"
      "gives the forces of palpate replay without an accelerometer\n",
      1e6 * sensor.encoder_step_m, 1e6 * sensor.position_noise_m,
      arguments.encoder_step_m > 0.0 ? "from --encoder-step"
      : data.sensor                  ? "from the model's recordings"
                                     : "the model has no step of its recordings; see --encoder-step");
}

Status run_export(const ExportArguments& arguments) {
  if (const Status status = refuse_input_as_output(arguments.out, {arguments.model}, "--c"); !status) return status;
  const auto model = load_model_file(
      arguments.model, "fit a model: palpate fit --recording " + shell_word(arguments.model) + " --out model.json");
  if (!model) return model.error();
  const ModelData& data = (*model)->data();
  const SensorSpec sensor = sensor_with_step(data, arguments.encoder_step_m);
  const std::string text = export_c(data, sensor, arguments.single_precision);
  if (Status status = write_file_atomically(arguments.out, text, arguments.force); !status) return status;
  print_summary(arguments, data, sensor, text.size());
  return {};
}

}  // namespace

void add_export(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("export", "Write a model as one self-contained C99 file");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("model", arguments->model, "Model file (JSON)")->required();
  command->add_option("--c", arguments->out, "C file to write")->required();
  command->add_flag("--float", arguments->single_precision, "Compute in single precision [double]");
  command
      ->add_option("--encoder-step", arguments->encoder_step_m,
                   "Step of the positions in metres; 0: the step of the model's recordings")
      ->check(number_from(0.0, 0.1))
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "Replace an existing file");
  verbs.emplace_back(command, [arguments] { return run_export(*arguments); });
}

}  // namespace palpate::cli
