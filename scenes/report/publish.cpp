#include "scenes/report/publish.h"

#include <filesystem>

#include "engine/base/text.h"
#include "engine/base/whole_file.h"
#include "scenes/plot/draw.h"
#include "scenes/plot/inline_svg.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

constexpr double kPageWidth_rem = 52.0;

Result<std::string> read_template(const std::string& name) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/report/" + name;
  auto text = read_whole_file(path);
  if (!text) return Error{"cannot read " + path + ", a template of the report; check the assets folder"};
  return std::move(*text);
}

}  // namespace

Status draw_figures(const ReportFolder& folder, std::vector<Figure>& figures) {
  const std::string place = folder.path_of("figures");
  std::vector<Plot> plots;
  for (const Figure& figure : figures) plots.push_back(figure.plot);
  std::error_code ignored;
  std::filesystem::create_directories(place, ignored);
  if (const Status status = draw_plots(place, plots); !status) return status;
  for (Figure& figure : figures) {
    auto svg = read_drawn(place, figure.plot.name + ".svg");
    if (!svg) return svg.error();
    figure.svg = std::move(*svg);
  }
  return {};
}

std::string figure_html(const Figure& figure) {
  // Text has the same size in narrow figures and in wide ones.
  return "<figure style=\"max-width: " + general(kPageWidth_rem * figure.plot.width, 3) + "rem\">" +
         inline_svg(figure.svg, figure.plot.name, figure.caption) + "<figcaption>" + escape_html(figure.caption) +
         " <a class=\"data\" href=\"figures/" + figure.plot.name + ".gp\">data and script</a></figcaption></figure>\n";
}

Result<std::string> fill_page(const std::string& name, std::map<std::string, std::string> values) {
  const auto text = read_template(name);
  if (!text) return text.error();
  const auto style = read_template("style.css");
  if (!style) return style.error();
  values["style"] = *style;
  std::string page;
  std::size_t at = 0;
  for (std::size_t open; (open = text->find("{{", at)) != std::string::npos;) {
    const std::size_t close = text->find("}}", open);
    const auto value =
        close == std::string::npos ? values.end() : values.find(text->substr(open + 2, close - open - 2));
    if (value == values.end()) return Error{name + ": found {{ without the name of a part of the page after it"};
    page.append(*text, at, open - at).append(value->second);
    at = close + 2;
  }
  return page.append(*text, at);
}

}  // namespace palpate
