#include "optimisation/report/geometry_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/label_placer.h"
#include "optimisation/report/line_chart.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/svg.h"

namespace kingpin::report {
namespace {

constexpr double kWidth = 1100.0;
constexpr double kMargin = 58.0;
constexpr double kSpringLength = 62.0;
constexpr double kDialRadius = 42.0;
constexpr size_t kFrames = 400;

bool IsDrawn(const Point2& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

/// Metres to pixels: x forward is up, y left is left.
struct View {
  double scale = 1.0;  ///< pixels per metre
  double x0 = 0.0;
  double y0 = 0.0;

  Pixel Map(const Point2& p) const { return {x0 - scale * p.y, y0 - scale * p.x}; }
};

Point2 InnerRackEnd(const CornerGeometry& g) {
  return {g.rod_inner.x, g.rod_inner.y - 2.0 * g.rack_half_length};
}

std::vector<Point2> CollectOutline(const CornerGeometry& g) {
  std::vector<Point2> points = {g.wheel_centre,    g.centre_of_mass,      g.kingpin,
                                g.force_point,     g.rod_outer,           g.rod_inner,
                                g.lateral_support, g.longitudinal_support};
  if (IsDrawn(g.wheel_centre)) {
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-0.5, 0.5}) {
        points.push_back(
            {g.wheel_centre.x + sx * g.wheel_radius, g.wheel_centre.y + sy * g.wheel_width});
      }
    }
  }
  if (g.rack_half_length > 0.0) {
    // The far half of a long rack tells nothing; it is cut with a break line.
    points.push_back({g.rod_inner.x, g.rod_inner.y - std::min(2.0 * g.rack_half_length, 0.25)});
  }
  std::erase_if(points, [](const Point2& p) { return !IsDrawn(p); });
  return points;
}

std::string DrawSpringPath(const Pixel& a, const Pixel& g) {
  constexpr int kTurns = 8;
  const double dx = g.x - a.x;
  const double dy = g.y - a.y;
  const double length = std::max(std::hypot(dx, dy), 1e-9);
  const double nx = -dy / length * 5.0;
  const double ny = dx / length * 5.0;
  std::string d = fmt::format("M{}", FormatPoint(a.x, a.y));
  for (int i = 1; i < kTurns; ++i) {
    const double s = 0.15 + 0.7 * (i - 0.5) / (kTurns - 1);
    const double side = i % 2 != 0 ? 1.0 : -1.0;
    d += 'L';
    d += FormatPoint(a.x + s * dx + side * nx, a.y + s * dy + side * ny);
  }
  d += 'L';
  return d + FormatPoint(g.x, g.y);
}

/// Where a support's spring stands on the car: along `direction`, away from the wheel's centre.
Pixel MapGround(const View& view, const CornerGeometry& g, const Point2& at, double direction) {
  const Pixel a = view.Map(at);
  Pixel u = {-std::sin(direction), -std::cos(direction)};  // (cos, sin) in x, y
  const Point2 from = IsDrawn(g.wheel_centre) ? g.wheel_centre : g.centre_of_mass;
  const Pixel centre = IsDrawn(from) ? view.Map(from) : a;
  if (u.x * (a.x - centre.x) + u.y * (a.y - centre.y) < 0.0) u = {-u.x, -u.y};
  return {a.x + kSpringLength * u.x, a.y + kSpringLength * u.y};
}

/// A support: spring along `direction` away from the wheel's centre line, and hatched ground.
std::string DrawSupport(const View& view, const CornerGeometry& g, const Point2& at,
                        double direction, size_t item, const std::string& colour) {
  if (!IsDrawn(at) || !std::isfinite(direction)) return {};
  const Pixel a = view.Map(at);
  const Pixel ground = MapGround(view, g, at, direction);
  const Pixel u = {(ground.x - a.x) / kSpringLength, (ground.y - a.y) / kSpringLength};
  std::string out = fmt::format(
      R"(<path class="ln spring" data-d="{}" data-ax="{}" data-ay="{}" data-gx="{}" data-gy="{}" d="{}" stroke="{}" stroke-width="1.3"/>)",
      item, FormatPixel(a.x), FormatPixel(a.y), FormatPixel(ground.x), FormatPixel(ground.y),
      DrawSpringPath(a, ground), colour);
  const Pixel n = {-u.y, u.x};
  std::string d = fmt::format("M{},{}L{},{}", FormatPixel(ground.x - 11 * n.x),
                              FormatPixel(ground.y - 11 * n.y), FormatPixel(ground.x + 11 * n.x),
                              FormatPixel(ground.y + 11 * n.y));
  for (double s = -9.0; s <= 9.0; s += 6.0) {
    d += fmt::format("M{},{}L{},{}", FormatPixel(ground.x + s * n.x),
                     FormatPixel(ground.y + s * n.y),
                     FormatPixel(ground.x + (s - 4) * n.x + 6 * u.x),
                     FormatPixel(ground.y + (s - 4) * n.y + 6 * u.y));
  }
  return out +
         fmt::format(R"(<path class="ln" d="{}" stroke="{}" stroke-width="1.2"/>)", d, colour);
}

