#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/line_chart.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/scatter_chart.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

// An end this close to the best counts as the same optimum.
constexpr double kSame = 1e-3;

void AddStages(const Case& c, Page& page) {
  if (c.stages.empty()) return;
  const bool printed = std::any_of(c.stages.begin(), c.stages.end(),
                                   [](const Stage& s) { return std::isfinite(s.paper_seconds); });
  Table table;
  std::vector<Cell> header = {
      TextCell("Stage"),           TextCell("Algorithm"), TextCell("Free"),
      TextCell("Start", "n"),      TextCell("End", "n"),  TextCell("Simulations", "n"),
      TextCell("Iterations", "n"), TextCell("Time", "n")};
  if (printed) header.push_back(TextCell("Printed time", "n"));
  header.push_back(TextCell("Why it stopped"));
  table.AddHeader(header);
  for (const Stage& s : c.stages) {
    std::vector<Cell> row = {TextCell(s.name, "b"),
                             TextCell(s.algorithm),
                             TextCell(s.free),
                             NumberCell(s.start),
                             NumberCell(s.end),
                             HtmlCell(FormatCount(s.evaluations), "n"),
                             HtmlCell(FormatCount(s.iterations), "n"),
                             HtmlCell(FormatDuration(s.seconds), "n")};
    if (printed) row.push_back(HtmlCell(FormatDuration(s.paper_seconds), "n"));
    row.push_back(TextCell(s.status, "muted"));
    table.AddRow(row);
  }
  page.Add(table.MakeHtml());
}

void AddActiveConstraints(const Case& c, Page& page) {
  if (c.active.empty()) return;
  page.AddHeading(4, "What holds the optimum back");
  Table table;
  table.AddHeader({TextCell("Design"), TextCell("Bound or constraint"), TextCell("Value", "n"),
                   TextCell("Limit", "n"), TextCell("Unit"), TextCell("What it costs")});
  for (const ActiveConstraint& a : c.active) {
    table.AddRow({TextCell(a.design), TextCell(a.name), NumberCell(a.value * a.unit.per_si, 5),
                  NumberCell(a.limit * a.unit.per_si, 5),
                  TextCell(PrettyUnit(a.unit.text), "muted"), TextCell(a.effect)});
  }
  page.Add(table.MakeHtml());
}

std::string DrawConvergence(const Case& c) {
  LineChart chart;
  chart.title = "Best value so far";
  chart.height = 310.0;
  chart.x = {.name = "Simulations", .scale = Scale::kLog};
  chart.y = {.name = "Objective"};
  for (const Convergence& h : c.convergence) {
    if (h.evaluations.empty()) continue;
    chart.series.push_back({.name = h.name,
                            .x = h.evaluations,
                            .y = h.best,
                            .style = StyleOf(chart.series.size() + 1),
                            .steps = true});
  }
  return chart.series.empty() ? std::string() : DrawLineChart(chart);
}

struct RestartFacts {
  double best = kMissing;
  size_t finished = 0;
  size_t same = 0;
};

RestartFacts CalcRestartFacts(const Restarts& r) {
  RestartFacts facts;
  for (const double v : r.end_values) {
    if (!std::isfinite(v)) continue;
    ++facts.finished;
    facts.best = std::fmin(facts.best, v);
  }
  for (const double v : r.end_values) {
    if (std::isfinite(v) && v - facts.best <= kSame * std::abs(facts.best)) ++facts.same;
  }
  return facts;
}

std::string DrawRestarts(const Case& c) {
  LineChart chart;
  chart.title = "Where independent starts end";
  chart.height = 310.0;
  chart.hover = false;
  chart.x = {.name = "Run, sorted by its end", .include_zero = true};
  chart.y = {.name = "Objective at the end"};
  for (const Restarts& r : c.restarts) {
    if (r.end_values.empty()) continue;
    Series s = {
        .name = r.name, .style = StyleOf(chart.series.size() + 1), .line = false, .markers = true};
    std::vector<double> sorted;
    std::copy_if(r.end_values.begin(), r.end_values.end(), std::back_inserter(sorted),
                 [](double v) { return std::isfinite(v); });
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 0; i < sorted.size(); ++i) {
      s.x.push_back(static_cast<double>(i + 1));
      s.y.push_back(sorted[i]);
    }
    chart.series.push_back(std::move(s));
  }
  return chart.series.empty() ? std::string() : DrawLineChart(chart);
}

