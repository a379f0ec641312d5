#include "scenes/worker/model_worker.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::string names(const std::string& scene, const std::vector<std::string>& models) {
  const auto requests = requested_models(load_scene(scene).value(), models);
  if (!requests) return "error: " + requests.error().message;
  std::string text;
  for (const ModelRequest& request : *requests) text += (text.empty() ? "" : ", ") + request_name(request);
  return text;
}

TEST(ModelRequest, RefusesUnknownModels) {
  EXPECT_TRUE(test::has_parts(names("silicone_block", {"gredy"}), {"\"gredy\"", "trend", "greedy"}));
  EXPECT_TRUE(test::has_parts(names("silicone_block", std::vector<std::string>(17, "random")),
                              {"17 models", "at most 16", "; "}));
  for (const char* wrong : {"voxel-10", "greedy-", "greedy-x", "2009-greedy"})
    EXPECT_EQ(names("silicone_block", {wrong}).rfind("error: ", 0), 0u) << wrong;
}

}  // namespace
}  // namespace palpate
