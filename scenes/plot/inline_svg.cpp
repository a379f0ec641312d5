#include "scenes/plot/inline_svg.h"

#include <utility>

namespace palpate {
namespace {

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(from, at)) != std::string::npos; at = next + from.size()) {
    result.append(text, at, next - at).append(to);
  }
  return result.append(text, at, std::string::npos);
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string safe(text);
  for (const auto& [letter, entity] :
       {std::pair{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}}) {
    safe = replaced(safe, letter, entity);
  }
  return safe;
}

std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title) {
  const std::size_t open = svg.find("<svg");
  if (open == std::string::npos) return {};
  const std::size_t box = svg.find("viewBox=\"", open) + 9;
  const std::string view = svg.substr(box, svg.find('"', box) - box);
  std::string body = svg.substr(svg.find('>', open) + 1);
  const std::size_t about = body.find("<title>");
  const std::size_t after = body.find("</desc>");
  if (about != std::string::npos && after != std::string::npos) body.erase(about, after + 7 - about);
  for (const char* reference : {"id=\"", "id='", "xlink:href=\"#", "xlink:href='#"}) {
    body = replaced(body, reference, std::string(reference).append(name).append("-"));
  }
  body = replaced(body, "url(#", std::string("url(#").append(name).append("-"));
  body = replaced(body, "xlink:href", "href");
  return "<svg viewBox=\"" + view + "\" role=\"img\" aria-label=\"" + escape_html(title) + "\">" + body;
}

}  // namespace palpate
