#include <algorithm>
#include <cmath>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/geometry_view.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {

void AddGeometry(const std::vector<Measure>& measures, const Case& c, Page& page) {
  const std::optional<size_t> chosen = FindChosenDesign(measures, c);
  if (!chosen) return;
  std::vector<GeometryItem> items = {{&c.designs[0], 0}};
  if (*chosen != 0) items.push_back({&c.designs[*chosen], *chosen});
  const std::string figure = DrawGeometry(items);
  if (figure.empty()) return;
  page.AddHeading(3, "Geometry");
  page.Add(figure);

  Table table;
  std::vector<Cell> names = {TextCell("Point")};
  std::vector<Cell> columns = {TextCell("")};
  for (const GeometryItem& item : items) {
    Cell cell = TextCell(item.design->name, "group c");
    cell.span = 2;
    names.push_back(cell);
    columns.push_back(TextCell("x [mm]", "n group"));
    columns.push_back(TextCell("y [mm]", "n"));
  }
  if (items.size() > 1) {
    names.push_back(TextCell("Shift", "n group"));
    columns.push_back(TextCell("[mm]", "n group"));
  }
  table.AddHeader(names);
  table.AddHeader(columns);
  const auto add = [&](const char* name, Point2 CornerGeometry::*member) {
    std::vector<Cell> row = {TextCell(name)};
    bool any = false;
    for (const GeometryItem& item : items) {
      const Point2 p = item.design->geometry.*member;
      any = any || std::isfinite(p.x);
      row.push_back(HtmlCell(FormatFixed(1e3 * p.x, 1), "n"));
      row.back().css += " group";
      row.push_back(HtmlCell(FormatFixed(1e3 * p.y, 1), "n"));
    }
    if (!any) return;
    if (items.size() > 1) {
      const Point2 a = items[0].design->geometry.*member;
      const Point2 b = items[1].design->geometry.*member;
      row.push_back(HtmlCell(FormatFixed(1e3 * std::hypot(b.x - a.x, b.y - a.y), 1), "n"));
      row.back().css += " group";
    }
    table.AddRow(row);
  };
  add("K, kingpin axis at hub height", &CornerGeometry::kingpin);
  add("Tie-rod ball joint on the carrier", &CornerGeometry::rod_outer);
  add("Tie-rod ball joint on the rack", &CornerGeometry::rod_inner);
  add("L, lateral support", &CornerGeometry::lateral_support);
  add("N, longitudinal support", &CornerGeometry::longitudinal_support);
  add("Road force", &CornerGeometry::force_point);
  add("S, centre of mass of the carrier", &CornerGeometry::centre_of_mass);
  add("Wheel centre", &CornerGeometry::wheel_centre);
  page.Add(table.MakeHtml());
}

}  // namespace kingpin::report
