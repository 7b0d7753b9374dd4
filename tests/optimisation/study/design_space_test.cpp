#include "optimisation/study/design_space.h"

#include <algorithm>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "models/planar/curve_spline.h"
#include "models/planar/paper_set.h"
#include "optimisation/study/quantities.h"

namespace kingpin::study {
namespace {

using testing::HasSubstr;

planar::Parameters<double> SetB() {
  return planar::ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) + "/examples/paper/set_B.json")
      .parameters;
}

VariableTable GeometryBounds() {
  VariableTable table;
  table[0] = VariableBounds{0.2, 0.4, {}};
  table[1] = VariableBounds{0.0, 0.1, {}};
  table[2] = VariableBounds{-0.1825, -0.0825, {}};
  return table;
}

CurveTable Curves(double fraction, bool odd) {
  CurveTable table;
  table.assistance = CurveBounds{fraction, false, true};
  table.longitudinal = CurveBounds{fraction, odd, true};
  return table;
}

std::string MessageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DesignSpace, ApplyAndExtractAreInverse) {
  const auto base = SetB();
  const DesignSpace space =
      DesignSpace::Make(base, base, {"r_L", "x_tr", "assistance", "longitudinal"}, GeometryBounds(),
                        Curves(0.2, true), "study.yaml");
  // 2 scalars, 6 assistance nodes (that at zero stays), 3 pairs of the odd curve.
  ASSERT_EQ(space.size(), 2 + 6 + 3);
  std::vector<double> x;
  for (const DesignVariable& v : space.variables()) x.push_back(0.3 * v.lower + 0.7 * v.upper);
  const auto design = space.Apply(x);
  EXPECT_EQ(space.Extract(design), x);
  EXPECT_EQ(design.rack_half_length, x[0]);
  EXPECT_EQ(design.assist_force.f[0], 0.0);
}

TEST(DesignSpace, AnOddCurveStaysOdd) {
  const auto base = SetB();
  const DesignSpace space =
      DesignSpace::Make(base, base, {"longitudinal"}, {}, Curves(0.3, true), "");
  std::vector<double> x;
  for (const DesignVariable& v : space.variables()) x.push_back(v.upper);
  const auto curve = space.Apply(x).longitudinal_force;
  for (int k = 0; k < curve.count; ++k) {
    EXPECT_EQ(curve.f[k], -curve.f[curve.count - 1 - k]);
  }
}

TEST(DesignSpace, TheTangentIsTheDerivativeOfApply) {
  const auto base = SetB();
  const DesignSpace space = DesignSpace::Make(base, base, {"r_X", "longitudinal"}, GeometryBounds(),
                                              Curves(0.3, true), "");
  const std::vector<double> x = space.Extract(base);
  for (int i = 0; i < space.size(); ++i) {
    const auto tangent = space.ApplyTangent(x, i);
    std::vector<double> moved = x;
    moved[i] += 1e-3 * (space.variables()[i].upper - space.variables()[i].lower);
    const auto next = space.Apply(moved);
    const double step = moved[i] - x[i];
    EXPECT_NEAR(tangent.rack_position.d[0] * step, next.rack_position - base.rack_position, 1e-15);
    for (int k = 0; k < base.longitudinal_force.count; ++k) {
      EXPECT_NEAR(tangent.longitudinal_force.f[k].d[0] * step,
                  next.longitudinal_force.f[k] - base.longitudinal_force.f[k], 1e-9);
    }
  }
}

TEST(DesignSpace, NodeValuesMayMoveByTheFractionOfTheInitialCurve) {
  const auto initial = SetB();
  auto base = initial;
  for (int k = 1; k < base.assist_force.count; ++k) base.assist_force.f[k] *= 1.05;
  const DesignSpace space =
      DesignSpace::Make(base, initial, {"assistance"}, {}, Curves(0.1, false), "");
  for (const DesignVariable& v : space.variables()) {
    EXPECT_DOUBLE_EQ(v.lower, 0.9 * initial.assist_force.f[v.index]);
    EXPECT_DOUBLE_EQ(v.upper, 1.1 * initial.assist_force.f[v.index]);
    EXPECT_DOUBLE_EQ(v.start, 1.05 * initial.assist_force.f[v.index]);
  }
}

