// A drawing of gnuplot's made ready to stand in an HTML page.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

// No prologue, no fixed size, and ids made its own with `name`. Empty for what is no SVG.
std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title);

// & < > " ' as entities.
std::string escape_html(std::string_view text);

}  // namespace palpate
