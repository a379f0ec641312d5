// What a palpate_model is to the sources of the C interface.
// Thread guarantee: immutable.
#pragma once

#include <memory>

#include "models/model/fitted_model.h"

struct palpate_model {
  std::shared_ptr<const palpate::FittedModel> model;
};
