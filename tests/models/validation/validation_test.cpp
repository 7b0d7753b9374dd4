#include <numbers>

#include <gtest/gtest.h>

#include "models/validation/cases.h"
#include "models/validation/elliptic.h"
#include "models/validation/extrapolation.h"
#include "models/validation/outcome.h"

namespace kingpin::validation {
namespace {

class Validation : public testing::TestWithParam<Case> {};

TEST_P(Validation, HoldsAgainstTheTruth) {
  const Outcome outcome = RunCase(GetParam());
  EXPECT_EQ(outcome.failure, "");
  EXPECT_FALSE(outcome.checks.empty());
  EXPECT_TRUE(outcome.passes()) << FormatOutcome(outcome);
}

INSTANTIATE_TEST_SUITE_P(Cases, Validation, testing::ValuesIn(ListCases()),
                         [](const auto& info) { return info.param.name; });

TEST(ValidationReference, TheExtrapolationIsExactToLongDoubleOnThePendulum) {
  const Real complement = 0.5L, rate = std::sqrt(9.81L);
  State y = {std::numbers::pi_v<Real> / 2, 0};
  Integrate(
      [](Real, const State& s, State& r) {
        r[0] = s[1];
        r[1] = -9.81L * std::sin(s[0]);
      },
      0, 10, y);
  const Jacobi j = CalcJacobi(rate * 10 + CalcQuarterPeriod(complement), complement);
  EXPECT_NEAR(static_cast<double>(std::sin(y[0] / 2) - std::sqrt(0.5L) * j.sn), 0, 1e-15);
}

TEST(ValidationReference, JacobisFunctionsMeetTheirIdentities) {
  for (Real complement : {1e-5L, 0.3L, 0.999L}) {
    const Real quarter = CalcQuarterPeriod(complement);
    for (Real u : {-3.0L, 0.1L, 0.7L, 5.0L}) {
      const Jacobi j = CalcJacobi(u, complement);
      EXPECT_NEAR(static_cast<double>(j.sn * j.sn + j.cn * j.cn), 1, 1e-17);
      // sn(u + K) = cn/dn
      EXPECT_NEAR(static_cast<double>(CalcJacobi(u + quarter, complement).sn - j.cn / j.dn), 0,
                  1e-13);
    }
  }
}

TEST(ValidationOutcome, ANumberThatIsNotOneFails) {
  EXPECT_FALSE(Compare("x", 1, std::nan(""), 1).passes());
  EXPECT_FALSE(Bound("x", 2, 1).passes());
  EXPECT_TRUE(Bound("x", -1, 1).passes());
}

TEST(ValidationOutcome, ACaseThatStopsFailsAndSaysWhy) {
  const Outcome outcome = RunCase(Case{"X", "x", "", []() -> std::vector<Check> {
                                         throw std::runtime_error("the constraints contradict");
                                       }});
  EXPECT_FALSE(outcome.passes());
  EXPECT_NE(FormatOutcome(outcome).find("stopped: the constraints contradict"), std::string::npos);
}

}  // namespace
}  // namespace kingpin::validation
