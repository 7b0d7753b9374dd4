#pragma once

#include <string>
#include <string_view>

#include "optimisation/report/series_style.h"

namespace kingpin::report {

/// Coordinates to a tenth of a pixel, without needless zeros; what is not finite or far outside
/// becomes a number that every browser draws.
std::string FormatPixel(double value);

/// `x,y`
std::string FormatPoint(double x, double y);

/// Width of a text in pixels, estimated (no font is measured): 0.56 em per character.
double EstimateTextWidth(std::string_view utf8, double font_size);

/// Elements of inline SVG; `css` is a class of the page's style sheet. Texts named `content` must
/// be escaped already (EscapeHtml or SymbolSvg).
std::string SvgLine(double x1, double y1, double x2, double y2, std::string_view css);
std::string SvgText(double x, double y, std::string_view anchor, std::string_view content,
                    std::string_view css = "");
std::string SvgMarker(Marker marker, double x, double y, double radius, std::string_view colour,
                      bool filled);
/// ` stroke="..." stroke-width="..." stroke-dasharray="..."`
std::string StrokeAttributes(const SeriesStyle& style);

}  // namespace kingpin::report