std::string DrawDot(const View& view, const Point2& p, Marker marker, const std::string& colour,
                    bool filled) {
  if (!IsDrawn(p)) return {};
  const Pixel a = view.Map(p);
  return SvgMarker(marker, a.x, a.y, 4.2, colour, filled);
}

std::string DrawCorner(const View& view, const Design& design, size_t item,
                       const SeriesStyle& style, double width) {
  const CornerGeometry& g = design.geometry;
  const std::string colour = EscapeHtml(style.colour);
  std::string out;

  // Fixed to the car: the rack's guide and the grounds.
  if (IsDrawn(g.rod_inner) && g.rack_half_length > 0.0) {
    const Pixel inner = view.Map(g.rod_inner);
    const Pixel far = view.Map(InnerRackEnd(g));
    const double end = std::min(far.x, width - 14.0);
    out += fmt::format(
        R"(<g class="rack" data-d="{}"><line x1="{}" y1="{}" x2="{}" y2="{}" stroke="{}" stroke-width="7" stroke-opacity=".35"/>)",
        item, FormatPixel(inner.x), FormatPixel(inner.y), FormatPixel(end), FormatPixel(inner.y),
        colour);
    out += fmt::format(
        R"(<line x1="{}" y1="{}" x2="{}" y2="{}" stroke="{}" stroke-width="1.2" stroke-dasharray="10 4"/>)",
        FormatPixel(inner.x), FormatPixel(inner.y), FormatPixel(end), FormatPixel(inner.y), colour);
    out += SvgMarker(Marker::kCircle, inner.x, inner.y, 4.2, style.colour, false) + "</g>";
  }
  out += DrawSupport(view, g, g.lateral_support, g.lateral_direction, item, colour);
  out += DrawSupport(view, g, g.longitudinal_support, g.longitudinal_direction, item, colour);
  if (IsDrawn(g.rod_outer) && IsDrawn(g.rod_inner)) {
    const Pixel a = view.Map(g.rod_outer);
    const Pixel b = view.Map(g.rod_inner);
    out += fmt::format(
        R"(<line class="rod body" data-d="{}" data-ox="{}" data-oy="{}" data-ix="{}" x1="{}" y1="{}" x2="{}" y2="{}" stroke="{}" stroke-width="3"/>)",
        item, FormatPixel(a.x), FormatPixel(a.y), FormatPixel(b.x), FormatPixel(a.x),
        FormatPixel(a.y), FormatPixel(b.x), FormatPixel(b.y), colour);
  }

  // The carrier: arms from the kingpin axis (or the centre of mass) to what is fixed to it.
  out += fmt::format(R"(<g class="carrier" data-d="{}">)", item);
  if (IsDrawn(g.wheel_centre) && g.wheel_radius > 0.0) {
    const Pixel c = view.Map(g.wheel_centre);
    const double w = view.scale * g.wheel_width;
    const double h = 2.0 * view.scale * g.wheel_radius;
    out += fmt::format(
        R"(<rect x="{}" y="{}" width="{}" height="{}" rx="{}" fill="{}" fill-opacity=".06" stroke="{}" stroke-width="1.4"{}/>)",
        FormatPixel(c.x - 0.5 * w), FormatPixel(c.y - 0.5 * h), FormatPixel(w), FormatPixel(h),
        FormatPixel(0.18 * w), colour, colour,
        style.dash.empty() ? std::string() : fmt::format(R"( stroke-dasharray="{}")", style.dash));
    out += SvgLine(c.x, c.y - 0.5 * h - 8, c.x, c.y + 0.5 * h + 8, "axisline");
  }
  const Point2 hub = IsDrawn(g.kingpin) ? g.kingpin : g.centre_of_mass;
  if (IsDrawn(hub)) {
    const Pixel k = view.Map(hub);
    for (const Point2& p :
         {g.wheel_centre, g.rod_outer, g.lateral_support, g.longitudinal_support}) {
      if (!IsDrawn(p)) continue;
      const Pixel a = view.Map(p);
      out += fmt::format(
          R"(<line class="body" x1="{}" y1="{}" x2="{}" y2="{}" stroke="{}" stroke-width="5" stroke-opacity=".28"/>)",
          FormatPixel(k.x), FormatPixel(k.y), FormatPixel(a.x), FormatPixel(a.y), colour);
    }
  }
  if (IsDrawn(g.centre_of_mass)) {
    const Pixel s = view.Map(g.centre_of_mass);
    out += fmt::format(
        R"(<circle cx="{0}" cy="{1}" r="5" fill="#fff" stroke="{4}"/><path d="M{0},{1}v-5a5,5 0 0 1 5,5zM{0},{1}v5a5,5 0 0 1 -5,-5z" fill="{4}"/>)",
        FormatPixel(s.x), FormatPixel(s.y), 0, 0, colour);
  }
  out += DrawDot(view, g.kingpin, Marker::kCircle, style.colour, true);
  out += DrawDot(view, g.rod_outer, Marker::kCircle, style.colour, false);
  out += DrawDot(view, g.lateral_support, Marker::kSquare, style.colour, true);
  out += DrawDot(view, g.longitudinal_support, Marker::kDiamond, style.colour, true);
  if (IsDrawn(g.force_point)) {
    const Pixel f = view.Map(g.force_point);
    out += fmt::format(
        R"svg(<path d="M{0},{1}v-42M{0},{1}l-5,-10h10z" transform="translate(0,-2)" stroke="{2}" stroke-width="2" fill="{2}"/>)svg",
        FormatPixel(f.x), FormatPixel(f.y), colour);
  }
  return out + "</g>\n";
}

