// A drawing of gnuplot's made ready to stand in an HTML page.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

// No prologue, no fixed size, ids made its own with `name`, and the neutral colours of
// assets/figures/style.gp replaced by the page's variables (--ink, --muted, --grid, --band,
// --paper), so that it follows light and dark. Empty for what is no SVG.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// & < > " ' as entities.
std::string escape_html(std::string_view text);

}  // namespace palpate