void AddUniqueness(const Case& c, Page& page) {
  if (c.restarts.empty()) return;
  page.AddHeading(4, "How unique the optimum is");
  for (const Restarts& r : c.restarts) {
    const RestartFacts facts = CalcRestartFacts(r);
    if (facts.finished == 0) continue;
    double worst = facts.best;
    for (const double v : r.end_values) worst = std::isfinite(v) ? std::max(worst, v) : worst;
    page.AddParagraph(fmt::format(
        "{}: {} of {} runs end within {:.1f} % of the best value {}; the worst ends at {}.", r.name,
        facts.same, r.end_values.size(), 100.0 * kSame, FormatNumber(facts.best),
        FormatNumber(worst)));
    page.AddParagraph(r.note, "meta");
    if (r.end_designs.empty() || c.variables.empty()) continue;
    Table table;
    table.AddHeader({TextCell("Variable"), TextCell("Unit"), TextCell("best run", "n group"),
                     TextCell("lowest among equals", "n"), TextCell("highest among equals", "n"),
                     TextCell("lowest of all", "n group"), TextCell("highest of all", "n")});
    for (size_t i = 0; i < c.variables.size(); ++i) {
      const Variable& v = c.variables[i];
      if (v.locked) continue;
      double best = kMissing;
      double same[2] = {kMissing, kMissing};
      double all[2] = {kMissing, kMissing};
      for (size_t k = 0; k < std::min(r.end_designs.size(), r.end_values.size()); ++k) {
        const double value = GetValue(r.end_designs[k], i) * v.unit.per_si;
        if (!std::isfinite(r.end_values[k]) || !std::isfinite(value)) continue;
        all[0] = std::fmin(all[0], value);
        all[1] = std::fmax(all[1], value);
        if (r.end_values[k] - facts.best > kSame * std::abs(facts.best)) continue;
        same[0] = std::fmin(same[0], value);
        same[1] = std::fmax(same[1], value);
        if (r.end_values[k] == facts.best) best = value;
      }
      if (std::isnan(all[0])) continue;  // the stage did not free it
      std::vector<Cell> row = {HtmlCell(SymbolHtml(v.symbol), "sym"),
                               TextCell(PrettyUnit(v.unit.text), "muted"),
                               NumberCell(best, 5),
                               NumberCell(same[0], 5),
                               NumberCell(same[1], 5),
                               NumberCell(all[0], 5),
                               NumberCell(all[1], 5)};
      row[2].css += " group";
      row[5].css += " group";
      table.AddRow(row);
    }
    page.Add(MakeDetails(r.name + ": designs at the ends", table.MakeHtml()));
  }
}

}  // namespace

void AddSearch(const Case& c, Page& page) {
  const std::string charts = DrawConvergence(c) + DrawRestarts(c);
  if (c.stages.empty() && c.active.empty() && charts.empty()) return;
  page.AddHeading(3, "Search");
  AddStages(c, page);
  if (!charts.empty()) page.Add("<div class=\"charts\">" + charts + "</div>\n");
  AddUniqueness(c, page);
  AddActiveConstraints(c, page);
}

void AddParetoFronts(const Case& c, Page& page) {
  std::string charts;
  for (const ParetoFront& front : c.pareto) {
    if (front.front.empty() && front.marked.empty() && front.dominated.empty()) continue;
    charts += DrawParetoChart(front, 540.0);
  }
  if (charts.empty()) return;
  page.AddHeading(3, "Kickback against road feel");
  page.Add("<div class=\"charts\">" + charts + "</div>\n");
  AddParetoNotes(c.pareto, page);
}

void AddParetoNotes(const std::vector<ParetoFront>& fronts, Page& page) {
  std::set<std::string> seen;
  for (const ParetoFront& front : fronts) {
    if (seen.insert(front.note).second) page.AddParagraph(front.note);
  }
}

}  // namespace kingpin::report
