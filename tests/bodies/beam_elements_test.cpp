#include "bodies/beam_elements.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kingpin::bodies {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

const BeamMaterial kSteel{2.1e11, 8e10, 7850, 0, 0};

template <class F>
std::string FindError(const F& f) {
  try {
    f();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(BeamSection, TorsionOfRectanglesIsSaintVenants) {
  // Timoshenko and Goodier, Theory of Elasticity, table of k1: J = k1 a b³
  EXPECT_NEAR(CalcSection(RectangularSection{1, 1}).torsion_constant, 0.1406, 5e-5);
  EXPECT_NEAR(CalcSection(RectangularSection{2, 1}).torsion_constant / 2, 0.229, 5e-4);
  EXPECT_NEAR(CalcSection(RectangularSection{1, 10}).torsion_constant / 10, 0.312, 5e-4);
}

TEST(BeamSection, TubesLieBetweenTheSolidAndTheThinOne) {
  const GivenSection solid = CalcSection(RoundSection{0.02});
  EXPECT_NEAR(solid.area, 3.1415926535897936e-4, 1e-18);
  EXPECT_NEAR(solid.Iy, 7.853981633974483e-09, 1e-22);
  EXPECT_NEAR(solid.torsion_constant, 1.5707963267948965e-08, 1e-22);
  EXPECT_NEAR(solid.shear_y, 10.0 / 9, 1e-15);
  const GivenSection thin = CalcSection(TubeSection{1, 0.9999});
  EXPECT_NEAR(thin.shear_y, 2, 1e-6);
  EXPECT_NEAR(thin.Iy / (pi / 8 * 1e-4 / 2), 1, 1e-3);  // π r³ t
}

TEST(BeamElements, MassCentreAndMomentsOfAStepAndATaperAreThoseOfTheWhole) {
  const std::vector<BeamSegment> segments = {{0.3, RoundSection{0.02}, {}, kSteel},
                                             {0.5, RoundSection{0.02}, RoundSection{0.05}, kSteel}};
  const auto combine = [&](int n) {
    const BeamElements beam = MakeBeamElements(segments, n);
    std::vector<RigidInertia> parts;
    for (const auto& element : beam.elements) {
      parts.push_back(Move(element.inertia, {{}, {element.start, 0, 0}}));
    }
    return Combine(parts);
  };
  const RigidInertia whole = combine(0), parts = combine(7);
  // a cylinder and the frustum of a cone
  EXPECT_NEAR(whole.mass,
              7850 * pi * (0.3 * 1e-4 + 0.5 / 3 * (1e-4 + 0.01 * 0.025 + 0.025 * 0.025)), 1e-12);
  EXPECT_NEAR(parts.mass, whole.mass, 1e-12);
  EXPECT_NEAR(parts.centre.x, whole.centre.x, 1e-13);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(parts.central[i], whole.central[i], 1e-13);
}

TEST(BeamElements, ComplianceOfAConeIsTheIntegral) {
  const double d1 = 0.02, d2 = 0.03, L = 0.4;
  for (int n : {1, 4}) {
    const BeamElements beam =
        MakeBeamElements({{L, RoundSection{d1}, RoundSection{d2}, kSteel}}, n);
    double twist = 0, slope = 0, stretch = 0;
    for (const auto& spring : beam.springs) {
      stretch += 1 / spring.stiffness[0];
      twist += 1 / spring.stiffness[3];
      slope += 1 / spring.stiffness[4];
    }
    const double cubes = (1 / (d1 * d1 * d1) - 1 / (d2 * d2 * d2)) * L / (3 * (d2 - d1));
    EXPECT_NEAR(twist / (32 / (pi * kSteel.G) * cubes), 1, 1e-9);
    EXPECT_NEAR(slope / (64 / (pi * kSteel.E) * cubes), 1, 1e-9);
    EXPECT_NEAR(stretch / (4 * L / (pi * kSteel.E * d1 * d2)), 1, 1e-9);
  }
}

TEST(BeamElements, ASteppedShaftTwistsAsItsPartsInARow) {
  const BeamElements beam = MakeBeamElements(
      {{0.1, RoundSection{0.02}, {}, kSteel}, {0.25, TubeSection{0.04, 0.03}, {}, kSteel}}, 3);
  double twist = 0;
  for (const auto& spring : beam.springs) twist += 1 / spring.stiffness[3];
  const double expected = (0.1 / CalcSection(RoundSection{0.02}).torsion_constant +
                           0.25 / CalcSection(TubeSection{0.04, 0.03}).torsion_constant) /
                          kSteel.G;
  EXPECT_NEAR(twist / expected, 1, 1e-13);
}

TEST(BeamElements, DivisionIsThePrimaryOne) {
  const BeamElements beam = MakeBeamElements({{1, RoundSection{0.02}, {}, kSteel}}, 4);
  ASSERT_EQ(beam.elements.size(), 5u);
  EXPECT_NEAR(beam.elements[0].end - beam.elements[0].start, 0.125, 1e-15);
  EXPECT_NEAR(beam.elements[4].end - beam.elements[4].start, 0.125, 1e-15);
  for (int k = 1; k < 4; ++k) {
    EXPECT_NEAR(beam.elements[k].end - beam.elements[k].start, 0.25, 1e-15);
    const double m = beam.elements[k].inertia.mass;
    EXPECT_NEAR(beam.elements[k].inertia.central[1], m * (0.25 * 0.25 / 12 + 0.02 * 0.02 / 16),
                1e-12);
  }
}

TEST(BeamElements, TotalsGivenDirectly) {
  const UniformBeam uniform{0.5, 1.2, 3e-4, {0, 0, 0, 900, 0, 0}, {0, 0, 0, 0.2, 0, 0}};
  const BeamElements beam = MakeBeamElements(uniform, 3);
  EXPECT_NEAR(beam.springs[0].stiffness[3], 2700, 1e-9);
  EXPECT_NEAR(beam.springs[0].damping[3], 0.6, 1e-12);
  double axial = 0;
  for (const auto& element : beam.elements) axial += element.inertia.central[0];
  EXPECT_NEAR(axial, 3e-4, 1e-17);
}

TEST(BeamElements, BadNumbersAreNamed) {
  EXPECT_THAT(FindError([] {
                MakeBeamElements({{1, RoundSection{0.02}, {}, kSteel}}, -1);
              }),
              HasSubstr("-1 elements"));
  EXPECT_THAT(FindError([] {
                MakeBeamElements(
                    {{1, RoundSection{0.02}, {}, kSteel}, {1, TubeSection{0.02, 0.03}, {}, kSteel}},
                    2);
              }),
              HasSubstr("segment 2: inner diameter of 0.03"));
  EXPECT_THAT(FindError([] {
                MakeBeamElements({{1, RoundSection{0.02}, TubeSection{0.02, 0.01}, kSteel}}, 2);
              }),
              HasSubstr("segment 1: a taper between sections of two shapes"));
  EXPECT_THAT(FindError([] {
                MakeBeamElements({{1, RoundSection{0.02}, {}, {}}}, 2);
              }),
              HasSubstr("segment 1: Young's modulus of 0"));
  EXPECT_THAT(FindError([] { MakeBeamElements(std::vector<BeamSegment>{}, 2); }),
              HasSubstr("without segments"));
  EXPECT_THAT(FindError([] {
                MakeBeamElements(UniformBeam{0, 1, 1, {}, {}}, 2);
              }),
              HasSubstr("length of 0 m"));
}

}  // namespace
}  // namespace kingpin::bodies