std::string DrawDial(double cx, double cy, size_t item, const SeriesStyle& style) {
  const double r = kDialRadius - 7.0 * static_cast<double>(item);
  return fmt::format(
      R"(<g class="dial" data-d="{0}" data-cx="{1}" data-cy="{2}"><circle cx="{1}" cy="{2}" r="{3}" fill="none" stroke="{7}" stroke-width="3"/><path d="M{4},{2}H{5}M{1},{2}V{6}" stroke="{7}" stroke-width="2" fill="none"/></g>)",
      item, FormatPixel(cx), FormatPixel(cy), FormatPixel(r), FormatPixel(cx - r),
      FormatPixel(cx + r), FormatPixel(cy + r), EscapeHtml(style.colour));
}

double Interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const size_t n = std::min(x.size(), y.size());
  if (n == 0) return 0.0;
  const auto end = x.begin() + static_cast<long>(n);
  const size_t i = static_cast<size_t>(std::lower_bound(x.begin(), end, at) - x.begin());
  if (i == 0) return y[0];
  if (i >= n) return y[n - 1];
  const double step = x[i] - x[i - 1];
  const double s = step > 0.0 ? (at - x[i - 1]) / step : 0.0;
  return y[i - 1] + s * (y[i] - y[i - 1]);
}

std::string ListSamples(const CornerMotion& motion, const std::vector<double>& values,
                        const std::vector<double>& times, double resolution) {
  std::string out;
  for (const double t : times) {
    const double v = Interpolate(motion.time, values, t);
    if (!out.empty()) out += ',';
    out += std::isfinite(v) ? fmt::format("{:.6g}", resolution * std::round(v / resolution)) : "0";
  }
  return fmt::format("[{}]", out);
}

bool HasMotion(const GeometryItem& item) { return item.design->motion.time.size() > 1; }

}  // namespace

