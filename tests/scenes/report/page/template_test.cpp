#include "scenes/report/page/template.h"

#include <gtest/gtest.h>

#include <map>

namespace palpate {
namespace {

Result<std::string> fill(const std::string& text) {
  static const std::map<std::string, std::string> values{{"a", "1"}, {"none", ""}};
  return filled_template(text, "page.html", [](const std::string& name) -> const std::string* {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
  });
}

TEST(Template, FillsNamesAndDropsEmptySections) {
  EXPECT_EQ(*fill("x{{a}}y{{?a}}kept{{/a}}{{?none}}dropped {{a}}{{?a}}too{{/a}}{{/none}}z"), "x1ykeptz");
}

TEST(Template, SaysWhereItIsBroken) {
  EXPECT_EQ(fill("\n{{b}}").error().message, "page.html:2: found {{b}}, expected a name that the report has");
  EXPECT_EQ(fill("{{?a}}").error().message, "page.html:1: found the end, expected {{/a}} before it");
  EXPECT_EQ(fill("{{/a}}").error().message, "page.html:1: found {{/a}}, expected the end of the section begun last");
  EXPECT_EQ(fill("{{a").error().message, "page.html:1: found {{ without }}, expected a name between them");
}

}  // namespace
}  // namespace palpate
