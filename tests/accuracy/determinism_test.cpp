// The same data and request give the same model, byte for byte. The button needs the correction of every method.
#include <gtest/gtest.h>

#include "models/model/file/model_io.h"
#include "tests/support/fitting.h"
#include "tests/support/temporary_folder.h"

namespace palpate::test {
namespace {

// The files of all methods, one after the other.
std::string fitted_files() {
  RigSettings settings = train_settings("button");
  settings.seconds = 12.0;
  settings.rate_Hz = 250.0;  // keeps direct fits short
  const TemporaryFolder folder;
  std::string text;
  for (const ModelPtr& model : fit_all(prepare({rig_recording(settings)}, default_request("silicone_block")))) {
    EXPECT_EQ(model->data().correction == nullptr, model->method() == "trend") << model->name();
    EXPECT_TRUE(save_model(folder.file(model->name()), model->data(), false).ok());
    text += read_text(folder.file(model->name()));
  }
  return text;
}

TEST(Determinism, TheSameFitTwiceGivesTheSameBytes) {
  const std::string once = fitted_files();
  EXPECT_TRUE(once == fitted_files());
}

}  // namespace
}  // namespace palpate::test
