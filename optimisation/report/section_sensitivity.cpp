#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/bar_chart.h"
#include "optimisation/report/html.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

constexpr size_t kLargestBarCharts = 6;

double GetEntry(const Sensitivity& s, const std::string& variable, const std::string& measure) {
  const auto row = std::find(s.variables.begin(), s.variables.end(), variable);
  const auto column = std::find(s.measures.begin(), s.measures.end(), measure);
  if (row == s.variables.end() || column == s.measures.end()) return kMissing;
  const auto i = static_cast<size_t>(row - s.variables.begin());
  const auto j = static_cast<size_t>(column - s.measures.begin());
  return i < s.values.size() && j < s.values[i].size() ? s.values[i][j] : kMissing;
}

}  // namespace

void AddSensitivities(const Case& c, Page& page) {
  std::vector<const Sensitivity*> tables;
  for (const Sensitivity& s : c.sensitivities) {
    if (!s.values.empty() && !s.measures.empty()) tables.push_back(&s);
  }
  if (tables.empty()) return;
  page.AddHeading(3, "Sensitivities");
  const Sensitivity& first = *tables[0];
  page.AddParagraph(first.meaning);

  // One scale for all charts of the section, so that bars can be compared across measures.
  double limit = 0.0;
  for (const Sensitivity* s : tables) {
    for (const std::string& variable : first.variables) {
      for (size_t m = 0; m < std::min(first.measures.size(), kLargestBarCharts); ++m) {
        const double v = std::abs(GetEntry(*s, variable, first.measures[m]));
        if (std::isfinite(v)) limit = std::max(limit, v);
      }
    }
  }
  std::string charts;
  for (size_t m = 0; m < std::min(first.measures.size(), kLargestBarCharts); ++m) {
    BarChart chart;
    chart.title = first.measures[m];
    chart.axis_name = "Change";
    chart.unit = first.unit;
    chart.categories = first.variables;
    chart.limit = 1.05 * limit;
    for (size_t k = 0; k < tables.size(); ++k) {
      BarSeries bars;
      bars.name = tables[k]->design;
      bars.style = StyleOf(k);
      for (const std::string& variable : first.variables) {
        bars.values.push_back(GetEntry(*tables[k], variable, first.measures[m]));
      }
      chart.series.push_back(std::move(bars));
    }
    charts += DrawBarChart(chart);
  }
  std::string legend;
  for (size_t k = 0; k < tables.size(); ++k) {
    legend += fmt::format(
        "{}<span style=\"display:inline-block;width:22px;height:9px;background:{}\"></span> {}",
        k == 0 ? "" : " &#160; ", StyleOf(k).colour, EscapeHtml(tables[k]->design));
  }
  page.Add("<p class=\"meta\">" + legend + "</p>\n<div class=\"charts three\">" + charts +
           "</div>\n");

  for (const Sensitivity* s : tables) {
    Table table;
    std::vector<Cell> header = {HtmlCell(EscapeHtml(PrettyUnit(s->unit)), "muted")};
    for (const std::string& measure : s->measures)
      header.push_back(HtmlCell(SymbolHtml(measure), "n"));
    table.AddHeader(header);
    double largest = 0.0;
    for (const auto& row : s->values) {
      for (const double v : row) {
        if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
      }
    }
    for (size_t i = 0; i < s->variables.size(); ++i) {
      std::vector<Cell> row = {HtmlCell(SymbolHtml(s->variables[i]), "sym")};
      for (const std::string& measure : s->measures) {
        row.push_back(SignedCell(GetEntry(*s, s->variables[i], measure), largest));
      }
      table.AddRow(row);
    }
    page.Add(
        MakeDetails("All measures against all variables at “" + s->design + "”", table.MakeHtml()));
  }
}

}  // namespace kingpin::report
