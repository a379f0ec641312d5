#include "scenes/plot/inline_svg.h"

#include <cctype>
#include <cstdio>
#include <utility>
#include <vector>

namespace palpate {
namespace {

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(from, at)) != std::string::npos; at = next + from.size())
    result.append(text, at, next - at).append(to);
  return result.append(text, at, std::string::npos);
}

// The spellings that gnuplot uses for a colour such as "#d8d8d8".
std::vector<std::string> spellings(std::string_view colour) {
  const auto part = [&](std::size_t at) { return std::stoi(std::string(colour.substr(at, 2)), nullptr, 16); };
  char wide[40];
  char narrow[40];
  std::snprintf(wide, sizeof wide, "rgb(%3d, %3d, %3d)", part(1), part(3), part(5));
  std::snprintf(narrow, sizeof narrow, "rgb(%d,%d,%d)", part(1), part(3), part(5));
  std::string upper(colour);
  for (char& letter : upper) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return {std::string(colour), upper, wide, narrow};
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
  for (const char* reference : {"id=\"", "id='", "xlink:href=\"#", "xlink:href='#"})
    body = replaced(body, reference, std::string(reference).append(name).append("-"));
  body = replaced(body, "url(#", std::string("url(#").append(name).append("-"));
  body = replaced(body, "xlink:href", "href");
  const std::pair<std::string_view, std::string_view> variables[] = {{"#222222", "var(--ink)"},
                                                                     {"#6e6e6e", "var(--muted)"},
                                                                     {"#d8d8d8", "var(--grid)"},
                                                                     {"#e3e3e3", "var(--band)"},
                                                                     {"#fefefe", "var(--paper)"}};
  for (const auto& [colour, variable] : variables)
    for (const std::string& form : spellings(colour)) body = replaced(body, form, variable);
  body = replaced(body, "\"black\"", "\"var(--ink)\"");
  return "<svg viewBox=\"" + view + "\" role=\"img\" aria-label=\"" + escape_html(title) + "\">" + body;
}

}  // namespace palpate