bool Fulfils(const DesignSpace& space, const std::vector<double>& x) {
  return std::all_of(
      space.monotone().begin(), space.monotone().end(), [&](const MonotoneCondition& c) {
        return std::inner_product(x.begin(), x.end(), c.coefficients.begin(), 0.0) <= c.bound;
      });
}

// Looks at the curve, not at its nodes: the least slope on a fine grid over the steepest chord.
double CalcLeastSlopeDensely(const planar::Curve<double>& curve) {
  const auto spline = planar::MakeSpline(curve);
  double least = 0.0, steepest = 0.0;
  for (int k = 0; k + 1 < curve.count; ++k) {
    const double h = curve.x[k + 1] - curve.x[k];
    steepest = std::max(steepest, (curve.f[k + 1] - curve.f[k]) / h);
    for (int i = 0; i <= 200; ++i) {
      least = std::min(least, spline.CalcSlope(curve.x[k] + h * i / 200));
    }
  }
  return least / steepest;
}

bool NodesNeverFall(const planar::Curve<double>& curve) {
  return std::is_sorted(curve.f.begin(), curve.f.begin() + curve.count);
}

TEST(DesignSpace, MonotoneConditionsForbidACurveToFallBetweenItsNodes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int rising = 0, falling_between = 0;
  for (const bool odd : {false, true}) {
    for (const char* name : {"A", "B", "C"}) {
      const auto base = planar::ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) +
                                             "/examples/paper/set_" + name + ".json")
                            .parameters;
      const DesignSpace space =
          DesignSpace::Make(base, base, {"assistance", "longitudinal"}, {}, Curves(0.9, odd), "");
      ASSERT_FALSE(space.monotone().empty());
      ASSERT_TRUE(Fulfils(space, space.Extract(base)));
      for (int i = 0; i < 3000; ++i) {
        // Near the start most designs rise, far from it hardly one does.
        const double reach = unit(random);
        std::vector<double> x;
        for (const DesignVariable& v : space.variables()) {
          x.push_back(v.start + reach * (v.lower + unit(random) * (v.upper - v.lower) - v.start));
        }
        const auto design = space.Apply(x);
        const double least = std::min(CalcLeastSlopeDensely(design.assist_force),
                                      CalcLeastSlopeDensely(design.longitudinal_force));
        if (Fulfils(space, x)) {
          ++rising;
          EXPECT_GE(least, -1e-12);
        }
        if (least < -1e-3 && NodesNeverFall(design.assist_force) &&
            NodesNeverFall(design.longitudinal_force)) {
          ++falling_between;
          EXPECT_FALSE(Fulfils(space, x));
        }
      }
    }
  }
  EXPECT_GT(rising, 1000);
  EXPECT_GT(falling_between, 100);  // looking at the nodes would not have been enough
}

TEST(DesignSpace, OfAMonotoneCubicTheNodesDecide) {
  auto base = SetB();
  base.assist_force.kind = planar::CurveKind::kMonotone;
  const DesignSpace space =
      DesignSpace::Make(base, base, {"assistance"}, {}, Curves(0.9, false), "");
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int rising = 0;
  for (int i = 0; i < 3000; ++i) {
    const double reach = unit(random);
    std::vector<double> x;
    for (const DesignVariable& v : space.variables()) {
      x.push_back(v.start + reach * (v.lower + unit(random) * (v.upper - v.lower) - v.start));
    }
    const auto curve = space.Apply(x).assist_force;
    EXPECT_EQ(Fulfils(space, x), NodesNeverFall(curve));
    if (!Fulfils(space, x)) continue;
    ++rising;
    EXPECT_GE(CalcLeastSlopeDensely(curve), -1e-12);
  }
  EXPECT_GT(rising, 500);
}

