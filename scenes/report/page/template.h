// Text with places to fill in, as the report's page is: assets/report/page.html.
//
//   {{name}}                  the value of `name`, as it is
//   {{?name}} ... {{/name}}   the text between, unless the value of `name` is empty
// Thread guarantee: pure function.
#pragma once

#include <functional>
#include <string>

#include "engine/base/result.h"

namespace palpate {

// The value of a name; nothing for a name that nobody knows.
using TemplateValues = std::function<const std::string*(const std::string& name)>;

// Errors: an unknown name, a section without end or begin; with `path` and the line.
Result<std::string> filled_template(const std::string& text, const std::string& path, const TemplateValues& values);

}  // namespace palpate
