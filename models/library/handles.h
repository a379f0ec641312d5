// The content of the handles of the C interface.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "models/library/palpate/palpate.h"
#include "models/model/fitted_model.h"

struct palpate_model {
  explicit palpate_model(std::shared_ptr<const palpate::FittedModel> fitted, std::string report_json = {})
      : model(std::move(fitted)), report(std::move(report_json)) {
    for (const palpate::FeatureSpec& spec : model->features()) feature_names.push_back(palpate::feature_name(spec));
  }

  std::shared_ptr<const palpate::FittedModel> model;
  std::string report;
  std::vector<std::string> feature_names;
};
