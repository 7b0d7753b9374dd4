#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "optimisation/study/make_report.h"
#include "optimisation/study/run_study.h"
#include "optimisation/study/stage_problem.h"
#include "optimisation/study/study_schema.h"

/// Searches of the shipped car, whose dry friction makes the measures rough.
namespace kingpin::study {
namespace {

StudyDefinition ReadShipped() {
  return ReadStudy(std::string(KINGPIN_SOURCE_DIR) + "/examples/c_segment");
}

const Case& FindCase(const StudyDefinition& study, const std::string& name) {
  return *std::find_if(study.cases.begin(), study.cases.end(),
                       [&](const Case& c) { return c.name == name; });
}

CaseResult RunFirstStep(int random_starts) {
  const StudyDefinition study = ReadShipped();
  Case c = FindCase(study, "electric");
  c.stages.front().random_starts = random_starts;
  return RunStages(study, c, "step 1", {});
}

TEST(FrictionSearch, EndsAreValuesOfTheModelWithFriction) {
  const CaseResult result = RunFirstStep(0);
  const DesignResult& step_1 = result.Find("step 1");
  ASSERT_TRUE(HasSwitchingForces(step_1.parameters));
  ASSERT_FALSE(step_1.search->restarts.empty());
  for (const auto& restart : step_1.search->restarts) {
    // Without friction the ends lie at 4.628, below anything the model with it can do.
    EXPECT_GE(restart.value, step_1.sum_of_ratios * (1.0 - 1e-12));
  }
  for (const auto& minimum : step_1.search->minima) {
    EXPECT_GE(minimum.value, step_1.sum_of_ratios * (1.0 - 1e-12));
  }
}

TEST(FrictionSearch, RandomStartsAreRun) {
  const CaseResult result = RunFirstStep(3);
  const DesignResult& step_1 = result.Find("step 1");
  ASSERT_EQ(step_1.search->restarts.size(), 3u);
  for (const auto& restart : step_1.search->restarts) {
    EXPECT_TRUE(std::isfinite(restart.value));
    EXPECT_GE(restart.value, step_1.sum_of_ratios * (1.0 - 1e-12));
  }
}

TEST(FrictionSearch, ALimitReachedToTheSearchsToleranceIsActive) {
  const CaseResult result = RunFirstStep(0);
  const DesignResult& step_1 = result.Find("step 1");
  const double ratio = step_1.road_feel_gain / result.designs.front().road_feel_gain;
  EXPECT_GE(ratio, 0.9 - 1e-8);
  ASSERT_LE(ratio, 0.901);  // it is what holds this design
  const auto& active = step_1.search->active;
  EXPECT_TRUE(std::any_of(active.begin(), active.end(),
                          [](const auto& a) { return a.name == "road_feel_gain at its minimum"; }));
}

TEST(FrictionSearch, SeedsAgreeOnTheGeometryStep) {
  StudyDefinition study = ReadShipped();
  for (const char* name : {"hydraulic", "electric"}) {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
    for (const std::uint64_t seed : {1, 2, 3}) {
      study.seed = seed;
      const CaseResult result = RunStages(study, FindCase(study, name), "step 1", {});
      const double sum = result.Find("step 1").sum_of_ratios;
      lowest = std::min(lowest, sum);
      highest = std::max(highest, sum);
    }
    // The measures are rough by about 1e-3 on the scale of the search's last steps.
    EXPECT_LE(highest, 1.005 * lowest) << name;
  }
}

TEST(FrictionSearch, NoDesignFoundLiesBeyondTheFront) {
  StudyDefinition study = ReadShipped();
  study.cases = {FindCase(study, "electric")};
  study.cases[0].stages.resize(1);
  study.cases[0].pareto->generations = 2;
  study.cases[0].pareto->population = 16;
  const StudyResult result = RunStudy(study, {});
  const CaseResult& c = result.cases.front();
  const auto& initial = c.designs.front();
  for (const DesignResult& design : c.designs) {
    const double sum = measures::CalcObjective(design.gammas, initial.gammas, study.weights());
    const bool matched = std::any_of(c.pareto.begin(), c.pareto.end(), [&](const auto& point) {
      return point.sum_of_ratios <= sum * (1 + 1e-12) &&
             point.road_feel_gain >= design.road_feel_gain * (1 - 1e-12);
    });
    EXPECT_TRUE(matched) << design.name;
  }
}

}  // namespace
}  // namespace kingpin::study