std::string DrawGeometry(const std::vector<GeometryItem>& items) {
  std::vector<Point2> outline;
  for (const GeometryItem& item : items) {
    const std::vector<Point2> points = CollectOutline(item.design->geometry);
    outline.insert(outline.end(), points.begin(), points.end());
  }
  if (outline.empty()) return {};
  Point2 low = outline[0];
  Point2 high = outline[0];
  for (const Point2& p : outline) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double across = std::max(high.y - low.y, 1e-3);
  const double along = std::max(high.x - low.x, 1e-3);
  const bool moving = std::any_of(items.begin(), items.end(), HasMotion);
  const double dial_space = moving ? 2.0 * kDialRadius + 40.0 : 0.0;
  View view;
  view.scale = std::min((kWidth - 2.0 * kMargin - dial_space) / across, 480.0 / along);
  view.x0 = kMargin + view.scale * high.y;
  view.y0 = kMargin + view.scale * high.x;
  const double height = 2.0 * kMargin + view.scale * along + 22.0;

  std::string svg = fmt::format(
      R"(<svg class="plot top" viewBox="0 0 {} {}" role="img" aria-label="Geometry seen from above, to scale">)",
      FormatPixel(kWidth), FormatPixel(height));
  for (size_t i = 0; i < items.size(); ++i) {
    // The rack ends before the steering wheel that is drawn beside it.
    svg += DrawCorner(view, *items[i].design, i, StyleOf(items[i].style), kWidth - dial_space);
  }
  LabelPlacer labels(0.0, 0.0, kWidth, height);
  for (const GeometryItem& item : items) {
    const CornerGeometry& g = item.design->geometry;
    for (const Point2& p : CollectOutline(g)) {
      const Pixel a = view.Map(p);
      labels.Reserve(a.x, a.y);
    }
    for (const auto& [at, direction] :
         {std::pair{g.lateral_support, g.lateral_direction},
          std::pair{g.longitudinal_support, g.longitudinal_direction}}) {
      if (!IsDrawn(at) || !std::isfinite(direction)) continue;
      const Pixel a = view.Map(at);
      const Pixel ground = MapGround(view, g, at, direction);
      for (const double s : {0.25, 0.5, 0.75, 1.0}) {
        labels.Reserve(a.x + s * (ground.x - a.x), a.y + s * (ground.y - a.y));
      }
    }
  }
  const CornerGeometry& last = items.back().design->geometry;
  if (moving) {
    labels.ReserveBox(kWidth - 2.0 * kDialRadius - 40.0, 0.0, kWidth, 2.0 * kDialRadius + 60.0);
  }
  const auto name = [&](const Point2& p, const char* text) {
    if (!IsDrawn(p)) return;
    const Pixel a = view.Map(p);
    labels.Add(a.x, a.y, text);
  };
  name(last.kingpin, "K kingpin axis");
  name(last.rod_outer, "tie-rod ball joint");
  name(last.rod_inner, "rack end");
  name(last.lateral_support, "L lateral");
  name(last.longitudinal_support, "N longitudinal");
  name(last.force_point, "road force");
  name(last.centre_of_mass, "S");
  svg += "<g class=\"names\">" + labels.Draw("halo b") + "</g>";

  // Scale and axes.
  const double bar = view.scale * 0.1;
  const double y = height - 16.0;
  svg += fmt::format(
      R"(<path class="ln" d="M{0},{2}v-5M{0},{3}H{1}M{1},{2}v-5" stroke="#1b1f24"/>)",
      FormatPixel(kMargin), FormatPixel(kMargin + bar), FormatPixel(y), FormatPixel(y - 2.5));
  svg += SvgText(kMargin + bar + 8.0, y + 1.0, "start", "100 mm");
  const double ax = kMargin + bar + 160.0;
  svg += fmt::format(
      R"(<path class="ln" d="M{0},{1}v-26m-4,8l4,-8l4,8M{0},{1}h-26m8,-4l-8,4l8,4" stroke="#1b1f24"/>)",
      FormatPixel(ax), FormatPixel(y));
  svg += SvgText(ax + 6.0, y - 20.0, "start", "x forward");
  svg += SvgText(ax - 32.0, y + 4.0, "end", "y left");
  if (moving) {
    const double cx = kWidth - kDialRadius - 20.0;
    const double cy = kDialRadius + 34.0;
    for (size_t i = 0; i < items.size(); ++i) {
      if (HasMotion(items[i])) svg += DrawDial(cx, cy, i, StyleOf(items[i].style));
    }
    svg += SvgText(cx, cy + kDialRadius + 16.0, "middle", "steering wheel", "at");
  }
  svg += "</svg>\n";

  std::vector<Series> legend;
  legend.reserve(items.size());
  for (const GeometryItem& item : items) {
    legend.push_back({.name = item.design->name, .style = StyleOf(item.style)});
  }
  const std::string caption =
      last.name.empty() ? "Seen from above, to scale"
                        : fmt::format("{}, seen from above, to scale", EscapeHtml(last.name));
  std::string out = fmt::format("<figure class=\"chart geo{}\"><figcaption>{}</figcaption>{}{}",
                                moving ? " moving" : "", caption, DrawLegend(legend, kWidth), svg);
  if (moving) {
    double start = std::numeric_limits<double>::infinity();
    double end = -start;
    double travel = 0.0;
    size_t samples = 2;
    for (const GeometryItem& item : items) {
      if (!HasMotion(item)) continue;
      const CornerMotion& m = item.design->motion;
      start = std::min(start, m.time.front());
      end = std::max(end, m.time.back());
      samples = std::max(samples, m.time.size());
      for (const double v : m.x) travel = std::fmax(travel, std::abs(v));
      for (const double v : m.y) travel = std::fmax(travel, std::abs(v));
    }
    samples = std::min(samples, kFrames);
    std::vector<double> times(samples);
    for (size_t k = 0; k < samples; ++k) {
      times[k] = start + (end - start) * static_cast<double>(k) / static_cast<double>(samples - 1);
    }
    // The largest displacement starts at about 50 pixels.
    const int gain =
        std::clamp(static_cast<int>(
                       travel > 0.0 && std::isfinite(travel) ? 50.0 / (travel * view.scale) : 10.0),
                   1, 50);
    out += fmt::format(
        "<div class=\"controls\"><button type=\"button\">Play</button><label>time "
        "<input class=\"time\" type=\"range\" min=\"0\" max=\"{}\" value=\"0\"></label>"
        "<label>magnification <input class=\"gain\" type=\"range\" min=\"1\" max=\"50\" "
        "value=\"{}\"></label>"
        "<output></output></div>",
        samples - 1, gain);
    LineChart plot;
    plot.title = "Steering wheel angle during the motion";
    plot.width = kWidth;
    plot.height = 150.0;
    plot.legend = false;
    plot.x = {.name = "Time", .unit = "s"};
    plot.y = {.name = "Wheel angle", .unit = "deg"};
    std::vector<std::string> designs;
    std::string force = "[]";
    for (const GeometryItem& item : items) {
      const CornerMotion& m = item.design->motion;
      const Pixel s = view.Map(IsDrawn(item.design->geometry.centre_of_mass)
                                   ? item.design->geometry.centre_of_mass
                                   : Point2{0.0, 0.0});
      designs.push_back(fmt::format(
          R"({{"centre":[{},{}],"x":{},"y":{},"psi":{},"rack":{},"wheel":{}}})", FormatPixel(s.x),
          FormatPixel(s.y), ListSamples(m, m.x, times, 1e-6), ListSamples(m, m.y, times, 1e-6),
          ListSamples(m, m.psi, times, 1e-6), ListSamples(m, m.rack, times, 1e-6),
          ListSamples(m, m.wheel_angle, times, 1e-5)));
      if (force == "[]" && !m.road_force.empty()) force = ListSamples(m, m.road_force, times, 1.0);
      Series angle;
      angle.name = item.design->name;
      angle.style = StyleOf(item.style);
      angle.x = m.time;
      for (const double v : m.wheel_angle) angle.y.push_back(v * 180.0 / std::numbers::pi);
      plot.series.push_back(std::move(angle));
    }
    std::string list;
    for (const double t : times) list += fmt::format("{}{:.5g}", list.empty() ? "" : ",", t);
    out += DrawLineChartSvg(plot);
    out += fmt::format(
        R"(<script type="application/json">{{"scale":{:.6g},"t":[{}],"force":{},"designs":[{}]}}</script>)",
        view.scale, list, force, fmt::join(designs, ","));
  }
  return out + "</figure>\n";
}

}  // namespace kingpin::report
