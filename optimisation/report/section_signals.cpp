#include <algorithm>
#include <cmath>

#include "optimisation/report/bode_chart.h"
#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/line_chart.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

std::vector<double> Scaled(const std::vector<double>& values, const DisplayUnit& unit) {
  std::vector<double> out = values;
  for (double& v : out) v *= unit.per_si;
  return out;
}

/// The legend above a group of charts: every plotted design once.
std::string MakeDesignLegend(const Case& c) {
  std::vector<Series> series;
  for (size_t d = 0; d < c.designs.size(); ++d) {
    if (c.designs[d].plotted) series.push_back({.name = c.designs[d].name, .style = StyleOf(d)});
  }
  return DrawLegend(series, 1100.0);
}

}  // namespace

void AddHistories(const Case& c, Page& page) {
  std::string charts;
  for (size_t k = 0; k < c.channels.size(); ++k) {
    const Channel& channel = c.channels[k];
    LineChart chart;
    chart.title = channel.name;
    chart.height = 260.0;
    chart.legend = false;
    chart.x = {.name = "Time", .unit = "s"};
    chart.y = {.name = channel.name, .unit = channel.unit.text};
    for (size_t d = 0; d < c.designs.size(); ++d) {
      const Design& design = c.designs[d];
      if (!design.plotted || k >= design.histories.size() || design.histories[k].empty()) continue;
      Series s = {.name = channel.common ? "all designs" : design.name,
                  .x = design.time,
                  .y = Scaled(design.histories[k], channel.unit),
                  .style = StyleOf(d)};
      if (channel.common) s.style = {"#1b1f24", "", 1.4, Marker::kNone};
      chart.series.push_back(std::move(s));
      if (channel.common) break;
    }
    if (!chart.series.empty()) charts += DrawLineChart(chart);
  }
  if (charts.empty()) return;
  page.AddHeading(3, "Histories");
  page.Add(MakeDesignLegend(c));
  page.Add("<div class=\"charts\">" + charts + "</div>\n");
}

void AddSpectra(const Case& c, Page& page) {
  LineChart chart;
  chart.title = c.spectrum_name;
  chart.width = 1100.0;
  chart.height = 330.0;
  chart.x = {.name = "Frequency", .unit = "Hz", .max = c.spectrum_max_hz};
  chart.y = {.name = "Amplitude", .unit = c.spectrum_unit.text, .include_zero = true};
  chart.right = {.name = "Weighting", .include_zero = true};
  for (size_t d = 0; d < c.designs.size(); ++d) {
    const Design& design = c.designs[d];
    if (!design.plotted || design.spectrum.x.empty()) continue;
    chart.series.push_back({.name = design.name,
                            .x = design.spectrum.x,
                            .y = Scaled(design.spectrum.y, c.spectrum_unit),
                            .style = StyleOf(d)});
  }
  if (chart.series.empty()) return;
  if (!c.weighting.x.empty()) {
    chart.series.push_back(
        {.name = (c.weighting_name.empty() ? "weighting" : "weighting " + c.weighting_name) +
                 " (right axis)",
         .x = c.weighting.x,
         .y = c.weighting.y,
         .style = {"#1b1f24", "1.5 3", 1.3, Marker::kNone},
         .secondary = true});
  }
  page.AddHeading(3, "Spectra");
  page.Add(DrawLineChart(chart));
}

void AddFrequencyResponses(const Case& c, Page& page) {
  std::string charts;
  for (size_t k = 0; k < c.responses.size(); ++k) {
    BodeChart chart;
    chart.title = c.responses[k].name;
    chart.unit = c.responses[k].unit.text;
    for (size_t d = 0; d < c.designs.size(); ++d) {
      const Design& design = c.designs[d];
      if (!design.plotted || k >= design.frequency_responses.size()) continue;
      BodeSeries s = {.name = design.name,
                      .frequency_hz = design.response_frequency,
                      .response = design.frequency_responses[k],
                      .style = StyleOf(d)};
      for (std::complex<double>& h : s.response) h *= c.responses[k].unit.per_si;
      if (!s.response.empty()) chart.series.push_back(std::move(s));
    }
    if (!chart.series.empty()) charts += DrawBodeChart(chart);
  }
  if (charts.empty()) return;
  page.AddHeading(3, "Frequency responses");
  page.Add("<div class=\"charts\">" + charts + "</div>\n");
}

