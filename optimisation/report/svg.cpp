#include "optimisation/report/svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"

namespace kingpin::report {

std::string FormatPixel(double value) {
  if (std::isnan(value)) value = 0.0;
  const long tenths = std::lround(std::clamp(value, -1e5, 1e5) * 10.0);
  const long size = std::abs(tenths);
  std::string out = tenths < 0 ? "-" : "";
  out += std::to_string(size / 10);
  if (size % 10 != 0) {
    out += '.';
    out += static_cast<char>('0' + size % 10);
  }
  return out;
}

std::string FormatPoint(double x, double y) {
  std::string out = FormatPixel(x);
  out += ',';
  out += FormatPixel(y);
  return out;
}

double EstimateTextWidth(std::string_view utf8, double font_size) {
  const auto characters = std::count_if(utf8.begin(), utf8.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  });
  return 0.56 * font_size * static_cast<double>(characters);
}

std::string SvgLine(double x1, double y1, double x2, double y2, std::string_view css) {
  return fmt::format(R"(<line class="{}" x1="{}" y1="{}" x2="{}" y2="{}"/>)", css, FormatPixel(x1),
                     FormatPixel(y1), FormatPixel(x2), FormatPixel(y2));
}

std::string SvgText(double x, double y, std::string_view anchor, std::string_view content,
                    std::string_view css) {
  return fmt::format(R"(<text x="{}" y="{}" text-anchor="{}"{}>{}</text>)", FormatPixel(x),
                     FormatPixel(y), anchor,
                     css.empty() ? std::string() : fmt::format(R"( class="{}")", css), content);
}

std::string SvgMarker(Marker marker, double x, double y, double r, std::string_view colour,
                      bool filled) {
  if (marker == Marker::kNone || !std::isfinite(x) || !std::isfinite(y)) return {};
  const std::string c = EscapeHtml(colour);
  const std::string paint = fmt::format(R"(fill="{}" stroke="{}")", filled ? c : "#fff", c);
  const auto p = FormatPixel;
  switch (marker) {
    case Marker::kSquare:
      return fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}" {}/>)", p(x - 0.9 * r),
                         p(y - 0.9 * r), p(1.8 * r), p(1.8 * r), paint);
    case Marker::kDiamond:
      return fmt::format(R"(<path d="M{},{}L{},{}L{},{}L{},{}Z" {}/>)", p(x), p(y - 1.3 * r),
                         p(x + 1.3 * r), p(y), p(x), p(y + 1.3 * r), p(x - 1.3 * r), p(y), paint);
    case Marker::kTriangle:
      return fmt::format(R"(<path d="M{},{}L{},{}L{},{}Z" {}/>)", p(x), p(y - 1.2 * r),
                         p(x + 1.15 * r), p(y + 0.9 * r), p(x - 1.15 * r), p(y + 0.9 * r), paint);
    case Marker::kCross:
      return fmt::format(R"(<path d="M{},{}L{},{}M{},{}L{},{}" stroke="{}" stroke-width="1.8"/>)",
                         p(x - r), p(y - r), p(x + r), p(y + r), p(x - r), p(y + r), p(x + r),
                         p(y - r), c);
    default:
      return fmt::format(R"(<circle cx="{}" cy="{}" r="{}" {}/>)", p(x), p(y), p(r), paint);
  }
}

std::string StrokeAttributes(const SeriesStyle& style) {
  std::string out = fmt::format(R"( stroke="{}" stroke-width="{}")", EscapeHtml(style.colour),
                                FormatPixel(style.width));
  if (!style.dash.empty()) out += fmt::format(R"( stroke-dasharray="{}")", EscapeHtml(style.dash));
  return out;
}

}  // namespace kingpin::report