TEST(DesignSpace, ConditionsThatTheBoundsImplyAreLeftOut) {
  const auto base = SetB();
  const auto count = [&](double fraction) {
    return DesignSpace::Make(base, base, {"assistance"}, {}, Curves(fraction, false), "")
        .monotone()
        .size();
  };
  EXPECT_EQ(count(0.01), 0);
  EXPECT_GT(count(0.9), count(0.3));
}

TEST(DesignSpace, ANaturalCubicThatFallsBetweenItsNodesIsNamed) {
  auto base = SetB();
  base.assist_force.f = {0, 10, 20, 5000, 5010, 5020, 5030};
  EXPECT_THAT(
      MessageOf(
          [&] { DesignSpace::Make(base, base, {"assistance"}, {}, Curves(0.1, false), "s.yaml"); }),
      testing::AllOf(HasSubstr("curves.assistance"), HasSubstr("falls between its nodes at x = "),
                     HasSubstr("monotone: false")));
  base.assist_force.kind = planar::CurveKind::kMonotone;
  EXPECT_NO_THROW(DesignSpace::Make(base, base, {"assistance"}, {}, Curves(0.1, false), ""));
}

TEST(DesignSpace, BadInputIsNamed) {
  const auto base = SetB();
  EXPECT_THAT(MessageOf([&] { DesignSpace::Make(base, base, {"r_x"}, {}, {}, "s.yaml"); }),
              testing::AllOf(HasSubstr("s.yaml"), HasSubstr("'r_x'"), HasSubstr("r_X")));
  EXPECT_THAT(MessageOf([&] { DesignSpace::Make(base, base, {"r_L"}, {}, {}, "s.yaml"); }),
              HasSubstr("variables.r_L: found nothing, expected a lower and an upper bound"));
  VariableTable narrow;
  narrow[0] = VariableBounds{0.3, 0.4, {}};
  EXPECT_THAT(MessageOf([&] { DesignSpace::Make(base, base, {"r_L"}, narrow, {}, "s.yaml"); }),
              testing::AllOf(HasSubstr("start 0.25"), HasSubstr("0.3 .. 0.4")));
  auto falling = base;
  std::swap(falling.assist_force.f[2], falling.assist_force.f[3]);
  EXPECT_THAT(MessageOf([&] {
                DesignSpace::Make(falling, falling, {"assistance"}, {}, Curves(0.1, false),
                                  "s.yaml");
              }),
              HasSubstr("never decrease"));
}

TEST(SteeringRatio, IsThatOfTheRigidMechanism) {
  // Second route: turn the carrier by a small angle about the crossing point of the supports and
  // look for the rack travel that keeps the tie rod's length.
  auto p = SetB();
  const double ratio = CalcSteeringRatio(p);
  const double tan_l = std::tan(p.lateral_angle), tan_n = std::tan(p.longitudinal_angle);
  const double cx =
      (p.lateral_y - p.longitudinal_y + tan_n * p.longitudinal_x - tan_l * p.lateral_x) /
      (tan_n - tan_l);
  const double cy = p.lateral_y + tan_l * (cx - p.lateral_x);
  const auto travel = [&](double psi) {
    const double rx = p.outer_joint_x - cx, ry = p.outer_joint_y - cy;
    const double ox = cx + std::cos(psi) * rx - std::sin(psi) * ry;
    const double oy = cy + std::sin(psi) * rx + std::cos(psi) * ry;
    const double ix = p.rack_position, iy = p.rack_half_length - p.half_track;
    const double length2 = std::pow(p.outer_joint_x - ix, 2) + std::pow(p.outer_joint_y - iy, 2);
    return oy - std::sqrt(length2 - std::pow(ox - ix, 2)) - iy;
  };
  const double h = 1e-5;
  const double slope = (travel(h) - travel(-h)) / (2 * h);
  EXPECT_NEAR(ratio, p.gear_ratio * slope, 1e-7 * std::abs(ratio));  // differences: h² and rounding
}

}  // namespace
}  // namespace kingpin::study
