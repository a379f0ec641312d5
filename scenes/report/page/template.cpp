#include "scenes/report/page/template.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate {
namespace {

struct Section {
  std::string name;
  bool shown = true;  // and so are those around it
};

}  // namespace

Result<std::string> filled_template(const std::string& text, const std::string& path, const TemplateValues& values) {
  std::string filled;
  std::vector<Section> sections;
  std::size_t at = 0;
  const auto shown = [&] { return sections.empty() || sections.back().shown; };
  const auto error = [&](std::size_t place, const std::string& what) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
    return Error{path + ":" + std::to_string(line) + ": " + what};
  };
  while (true) {
    const std::size_t open = text.find("{{", at);
    if (shown()) filled.append(text, at, open == std::string::npos ? open : open - at);
    if (open == std::string::npos) break;
    const std::size_t close = text.find("}}", open);
    if (close == std::string::npos) return error(open, "found {{ without }}, expected a name between them");
    std::string name = text.substr(open + 2, close - open - 2);
    at = close + 2;
    if (!name.empty() && name.front() == '/') {
      if (sections.empty() || sections.back().name != name.substr(1)) {
        return error(open, "found {{" + name + "}}, expected the end of the section begun last");
      }
      sections.pop_back();
      continue;
    }
    const bool section = !name.empty() && name.front() == '?';
    if (section) name.erase(0, 1);
    const std::string* value = values(name);
    if (value == nullptr) return error(open, "found {{" + name + "}}, expected a name that the report has");
    if (section) {
      sections.push_back({name, shown() && !value->empty()});
    } else if (shown()) {
      filled.append(*value);
    }
  }
  if (!sections.empty()) return error(text.size(), "found the end, expected {{/" + sections.back().name + "}} before it");
  return filled;
}

}  // namespace palpate
