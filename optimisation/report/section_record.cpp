#include <cmath>

#include <fmt/format.h>

#include "optimisation/report/html.h"
#include "optimisation/report/number_format.h"
#include "optimisation/report/sections.h"
#include "optimisation/report/table.h"

namespace kingpin::report {
namespace {

std::string MakeList(const std::vector<NamedText>& items) {
  std::string out = "<dl>";
  for (const NamedText& item : items) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", SymbolHtml(item.name), SymbolHtml(item.text));
  }
  return out + "</dl>\n";
}

}  // namespace

void AddParameters(const StudyReportData& data, Page& page) {
  if (data.parameters.empty()) return;
  page.AddHeading(2, "Parameters");
  page.AddParagraph(
      "Every value the models used, with its origin. An asterisk marks a value that differs "
      "from the shipped one. What an earlier case took from the same place is not listed again.");
  std::string list;
  for (const ParameterGroup& group : data.parameters) {
    Table table;
    table.AddHeader(
        {TextCell("Parameter"), TextCell("Value", "n"), TextCell("Unit"), TextCell("Origin")});
    for (const Parameter& p : group.parameters) {
      table.AddRow({HtmlCell("<code>" + EscapeHtml(p.name) + "</code>" + (p.changed ? " *" : "")),
                    HtmlCell(EscapeHtml(p.value), p.value.size() > 40 ? "" : "n"),
                    TextCell(PrettyUnit(p.unit), "muted"),
                    HtmlCell(EscapeHtml(p.origin), "muted")});
    }
    std::string title = fmt::format("{} ({})", group.title, group.parameters.size());
    if (!group.source.empty()) title += " · " + group.source;
    list += MakeDetails(title, table.MakeHtml("wide parameters"));
  }
  page.Add("<div class=\"parameters-list\">" + list + "</div>\n");
}

void AddConventions(const StudyReportData& data, Page& page) {
  std::vector<NamedText> items;
  for (const Measure& m : data.measures) {
    if (m.definition.empty()) continue;
    items.push_back({m.symbol.empty() ? m.name : m.symbol, m.definition});
  }
  if (items.empty() && data.conventions.empty() && data.options.empty()) return;
  page.AddHeading(2, "Conventions and options");
  if (!items.empty()) {
    page.AddHeading(3, "Measures");
    page.Add(MakeList(items));
  }
  if (!data.conventions.empty()) {
    page.AddHeading(3, "Conventions");
    page.Add(MakeList(data.conventions));
  }
  if (!data.options.empty()) {
    page.AddHeading(3, "Options in force");
    page.Add(MakeList(data.options));
  }
}

void AddRecord(const StudyReportData& data, Page& page) {
  if (data.solver.empty() && data.versions.empty() && data.inputs.empty()) return;
  page.AddHeading(2, "Record of the run");
  if (!data.solver.empty()) {
    page.AddHeading(3, "Solver statistics");
    page.Add(MakeList(data.solver));
  }
  if (!data.versions.empty()) {
    page.AddHeading(3, "Versions");
    page.Add(MakeList(data.versions));
  }
  if (!data.inputs.empty()) {
    page.AddHeading(3, "Inputs");
    Table table;
    table.AddHeader({TextCell("File"), TextCell("Bytes", "n"), TextCell("Hash")});
    for (const InputFile& f : data.inputs) {
      table.AddRow({HtmlCell("<code>" + EscapeHtml(f.path) + "</code>"),
                    HtmlCell(FormatCount(f.bytes), "n"),
                    HtmlCell("<code>" + EscapeHtml(f.hash) + "</code>", "hash")});
    }
    page.Add(table.MakeHtml());
  }
}

}  // namespace kingpin::report
