// Model files of one command, under names that tell them apart.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"

namespace palpate::cli {

struct LoadedModel {
  std::string name;  // distinct among the models of one run
  std::shared_ptr<const FittedModel> model;
};

// `names`: one for each file, or none; models that then have one name are named by
// their files. Errors: too many models; a file that is no model, or a recording.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& names = {});

}  // namespace palpate::cli
