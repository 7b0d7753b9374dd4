#include <cmath>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

/// A length is a coordinate, whose zero is arbitrary: its difference is given in its own unit.
Cell DifferenceCell(double paper, double ours, const std::string& unit) {
  if (!std::isfinite(paper) || !std::isfinite(ours)) return TextCell("–", "n");
  if (unit == "m" || unit == "mm" || paper == 0.0) {
    const std::string sign = ours > paper ? "+" : "";
    return HtmlCell(sign + FormatNumber(ours - paper, 3) + "\u00a0" + EscapeHtml(PrettyUnit(unit)),
                    "n");
  }
  const double difference = (ours - paper) / std::abs(paper);
  // One fifth off is full shade; the sign does not matter here.
  Cell cell = SignedCell(std::abs(difference), 0.2);
  cell.html = FormatChange(1.0 + difference);
  return cell;
}

}  // namespace

void AddComparisons(const std::vector<Comparison>& comparisons, int level, Page& page) {
  for (const Comparison& comparison : comparisons) {
    if (comparison.rows.empty()) continue;
    page.AddHeading(level, comparison.title);
    Table table;
    std::vector<Cell> names = {TextCell("Quantity"), TextCell(""), TextCell("Unit"),
                               TextCell("Paper", "n group")};
    std::vector<Cell> columns = {TextCell(""), TextCell(""), TextCell(""),
                                 TextCell("printed", "n group")};
    const bool notes = [&] {
      for (const ComparisonRow& row : comparison.rows) {
        if (!row.note.empty()) return true;
      }
      return false;
    }();
    for (const std::string& column : comparison.columns) {
      Cell cell = TextCell(column, "group c");
      cell.span = 2;
      names.push_back(cell);
      columns.push_back(TextCell("ours", "n group"));
      columns.push_back(TextCell("difference", "n"));
    }
    if (notes) {
      names.push_back(TextCell("Remark"));
      columns.push_back(TextCell(""));
    }
    table.AddHeader(names);
    table.AddHeader(columns);
    for (const ComparisonRow& r : comparison.rows) {
      const double paper = r.paper * r.unit.per_si;
      std::vector<double> shown = {paper};
      for (const double v : r.ours) shown.push_back(v * r.unit.per_si);
      const RowFormat format(shown, 5);
      std::vector<Cell> row = {HtmlCell(SymbolHtml(r.symbol), "sym"), TextCell(r.name),
                               TextCell(PrettyUnit(r.unit.text), "muted"),
                               HtmlCell(format.Format(paper), "n")};
      row.back().css += " group";
      for (size_t k = 0; k < comparison.columns.size(); ++k) {
        const double ours = GetValue(r.ours, k) * r.unit.per_si;
        row.push_back(HtmlCell(format.Format(ours), "n"));
        row.back().css += " group";
        row.push_back(DifferenceCell(paper, ours, r.unit.text));
      }
      if (notes) row.push_back(TextCell(r.note, "muted"));
      table.AddRow(row);
    }
    page.Add(table.MakeHtml());
    page.AddParagraph(comparison.note, "meta");
  }
}

}  // namespace kingpin::report
