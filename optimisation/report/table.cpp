#include "optimisation/report/table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"

namespace kingpin::report {
namespace {

std::string Shade(double strength) {
  // Strength in [-1, 1]: blue (better, negative) to orange (worse, positive).
  const double alpha = 0.42 * std::min(std::abs(strength), 1.0);
  if (alpha < 0.02) return {};
  return fmt::format("background:rgba({},{:.2f})", strength < 0 ? "0,114,178" : "230,159,0", alpha);
}

std::string DrawRow(const std::vector<Cell>& cells, const char* tag, const std::string& css) {
  std::string out = css.empty() ? "<tr>" : fmt::format("<tr class=\"{}\">", css);
  for (const Cell& cell : cells) {
    out += fmt::format("<{}", tag);
    if (cell.span > 1) out += fmt::format(" colspan=\"{}\"", cell.span);
    if (!cell.css.empty()) out += fmt::format(" class=\"{}\"", cell.css);
    if (!cell.style.empty()) out += fmt::format(" style=\"{}\"", cell.style);
    out += fmt::format(">{}</{}>", cell.html, tag);
  }
  return out + "</tr>\n";
}

}  // namespace

Cell TextCell(std::string_view text, std::string_view css) {
  return {SymbolHtml(text), std::string(css), "", 1};
}

Cell HtmlCell(std::string html, std::string_view css) {
  return {std::move(html), std::string(css), "", 1};
}

Cell NumberCell(double value, int significant) {
  return {FormatNumber(value, significant), "n", "", 1};
}

Cell RatioCell(double ratio, Preference preference) {
  Cell cell = {FormatRatio(ratio), "n", "", 1};
  if (preference != Preference::kNeutral && std::isfinite(ratio) && ratio > 0.0) {
    const double strength = std::log(ratio) / std::log(2.0);
    cell.style = Shade(preference == Preference::kLower ? strength : -strength);
  }
  return cell;
}

Cell SignedCell(double value, double full_scale, int significant) {
  Cell cell = {FormatNumber(value, significant), "n", "", 1};
  if (std::isfinite(value) && full_scale > 0.0) cell.style = Shade(value / full_scale);
  return cell;
}

void Table::AddRow(std::vector<Cell> cells, std::string css) {
  rows_.push_back({std::move(cells), std::move(css)});
}

std::string Table::MakeHtml(const std::string& css) const {
  std::string out = css.empty() ? "<div class=\"scroll\"><table>"
                                : fmt::format("<div class=\"scroll\"><table class=\"{}\">", css);
  if (!header_.empty()) {
    out += "<thead>";
    for (const auto& cells : header_) out += DrawRow(cells, "th", "");
    out += "</thead>";
  }
  out += "<tbody>";
  for (const Row& row : rows_) out += DrawRow(row.cells, "td", row.css);
  return out + "</tbody></table></div>\n";
}

}  // namespace kingpin::report
