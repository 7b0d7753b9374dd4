#include <algorithm>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/scatter_chart.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {

void AddFurther(const Further& further, Page& page) {
  std::string charts;
  for (const ParetoFront& front : further.pareto) charts += DrawParetoChart(front, 540.0);
  if (further.rows.empty() && charts.empty() && further.text.empty()) return;
  page.AddHeading(2, "Further than the paper");
  page.AddParagraph(further.text);
  if (!further.rows.empty()) {
    Table table;
    std::vector<Cell> names = {TextCell("Case"), TextCell("Free"), TextCell("Without it")};
    std::vector<Cell> columns = {TextCell(""), TextCell(""), TextCell("")};
    const auto add_group = [&](const char* name, int span) {
      Cell cell = HtmlCell(name, "group c");
      cell.span = span;
      names.push_back(cell);
    };
    add_group("Kickback index <i>I</i><sub>V</sub>", 4);
    for (const char* text : {"start", "without it", "reached", "reached / without"}) {
      columns.push_back(TextCell(text, columns.size() == 3 ? "n group" : "n"));
    }
    if (!further.ratio_symbols.empty()) {
      add_group("Ratio to the start", static_cast<int>(further.ratio_symbols.size()));
      for (size_t i = 0; i < further.ratio_symbols.size(); ++i) {
        columns.push_back(HtmlCell(SymbolHtml(further.ratio_symbols[i]), i == 0 ? "n group" : "n"));
      }
    }
    add_group("Price", 1);
    columns.push_back(TextCell("road feel, ratio", "n group"));
    const bool notes = std::any_of(further.rows.begin(), further.rows.end(),
                                   [](const FurtherRow& r) { return !r.note.empty(); });
    if (notes) {
      names.push_back(TextCell("Remark"));
      columns.push_back(TextCell(""));
    }
    table.AddHeader(names);
    table.AddHeader(columns);
    for (const FurtherRow& r : further.rows) {
      std::vector<Cell> row = {TextCell(r.name, "b"),
                               TextCell(r.freedom),
                               TextCell(r.before),
                               NumberCell(r.objective_start),
                               NumberCell(r.objective_before),
                               NumberCell(r.objective),
                               RatioCell(r.objective / r.objective_before, Preference::kLower)};
      row[3].css += " group";
      row[5].css += " b";
      for (size_t i = 0; i < further.ratio_symbols.size(); ++i) {
        row.push_back(RatioCell(GetValue(r.ratios, i), Preference::kLower));
        if (i == 0) row.back().css += " group";
      }
      row.push_back(RatioCell(r.road_feel_ratio, Preference::kHigher));
      row.back().css += " group";
      if (notes) row.push_back(TextCell(r.note, "muted"));
      table.AddRow(row);
    }
    page.Add(table.MakeHtml());
  }
  if (!charts.empty()) page.Add("<div class=\"charts\">" + charts + "</div>\n");
  AddParetoNotes(further.pareto, page);
}

}  // namespace kingpin::report
