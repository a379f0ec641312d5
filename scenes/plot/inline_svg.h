// Converts an SVG drawing of gnuplot for inclusion in an HTML page.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

// Removes the prologue and the fixed size, prefixes ids with `name`, and replaces the neutral colours of
// assets/figures/style.gp by the page's CSS variables (--ink, --muted, --grid, --band, --paper), so that the drawing
// follows the light or dark theme. Returns an empty string where `svg` is no SVG.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// Replaces & < > " ' by entities.
std::string escape_html(std::string_view text);

}  // namespace palpate
