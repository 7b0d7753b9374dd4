#pragma once

#include <string>
#include <vector>

#include "optimisation/report/study_report_data.h"

namespace kingpin::report {

struct Cell {
  std::string html;   ///< escaped already
  std::string css;    ///< classes: `n` right-aligned number, `b` bold, `muted`
  std::string style;  ///< inline: shading
  int span = 1;
};

Cell TextCell(std::string_view text, std::string_view css = "");
Cell HtmlCell(std::string html, std::string_view css = "");
Cell NumberCell(double value, int significant = 4);
/// Value / reference, shaded: blue where it is better, orange where it is worse, the stronger the
/// further from 1 (full shade at a factor of 2).
Cell RatioCell(double ratio, Preference preference);
/// Signed value, shaded by value / full_scale: orange positive, blue negative.
Cell SignedCell(double value, double full_scale, int significant = 3);

class Table {
 public:
  /// Header rows are printed again on each page.
  void AddHeader(std::vector<Cell> cells) { header_.push_back(std::move(cells)); }
  void AddRow(std::vector<Cell> cells, std::string css = "");
  bool empty() const { return rows_.empty(); }
  std::string MakeHtml(const std::string& css = "") const;

 private:
  struct Row {
    std::vector<Cell> cells;
    std::string css;
  };
  std::vector<std::vector<Cell>> header_;
  std::vector<Row> rows_;
};

}  // namespace kingpin::report
