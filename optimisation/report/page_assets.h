#pragma once

#include <string_view>

namespace kingpin::report {

/// The style sheet of a report: screen (with a table of contents at the side) and A4 landscape.
std::string_view GetPageStyle();

/// The script of a report: values under the pointer, the animation, opening of folded parts for
/// print, and marks for the browser test (`data-errors`, `data-resources` on <html>). A report
/// reads the same without it.
std::string_view GetPageScript();

}  // namespace kingpin::report
