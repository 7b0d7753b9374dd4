#include "optimisation/report/study_report.h"

#include "optimisation/report/sections.h"

namespace kingpin::report {

std::string MakeStudyReport(const StudyReportData& data) {
  Page page;
  AddSummary(data, page);
  for (const Case& c : data.cases) {
    page.AddHeading(2, c.name.empty() ? "Case" : c.name);
    page.AddParagraph(c.description);
    AddKickbackCard(data.measures, c, page);
    AddDesignVariables(c, page);
    AddHistories(c, page);
    AddSpectra(c, page);
    AddGeometry(data.measures, c, page);
    AddCharacteristics(c, page);
    AddFrequencyResponses(c, page);
    AddModes(data.measures, c, page);
    AddSensitivities(c, page);
    AddSearch(c, page);
    AddParetoFronts(c, page);
    if (!c.comparisons.empty()) {
      page.AddHeading(3, "Comparison with printed values");
      AddComparisons(c.comparisons, 4, page);
    }
  }
  if (!data.comparisons.empty()) {
    page.AddHeading(2, "Comparison with printed values");
    AddComparisons(data.comparisons, 3, page);
  }
  AddFurther(data.further, page);
  AddParameters(data, page);
  AddConventions(data, page);
  AddRecord(data, page);
  return page.MakeDocument(data.title.empty() ? "Kingpin report" : data.title);
}

}  // namespace kingpin::report
