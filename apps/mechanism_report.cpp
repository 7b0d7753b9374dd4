#include "apps/mechanism_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "optimisation/report/bode_chart.h"
#include "optimisation/report/html.h"
#include "optimisation/report/line_chart.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/page.h"
#include "optimisation/report/table.h"

namespace kingpin::apps {

namespace {

using joints::MechanismRun;
using report::LineChart;
using report::Series;

constexpr size_t kLinesPerChart = 5;
constexpr size_t kMostCharts = 12;
constexpr size_t kMostRowsOfSwitches = 40;
constexpr double kLeastResidual = 1e-18;

const io::Signals::Channel* FindChannel(const MechanismRun& run, const std::string& name) {
  for (const auto& channel : run.signals.channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

report::SeriesStyle MakeStyle(size_t line) {
  // 0 is the pale line of a reference design, which does not exist here
  report::SeriesStyle style = report::StyleOf(line + 1);
  style.marker = report::Marker::kNone;
  return style;
}

LineChart MakeChart(const std::string& title, const std::string& name, const std::string& unit) {
  LineChart chart;
  chart.title = title;
  chart.height = 260;
  chart.x = {.name = "Time", .unit = "s"};
  chart.y = {.name = name, .unit = unit == "1" ? "" : unit};
  return chart;
}

void AddLine(const MechanismRun& run, const io::Signals::Channel& channel, const std::string& name,
             LineChart& chart) {
  Series series = {.name = name, .x = run.signals.time, .y = channel.values};
  series.style = MakeStyle(chart.series.size());
  chart.series.push_back(std::move(series));
}

// A constant line has no shape worth an axis of its own rounding.
bool IsStill(const io::Signals::Channel& channel) {
  const auto [low, high] = std::minmax_element(channel.values.begin(), channel.values.end());
  return channel.values.empty() ||
         *high - *low <= 1e-12 * std::max(std::abs(*high), std::abs(*low));
}

// Charts of the channels NAME + suffix, five of one unit in each.
void AddCharts(const MechanismRun& run, const std::string& heading,
               const std::vector<std::string>& names, const std::string& suffix,
               const std::map<std::string, std::string>& axis_names, report::Page& page) {
  std::vector<std::string> units;
  std::map<std::string, std::vector<std::string>> by_unit;
  std::vector<std::string> still;
  for (const std::string& name : names) {
    const io::Signals::Channel* channel = FindChannel(run, name + suffix);
    if (channel == nullptr) continue;
    if (IsStill(*channel)) {
      const double value = channel->values.empty() ? 0.0 : channel->values.front();
      still.push_back(fmt::format("{} ({}{})", name, report::FormatShort(value, 4),
                                  channel->unit == "1" ? "" : " " + channel->unit));
      continue;
    }
    if (by_unit[channel->unit].empty()) units.push_back(channel->unit);
    by_unit[channel->unit].push_back(name);
  }
  std::string charts;
  size_t count = 0, left_out = 0;
  for (const std::string& unit : units) {
    const std::vector<std::string>& group = by_unit[unit];
    // evenly filled charts rather than a last one with a single line
    const size_t parts = (group.size() + kLinesPerChart - 1) / kLinesPerChart;
    for (size_t part = 0; part < parts; ++part) {
      const size_t begin = part * group.size() / parts, end = (part + 1) * group.size() / parts;
      if (count == kMostCharts) {
        left_out += end - begin;
        continue;
      }
      ++count;
      const auto axis = axis_names.find(unit);
      const std::string axis_name = axis == axis_names.end() ? heading : axis->second;
      std::string title;
      for (size_t i = begin; i < end; ++i) title += (i > begin ? ", " : "") + group[i];
      LineChart chart = MakeChart(title, axis_name, unit);
      for (size_t i = begin; i < end; ++i) {
        AddLine(run, *FindChannel(run, group[i] + suffix), group[i], chart);
      }
      chart.legend = chart.series.size() > 1;
      charts += report::DrawLineChart(chart);
    }
  }
  if (charts.empty() && still.empty()) return;
  page.AddHeading(2, heading);
  if (!charts.empty()) page.Add("<div class=\"charts\">" + charts + "</div>\n");
  if (!still.empty()) {
    page.AddParagraph(fmt::format("Constant throughout: {}.", fmt::join(still, ", ")));
  }
  if (left_out > 0) {
    page.AddParagraph(fmt::format(
        "{} more are in signals.csv; the section report of the mechanism file chooses.", left_out));
  }
}

report::Cell Number(double value, int significant = 4) {
  return report::NumberCell(value, significant);
}

void AddSummaryTable(const MechanismRun& run, report::Page& page) {
  const auto& s = run.summary;
  report::Table table;
  table.AddHeader(
      {report::TextCell("Quantity"), report::TextCell("Value", "n"), report::TextCell("Unit")});
  const auto row = [&table](const char* name, report::Cell value, const char* unit) {
    table.AddRow({report::TextCell(name), std::move(value), report::TextCell(unit, "muted")});
  };
  const auto count = [](const nlohmann::ordered_json& value) {
    return report::HtmlCell(report::FormatCount(value.get<long>()), "n");
  };
  const auto& energy = s["energy"];
  row("Degrees of freedom", count(s["degrees_of_freedom"]), "");
  row("Coordinates", count(s["coordinates"]), "");
  row("Constraint rows", count(s["constraint_rows"]), "");
  std::string redundant;
  for (const auto& name : s["redundant_rows"]) {
    redundant += (redundant.empty() ? "" : ", ") + name.get<std::string>();
  }
  row("Redundant rows, their reactions taken as zero",
      report::TextCell(redundant.empty() ? "none" : redundant, "n"), "");
  row("Largest residual of the constraints, position",
      Number(s["largest_residual"]["position"].get<double>(), 2), "m or rad");
  row("Largest residual of the constraints, velocity",
      Number(s["largest_residual"]["velocity"].get<double>(), 2), "m/s or rad/s");
  row("Energy at the start", Number(energy["start"].get<double>(), 6), "J");
  row("Energy at the end", Number(energy["end"].get<double>(), 6), "J");
  row("Supplied by motors, forces and motions", Number(energy["supplied"].get<double>(), 6), "J");
  row("Dissipated", Number(energy["dissipated"].get<double>(), 6), "J");
  row("Largest error of the energy balance", Number(energy["largest_error"].get<double>(), 2), "J");
  row("Largest kinetic energy, to judge it by", Number(energy["largest_kinetic"].get<double>(), 4),
      "J");
  row("Largest error of the balance of momentum",
      Number(s["momentum"]["largest_error"].get<double>(), 2), "N s");
  row("Largest error of the balance of angular momentum",
      Number(s["angular_momentum"]["largest_error"].get<double>(), 2), "N m s");
  row("Switches of dry friction", count(s["friction_switches"]), "");
  page.Add(table.MakeHtml());
}

void AddStops(const MechanismRun& run, report::Page& page) {
  const auto stops = run.summary.find("stops");
  if (stops == run.summary.end()) return;
  page.AddHeading(2, "Stops");
  report::Table table;
  table.AddHeader({report::TextCell("Stop"), report::TextCell("Contacts", "n"),
                   report::TextCell("First [s]", "n"), report::TextCell("Deepest", "n"),
                   report::TextCell("Unit")});
  for (const auto& [name, stop] : stops->items()) {
    const bool touched = stop["contacts"].get<int>() > 0;
    table.AddRow(
        {report::TextCell(name),
         report::HtmlCell(report::FormatCount(stop["contacts"].get<long>()), "n"),
         Number(touched ? stop["first"].get<double>() : std::numeric_limits<double>::quiet_NaN()),
         Number(stop["deepest"].get<double>(), 3),
         report::TextCell(stop["unit"].get<std::string>(), "muted")});
  }
  page.Add(table.MakeHtml());
}

void AddFriction(const MechanismRun& run, report::Page& page) {
  if (run.friction_changes.empty()) return;
  page.AddHeading(2, "Dry friction");
  report::Table table;
  table.AddHeader(
      {report::TextCell("Time [s]", "n"), report::TextCell("Where"), report::TextCell("Then")});
  size_t shown = 0;
  for (const MechanismRun::FrictionChange& change : run.friction_changes) {
    if (shown++ == kMostRowsOfSwitches) break;
    table.AddRow({report::HtmlCell(report::FormatFixed(change.time, 6), "n"),
                  report::TextCell(change.name),
                  report::TextCell(change.mode == 0  ? "sticks"
                                   : change.mode > 0 ? "slides forwards"
                                                     : "slides backwards")});
  }
  page.Add(table.MakeHtml());
  if (run.friction_changes.size() > kMostRowsOfSwitches) {
    page.AddParagraph(
        fmt::format("The first {} of {}.", kMostRowsOfSwitches, run.friction_changes.size()));
  }
}

std::string DrawMomentum(const MechanismRun& run, const char* title, const char* name,
                         const char* quantity, const char* unit) {
  LineChart chart = MakeChart(title, name, unit);
  for (const char* axis : {"x", "y", "z"}) {
    AddLine(run, *FindChannel(run, fmt::format("{}.{}", quantity, axis)), axis, chart);
  }
  return report::DrawLineChart(chart);
}

void AddBooks(const MechanismRun& run, report::Page& page) {
  page.AddHeading(2, "Energy, momentum and residuals");
  LineChart energies = MakeChart("Energies", "Energy", "J");
  for (const char* part : {"kinetic", "potential", "total", "dissipated", "supplied"}) {
    const io::Signals::Channel* channel = FindChannel(run, fmt::format("energy.{}", part));
    const bool zero = std::all_of(channel->values.begin(), channel->values.end(),
                                  [](double value) { return value == 0; });
    if (!zero) AddLine(run, *channel, part, energies);
  }
  LineChart balance = MakeChart("Balance: total − start − supplied + dissipated", "Balance", "J");
  AddLine(run, *FindChannel(run, "energy.balance"), "balance", balance);
  balance.legend = false;
  std::string charts = report::DrawLineChart(energies) + report::DrawLineChart(balance) +
                       DrawMomentum(run, "Momentum", "Momentum", "momentum", "N s") +
                       DrawMomentum(run, "Angular momentum about the world's origin",
                                    "Angular momentum", "angular_momentum", "N m s");
  if (run.rows > 0) {
    LineChart residuals = MakeChart("Largest residuals of the constraints", "Residual", "");
    residuals.y.scale = report::Scale::kLog;
    AddLine(run, *FindChannel(run, "residual.position"), "position [m or rad]", residuals);
    AddLine(run, *FindChannel(run, "residual.velocity"), "velocity [m/s or rad/s]", residuals);
    // zero has no logarithm, and what is far below rounding says nothing
    for (Series& series : residuals.series) {
      for (double& value : series.y) value = std::max(value, kLeastResidual);
    }
    charts += report::DrawLineChart(residuals);
  }
  page.Add("<div class=\"charts\">" + charts + "</div>\n");
}

}  // namespace

std::string MakeMechanismReport(const joints::MechanismRun& run) {
  report::Page page;
  const std::string name = run.summary["name"].get<std::string>();
  page.Add("<h1>" + report::EscapeHtml(name) + "</h1>\n");
  page.AddParagraph(fmt::format(
      "{} s by {}.", report::FormatShort(run.signals.time.empty() ? 0.0 : run.signals.time.back()),
      run.summary["method"].get<std::string>()));
  if (!run.finished) {
    page.AddParagraph(run.failure.empty() ? "The run was stopped before its end."
                                          : "The run ended early: " + run.failure);
  }
  page.AddHeading(2, "Summary");
  AddSummaryTable(run, page);
  // what belongs to the coordinates shown: rates have the names of velocity coordinates
  std::vector<std::string> rates;
  for (int i = 0; i < run.velocities; ++i) {
    const std::string& channel = run.signals.channels[run.positions + i].name;
    const std::string coordinate = channel.substr(0, channel.size() - std::string(".rate").size());
    const std::string joint = coordinate.substr(0, coordinate.find_last_of('.'));
    for (const std::string& shown : run.shown_coordinates) {
      const bool turns_with_it = shown.starts_with(joint + ".quaternion");
      if (shown == coordinate ||
          (turns_with_it && coordinate.find(".angular_") != std::string::npos)) {
        rates.push_back(coordinate);
        break;
      }
    }
  }
  AddCharts(run, "Coordinates", run.shown_coordinates, "",
            {{"rad", "Angle"}, {"m", "Displacement"}, {"1", "Quaternion"}}, page);
  AddCharts(run, "Rates", rates, ".rate", {{"rad/s", "Angular velocity"}, {"m/s", "Velocity"}},
            page);
  AddBooks(run, page);
  AddCharts(run, "Reactions", run.shown_reactions, ".reaction", {{"N", "Force"}, {"N m", "Torque"}},
            page);
  AddFriction(run, page);
  AddStops(run, page);
  return page.MakeDocument(name);
}

std::string MakeModesReport(const joints::MechanismModes& modes) {
  report::Page page;
  const std::string name = modes.json["name"].get<std::string>();
  page.Add("<h1>" + report::EscapeHtml(name) + "</h1>\n");
  page.AddHeading(2, "Modes");
  report::Table table;
  table.AddHeader({report::TextCell("Frequency [Hz]", "n"), report::TextCell("Damping", "n"),
                   report::TextCell("Eigenvalue [1/s]", "n"), report::TextCell("Largest motions")});
  for (const auto& mode : modes.json["modes"]) {
    std::vector<std::pair<double, std::string>> parts;
    for (const auto& [coordinate, value] : mode["shape"].items()) {
      parts.emplace_back(std::hypot(value[0].get<double>(), value[1].get<double>()), coordinate);
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string largest;
    for (size_t i = 0; i < parts.size() && i < 4 && parts[i].first > 0.05; ++i) {
      largest += fmt::format("{}{} ({})", i > 0 ? ", " : "", parts[i].second,
                             report::FormatShort(parts[i].first, 2));
    }
    const double real = mode["eigenvalue"][0].get<double>(),
                 imaginary = mode["eigenvalue"][1].get<double>();
    std::string eigenvalue = report::FormatNumber(real, 5);
    if (imaginary != 0) eigenvalue += " ± " + report::FormatNumber(imaginary, 5) + " i";
    table.AddRow({Number(mode["frequency_hz"].get<double>(), 5),
                  Number(mode["damping_ratio"].get<double>(), 4), report::TextCell(eigenvalue, "n"),
                  report::TextCell(largest, "muted")});
  }
  page.Add(table.MakeHtml());
  std::string charts;
  for (const joints::ResponseCurve& curve : modes.responses) {
    report::BodeChart chart;
    chart.title = fmt::format("{}: {} to {}", curve.name, curve.input, curve.output);
    chart.unit = curve.unit;
    chart.series.push_back({.name = curve.name,
                            .frequency_hz = curve.frequency,
                            .response = curve.values,
                            .style = MakeStyle(0)});
    charts += report::DrawBodeChart(chart);
  }
  if (!charts.empty()) {
    page.AddHeading(2, "Frequency responses");
    page.Add("<div class=\"charts\">" + charts + "</div>\n");
  }
  return page.MakeDocument(name);
}

}  // namespace kingpin::apps
