#include "optimisation/report/study_report.h"

#include <functional>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "optimisation/report/case_facts.h"
#include "optimisation/report/html.h"
#include "tests/optimisation/report/html_check.h"
#include "tests/optimisation/report/poisoned_study.h"
#include "tests/optimisation/report/sample_study.h"

namespace kingpin::report {
namespace {

using sample::MakeSampleStudy;

bool Has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

void ExpectSound(const std::string& html) {
  const check::Document document = check::ReadDocument(html);
  for (const std::string& problem : document.problems) ADD_FAILURE() << problem;
  std::set<std::string> ids;
  for (const check::Element& e : document.elements) {
    const auto id = e.attributes.find("id");
    if (id != e.attributes.end()) {
      EXPECT_TRUE(ids.insert(id->second).second) << id->second;
    }
  }
  for (const check::Element& e : document.elements) {
    const auto link = e.attributes.find("href");
    if (link == e.attributes.end()) continue;
    ASSERT_EQ(link->second.substr(0, 1), "#");
    EXPECT_EQ(ids.count(link->second.substr(1)), 1u) << link->second;
  }
}

TEST(StudyReport, IsWellFormedWithUniqueIds) { ExpectSound(MakeStudyReport(MakeSampleStudy())); }

TEST(StudyReport, NothingPointsOutside) {
  const std::string html = MakeStudyReport(MakeSampleStudy());
  for (const char* part : {"http:", "https:", "url(", "@import", "src=", "<link", "<img", "<iframe",
                           "fetch(", "XMLHttpRequest", "innerHTML", "eval("}) {
    EXPECT_FALSE(Has(html, part)) << part;
  }
  EXPECT_TRUE(Has(html, "default-src 'none'"));
}

TEST(StudyReport, EveryTextIsEscaped) {
  const std::string html = MakeStudyReport(sample::MakePoisonedStudy());
  EXPECT_FALSE(
      Has(html, "<script>document.documentElement.setAttribute('data-errors','injected')"));
  EXPECT_FALSE(Has(html, "<img"));
  EXPECT_TRUE(Has(html, "&lt;script&gt;"));
  ExpectSound(html);
}

TEST(StudyReport, TheSameDataGiveTheSameBytes) {
  EXPECT_EQ(MakeStudyReport(MakeSampleStudy()), MakeStudyReport(MakeSampleStudy()));
}

TEST(StudyReport, StaysModerateInSize) {
  EXPECT_LT(MakeStudyReport(MakeSampleStudy()).size(), 3u << 20);
  // Ten times the samples must not give ten times the file.
  StudyReportData data = MakeSampleStudy();
  for (Case& c : data.cases) {
    for (Design& d : c.designs) {
      const auto repeat = [](std::vector<double>& v) {
        std::vector<double> longer;
        for (const double x : v) longer.insert(longer.end(), 20, x);
        v = longer;
      };
      repeat(d.time);
      for (auto& history : d.histories) repeat(history);
      for (auto* v : {&d.motion.time, &d.motion.x, &d.motion.y, &d.motion.psi, &d.motion.rack,
                      &d.motion.wheel_angle, &d.motion.road_force}) {
        repeat(*v);
      }
    }
  }
  EXPECT_LT(MakeStudyReport(data).size(), 3u << 20);
}

TEST(StudyReport, EmptyDataGiveASoundPage) {
  ExpectSound(MakeStudyReport({}));
  StudyReportData data;
  data.cases.resize(2);
  ExpectSound(MakeStudyReport(data));
  data.cases[0].designs.resize(3);
  data.measures = sample::MakeMeasures();
  ExpectSound(MakeStudyReport(data));
}

TEST(StudyReport, ShortVectorsShowAsMissing) {
  StudyReportData data = MakeSampleStudy();
  for (Case& c : data.cases) {
    for (Design& d : c.designs) {
      d.measures.resize(2);
      d.variables.resize(1);
      d.histories.resize(1);
      d.histories[0].resize(10);
      d.spectrum.y.resize(3);
      d.frequency_responses.resize(1);
      d.frequency_responses[0].resize(2);
      d.characteristics.resize(1);
      d.motion.x.resize(5);
      d.motion.rack.clear();
    }
    for (Sensitivity& s : c.sensitivities) s.values.resize(1);
    for (Comparison& comparison : c.comparisons) comparison.rows[0].ours.clear();
    for (Restarts& r : c.restarts) r.end_designs.resize(3);
  }
  for (FurtherRow& row : data.further.rows) row.ratios.clear();
  ExpectSound(MakeStudyReport(data));
}

TEST(StudyReport, EverySectionAppearsExactlyWhenItsDataDo) {
  struct Part {
    const char* mark;
    std::function<void(StudyReportData&)> clear;
  };
  const auto each_case = [](const std::function<void(Case&)>& change) {
    return [change](StudyReportData& data) {
      for (Case& c : data.cases) change(c);
    };
  };
  const auto each_design = [&](const std::function<void(Design&)>& change) {
    return each_case([change](Case& c) {
      for (Design& d : c.designs) change(d);
    });
  };
  const std::vector<Part> parts = {
      {">Kickback card</h3>", each_design([](Design& d) { d.measures.clear(); })},
      {">Design variables</h3>", each_design([](Design& d) { d.variables.clear(); })},
      {">Histories</h3>", each_design([](Design& d) { d.histories.clear(); })},
      {">Spectra</h3>", each_design([](Design& d) { d.spectrum = {}; })},
      {">Geometry</h3>", each_design([](Design& d) { d.geometry = {}; })},
      {"class=\"controls\"", each_design([](Design& d) { d.motion = {}; })},
      {">Characteristics</h3>", each_design([](Design& d) { d.characteristics.clear(); })},
      {">Frequency responses</h3>", each_design([](Design& d) { d.frequency_responses.clear(); })},
      {">Modes</h3>", each_design([](Design& d) { d.modes.clear(); })},
      {">Sensitivities</h3>", each_case([](Case& c) { c.sensitivities.clear(); })},
      {">What holds the optimum back</h4>", each_case([](Case& c) { c.active.clear(); })},
      {"Best value so far", each_case([](Case& c) { c.convergence.clear(); })},
      {">How unique the optimum is</h4>", each_case([](Case& c) { c.restarts.clear(); })},
      {">Why it stopped<", each_case([](Case& c) { c.stages.clear(); })},
      {">Kickback against road feel</h3>", each_case([](Case& c) { c.pareto.clear(); })},
      {">Comparison with printed values</h3>", each_case([](Case& c) { c.comparisons.clear(); })},
      {"Read with care", each_case([](Case& c) { c.warnings.clear(); })},
      {">Further than the paper</h2>", [](StudyReportData& d) { d.further = {}; }},
      {">Parameters</h2>", [](StudyReportData& d) { d.parameters.clear(); }},
      {">Options in force</h3>", [](StudyReportData& d) { d.options.clear(); }},
      {">Conventions</h3>", [](StudyReportData& d) { d.conventions.clear(); }},
      {">Solver statistics</h3>", [](StudyReportData& d) { d.solver.clear(); }},
      {">Versions</h3>", [](StudyReportData& d) { d.versions.clear(); }},
      {">Inputs</h3>", [](StudyReportData& d) { d.inputs.clear(); }},
  };
  const std::string full = MakeStudyReport(MakeSampleStudy());
  for (const Part& part : parts) {
    EXPECT_TRUE(Has(full, part.mark)) << part.mark;
    StudyReportData data = MakeSampleStudy();
    part.clear(data);
    const std::string html = MakeStudyReport(data);
    EXPECT_FALSE(Has(html, part.mark)) << part.mark;
    ExpectSound(html);
  }
}

TEST(StudyReport, NumbersOfTheSampleArePresent) {
  const std::string html = MakeStudyReport(MakeSampleStudy());
  // Γ_1 of the start in mm/s², I_V of OPT2 (0.641 + 0.631 + 0.372 + 0.77 + 0.62), its ratio to 5.
  for (const char* text :
       {"19\u202f200", "3.034", "0.607", "−39\u202f%", "−82.50", "fnv1a64:9ae16a3b2f90404f",
        "front.tie_rod.length", "243 ms", "16 of 20 runs", "W_h"}) {
    EXPECT_TRUE(Has(html, text) || Has(html, SymbolHtml(text))) << text;
  }
}

TEST(StudyReport, AMarkOnABoundIsOfTheDesignsOwnStage) {
  StudyReportData data = MakeSampleStudy();
  data.cases.resize(1);
  Case& c = data.cases[0];
  for (Design& d : c.designs) {
    d.lower.assign(c.variables.size(), kMissing);
    d.upper.assign(c.variables.size(), kMissing);
  }
  EXPECT_FALSE(Has(MakeStudyReport(data), "on the lower bound of its stage"));
  c.designs[1].upper[0] = c.designs[1].variables[0];
  c.designs[1].lower[0] = c.designs[1].variables[0] - 1.0;
  EXPECT_TRUE(Has(MakeStudyReport(data), "<span class=\"mark\">⊤</span>"));
}

TEST(StudyReport, EndsOfRunsAreListedForFreedVariablesOnly) {
  StudyReportData data = MakeSampleStudy();
  data.cases.resize(1);
  Case& c = data.cases[0];
  const auto rows_of = [&] {
    const std::string html = MakeStudyReport(data);
    const size_t at = html.find("lowest among equals");
    const std::string table = html.substr(at, html.find("</table>", at) - at);
    long rows = 0;
    for (size_t k = table.find("<tr"); k != std::string::npos; k = table.find("<tr", k + 1)) ++rows;
    return rows;
  };
  const long before = rows_of();
  for (Restarts& r : c.restarts) {
    for (auto& end : r.end_designs) end[0] = kMissing;
  }
  EXPECT_EQ(rows_of(), before - 1);
}

TEST(StudyReport, ALengthIsComparedInItsOwnUnit) {
  StudyReportData data;
  data.comparisons = {{.title = "Table 5",
                       .columns = {"set A"},
                       .rows = {{"r_X", "", {"mm", 1e3}, 3.5e-8, {0.0}, ""},
                                {"Γ_1", "", {"mm/s^2"}, 100.0, {90.0}, ""}}}};
  const std::string html = MakeStudyReport(data);
  EXPECT_FALSE(Has(html, "−100"));
  EXPECT_TRUE(Has(html, "−10\u202f%"));
}

TEST(StudyReport, TheLegendNamesEveryPlottedDesign) {
  StudyReportData data = MakeSampleStudy();
  data.cases[0].designs[2].plotted = false;
  data.cases.resize(1);
  const std::string html = MakeStudyReport(data);
  EXPECT_TRUE(Has(html, "data-name=\"step 1\""));
  EXPECT_FALSE(Has(html, "data-name=\"step 2\""));
}

TEST(CaseFacts, TheIndexIsTheWeightedSumOfRatios) {
  const std::vector<Measure> measures = {
      {.name = "a", .weight = 1.0}, {.name = "b", .weight = 2.0}, {.name = "c"}};
  Design reference;
  reference.measures = {2.0, 4.0, 7.0};
  Design design;
  design.measures = {1.0, 3.0, 100.0};
  EXPECT_DOUBLE_EQ(CalcWeightedRatios(measures, reference, design), 0.5 + 1.5);
  EXPECT_DOUBLE_EQ(CalcWeightedRatios(measures, reference, reference), 3.0);
  design.measures.resize(1);
  EXPECT_TRUE(std::isnan(CalcWeightedRatios(measures, reference, design)));
  EXPECT_TRUE(std::isnan(CalcWeightedRatios({{.name = "c"}}, reference, reference)));
}

TEST(CaseFacts, TheLowestIndexIsChosenUnlessTheStudySaysOtherwise) {
  const std::vector<Measure> measures = sample::MakeMeasures();
  Case c = sample::MakeCase("x", 1.0);
  EXPECT_EQ(FindChosenDesign(measures, c), 3u);
  c.designs[1].objective = 1.0;  // relative to something else: not comparable
  EXPECT_EQ(FindChosenDesign(measures, c), 3u);
  c.chosen = 2;
  EXPECT_EQ(FindChosenDesign(measures, c), 2u);
  EXPECT_FALSE(FindChosenDesign(measures, Case{}).has_value());
}

TEST(CaseFacts, TheVerdictIsRelativeToTheFirstDesignWhateverTheSearchDividedBy) {
  const std::vector<Measure> measures = sample::MakeMeasures();
  Case c = sample::MakeCase("x", 1.0);
  const std::string before = MakeVerdict(measures, c);
  c.designs[3].objective = 3.94;  // relative to step 1
  EXPECT_EQ(MakeVerdict(measures, c), before);
  StudyReportData data = MakeSampleStudy();
  for (Case& other : data.cases) other.designs[3].objective = 3.94;
  const std::string html = MakeStudyReport(data);
  // In the cards' row of objectives, and nowhere as an index of the summary.
  EXPECT_EQ(html.substr(0, html.find("Kickback card</h3>")).find("3.94"), std::string::npos);
}

TEST(CaseFacts, TheVerdictSaysWhatWasPaid) {
  const std::vector<Measure> measures = sample::MakeMeasures();
  Case c = sample::MakeCase("x", 1.0);
  EXPECT_TRUE(Has(MakeVerdict(measures, c), "lowers the kickback index from 5.00 to 3.03"));
  EXPECT_FALSE(Has(MakeVerdict(measures, c), "paid for"));
  c.designs[3].measures[12] *= 0.7;
  EXPECT_TRUE(Has(MakeVerdict(measures, c), "paid for"));
  c.chosen = 0;
  EXPECT_EQ(MakeVerdict(measures, c), "No design betters the initial one.");
  c.verdict = "As written.";
  EXPECT_EQ(MakeVerdict(measures, c), "As written.");
}

}  // namespace
}  // namespace kingpin::report
