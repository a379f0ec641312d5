// Common functions of several verbs: checks of their files, and output.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {

// The JND line of the scene, and whether its force has a memory.
CheckRequest check_request(const Scene& scene);

// Reads and checks `paths` and prints a line on stderr for each warning. Errors: a file cannot be read or is unusable.
Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request);

// The output of `palpate check` for one recording.
std::string check_text(const CheckedFile& file);

// The output of `palpate check --json`.
void print_check_json(const std::vector<CheckedFile>& files);

// The command that fits these usable recordings, ready to copy: "next: palpate fit ..." and a line break.
std::string next_fit(const std::vector<std::string>& recordings);

// Loads a model file. Errors: as load_model; for a recording, that it is one, and `advice`.
Result<std::shared_ptr<const FittedModel>> load_model_file(const std::string& path, const std::string& advice);

// Errors: `out` is one of the files that are read. `option`: the option that named it, for the message.
Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option);

// Prints the file that a verb has just written, for --json. Errors: those of read_plain_file.
Status print_file(const std::string& path);

// Prints to stdout. Bytes that are not UTF-8, as in paths, are replaced.
void print_json(const nlohmann::ordered_json& json);

// Prints rows of cells in aligned columns, left-aligned; with `numbers` all but the first are right-aligned.
void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers);

}  // namespace palpate::cli