void AddModes(const std::vector<Measure>& measures, const Case& c, Page& page) {
  // Initial and best design; the stages between would make the table unreadable.
  const std::optional<size_t> chosen = FindChosenDesign(measures, c);
  if (!chosen) return;
  std::vector<const Design*> designs = {&c.designs[0]};
  if (*chosen != 0) designs.push_back(&c.designs[*chosen]);
  std::erase_if(designs, [](const Design* d) { return d->modes.empty(); });
  size_t rows = 0;
  for (const Design* d : designs) rows = std::max(rows, d->modes.size());
  if (rows == 0) return;
  page.AddHeading(3, "Modes");
  Table table;
  std::vector<Cell> names = {TextCell("No.", "n")};
  std::vector<Cell> columns = {TextCell("")};
  for (const Design* d : designs) {
    Cell cell = TextCell(d->name, "group c");
    cell.span = 3;
    names.push_back(cell);
    columns.push_back(TextCell("f [Hz]", "n group"));
    columns.push_back(TextCell("damping [%]", "n"));
    columns.push_back(TextCell("dominant coordinates"));
  }
  table.AddHeader(names);
  table.AddHeader(columns);
  for (size_t i = 0; i < rows; ++i) {
    std::vector<Cell> row = {HtmlCell(std::to_string(i + 1), "n")};
    for (const Design* d : designs) {
      const Mode mode = i < d->modes.size() ? d->modes[i] : Mode{};
      row.push_back(NumberCell(mode.frequency_hz, 4));
      row.back().css += " group";
      row.push_back(NumberCell(100.0 * mode.damping_ratio, 3));
      row.push_back(TextCell(mode.shape, "muted"));
    }
    table.AddRow(row);
  }
  page.Add(table.MakeHtml());
}

namespace {

/// y of a curve at x, straight between its points; NaN outside.
double Interpolate(const Curve& curve, double x) {
  const size_t n = std::min(curve.x.size(), curve.y.size());
  for (size_t i = 1; i < n; ++i) {
    if (x < curve.x[i - 1] || x > curve.x[i]) continue;
    const double step = curve.x[i] - curve.x[i - 1];
    const double share = step > 0.0 ? (x - curve.x[i - 1]) / step : 0.0;
    return curve.y[i - 1] + share * (curve.y[i] - curve.y[i - 1]);
  }
  return kMissing;
}

Curve Minus(Curve curve, const Curve& reference) {
  for (size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
    curve.y[i] -= Interpolate(reference, curve.x[i]);
  }
  return curve;
}

/// The chart of one characteristic: all designs, or all but the first as differences from it.
LineChart MakeCharacteristicChart(const Case& c, size_t k, bool difference) {
  const Characteristic& info = c.characteristics[k];
  LineChart chart;
  chart.title = difference ? info.name + ": change from " + c.designs[0].name : info.name;
  chart.height = difference ? 240.0 : 330.0;
  chart.legend = !difference;
  chart.x = {.name = info.x_name, .unit = info.x_unit.text};
  chart.y = {.name = difference ? "Change" : info.y_name, .unit = info.y_unit.text};
  Curve reference;
  if (difference) {
    if (k >= c.designs[0].characteristics.size()) return chart;
    reference = c.designs[0].characteristics[k].curve;
    if (reference.x.empty()) return chart;
  }
  const auto shown = [&](const Curve& curve) {
    Curve out = difference ? Minus(curve, reference) : curve;
    return Curve{Scaled(out.x, info.x_unit), Scaled(out.y, info.y_unit)};
  };
  if (!info.lower.x.empty() && info.lower.x.size() == info.upper.x.size()) {
    const Curve lower = shown(info.lower);
    chart.bands.push_back({"bounds", lower.x, lower.y, shown(info.upper).y});
  }
  for (size_t d = difference ? 1 : 0; d < c.designs.size(); ++d) {
    const Design& design = c.designs[d];
    if (!design.plotted || k >= design.characteristics.size()) continue;
    const CharacteristicCurve& curve = design.characteristics[k];
    if (!curve.curve.x.empty()) {
      Curve line = shown(curve.curve);
      chart.series.push_back({.name = design.name,
                              .x = std::move(line.x),
                              .y = std::move(line.y),
                              .style = StyleOf(d)});
    }
    if (!curve.nodes.x.empty()) {
      Curve nodes = shown(curve.nodes);
      chart.series.push_back({.name = "",
                              .x = std::move(nodes.x),
                              .y = std::move(nodes.y),
                              .style = StyleOf(d),
                              .line = false,
                              .markers = true,
                              .filled = false});
    }
  }
  return chart;
}

}  // namespace

void AddCharacteristics(const Case& c, Page& page) {
  if (c.designs.empty()) return;
  std::string charts;
  std::string changes;
  for (size_t k = 0; k < c.characteristics.size(); ++k) {
    const LineChart chart = MakeCharacteristicChart(c, k, false);
    if (!chart.series.empty()) charts += DrawLineChart(chart);
    const LineChart change = MakeCharacteristicChart(c, k, true);
    if (!change.series.empty()) changes += DrawLineChart(change);
  }
  if (charts.empty()) return;
  page.AddHeading(3, "Characteristics");
  page.Add("<div class=\"charts\">" + charts + changes + "</div>\n");
}

}  // namespace kingpin::report
