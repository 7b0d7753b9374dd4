#include "joints/beam_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/error.h"
#include "core/mechanism/evaluator.h"
#include "core/solve/linearise.h"
#include "joints/mechanism_builder.h"
#include "joints/mechanism_file.h"

namespace kingpin::joints {
namespace {

using testing::HasSubstr;

// The modes of a clamped beam with a body on its end.
std::vector<solve::Mode> CalcModes(const Mechanism& mechanism) {
  return solve::CalcModes(solve::Linearise(mechanism.system, 0, mechanism.start));
}

void ExpectSameModes(const Mechanism& a, const Mechanism& b) {
  const std::vector<solve::Mode> left = CalcModes(a), right = CalcModes(b);
  ASSERT_EQ(left.size(), right.size());
  ASSERT_GT(left.size(), 0u);
  for (size_t i = 0; i < left.size(); ++i) {
    // both are made of the same numbers; the eigenvalue solver's rounding of a stiff matrix is left
    EXPECT_LE(std::abs(left[i].eigenvalue - right[i].eigenvalue),
              1e-9 * std::abs(left[i].eigenvalue))
        << i;
  }
}

const std::string kShaft = R"(kind: mechanism
gravity: [0, 0, 0]
beams:
  shaft:
    at: [0, 0.1, 0]
    turned: [0, 0, 0.5]
    elements: 4
    flexibility: torsion_and_bending
    material: {E: 210 GPa, G: 80 GPa, density: 7850 kg/m^3, normal_damping: 2e6, shear_damping: 1 MPa s}
    segments:
      - {length: 300 mm, section: tube, outer: 30 mm, inner: 24 mm}
      - {length: 100 mm, section: round, diameter: 30 mm, end_diameter: 20 mm}
      - length: 200 mm
        section: rectangle
        width: 20 mm
        height: 10 mm
        material: {E: 70 GPa, G: 26 GPa, density: 2700 kg/m^3}
      - {length: 0.1, section: given, area: 1e-4, Iy: 1e-9, Iz: 2e-9, torsion_constant: 2e-9, shear_z: 1.5}
bodies:
  flange: {mass: 2 kg, inertia: [0.01, 0.006, 0.006]}
joints:
  weld: {type: fixed, parent: shaft.end, at: [0.05, 0, 0], child: flange}
)";

std::vector<bodies::BeamSegment> MakeShaftSegments() {
  const bodies::BeamMaterial steel{210e9, 80e9, 7850, 2e6, 1e6}, aluminium{70e9, 26e9, 2700, 0, 0};
  return {{0.3, bodies::TubeSection{0.03, 0.024}, {}, steel},
          {0.1, bodies::RoundSection{0.03}, bodies::RoundSection{0.02}, steel},
          {0.2, bodies::RectangularSection{0.02, 0.01}, {}, aluminium},
          {0.1, bodies::GivenSection{1e-4, 1e-9, 2e-9, 2e-9, 1.2, 1.5}, {}, steel}};
}

// The same in code.
Mechanism MakeShaft(const bodies::BeamElements& elements, BeamDescription::Flexibility flexibility,
                    JointType root = JointType::kFixed) {
  MechanismBuilder m("shaft");
  m.Gravity({0, 0, 0});
  BeamDescription beam;
  beam.name = "shaft";
  beam.at = {"world", MakePose({0, 0.1, 0}, {0, 0, 0.5})};
  beam.elements = elements;
  beam.flexibility = flexibility;
  beam.root = root;
  FrameDescription end = m.AddBeam(beam).end;
  m.AddBody("flange", {2, {}, {0.01, 0.006, 0.006, 0, 0, 0}});
  end.X_BF = end.X_BF * Transform<double>{{}, {0.05, 0, 0}};
  m.AddFixed("weld", end, At("flange"));
  return m.Make();
}

std::string Replace(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

Mechanism Read(const std::string& text) {
  return MakeMechanism(ReadMechanismText(text, "shaft.yaml"));
}

TEST(BeamFile, ASteppedShaftHasTheModesOfTheOneInCode) {
  using Flexibility = BeamDescription::Flexibility;
  const bodies::BeamElements elements = bodies::MakeBeamElements(MakeShaftSegments(), 4);
  const std::pair<const char*, Flexibility> kinds[] = {
      {"torsion", Flexibility::kTorsion},
      {"torsion_and_bending", Flexibility::kTorsionAndBending},
      {"all", Flexibility::kAll}};
  for (const auto& [name, flexibility] : kinds) {
    SCOPED_TRACE(name);
    ExpectSameModes(Read(Replace(kShaft, "y: torsion_and_bending", std::string("y: ") + name)),
                    MakeShaft(elements, flexibility));
  }
}

TEST(BeamFile, TheRootIsTheJointAskedFor) {
  const bodies::BeamElements elements = bodies::MakeBeamElements(MakeShaftSegments(), 4);
  const std::pair<const char*, JointType> roots[] = {{"revolute", JointType::kRevolute},
                                                     {"spherical", JointType::kSpherical},
                                                     {"free", JointType::kFree}};
  for (const auto& [name, type] : roots) {
    const Mechanism mechanism =
        Read(Replace(kShaft, "    elements", std::string("    root: ") + name + "\n    elements"));
    EXPECT_EQ(mechanism.GetJoint("shaft.root").type, type);
    EXPECT_EQ(mechanism.system.model.velocities,
              MakeShaft(elements, BeamDescription::Flexibility::kTorsionAndBending, type)
                  .system.model.velocities);
  }
}

const std::string kTotals = R"(kind: mechanism
gravity: [0, 0, 0]
beams:
  shaft:
    at: [0, 0.1, 0]
    turned: [0, 0, 0.5]
    elements: 3
    totals:
      length: 0.5 m
      mass: 1.5 kg
      axial_inertia: 2e-3
      turning_stiffness: [900, 4000, 5000]
      turning_damping: [0.5, 0.1, 0.2]
bodies:
  flange: {mass: 2 kg, inertia: [0.01, 0.006, 0.006]}
joints:
  weld: {type: fixed, parent: shaft.end, at: [0.05, 0, 0], child: flange}
)";

TEST(BeamFile, ABeamByItsTotalsHasTheModesOfTheOneInCode) {
  const bodies::UniformBeam uniform{
      0.5, 1.5, 2e-3, {0, 0, 0, 900, 4000, 5000}, {0, 0, 0, 0.5, 0.1, 0.2}};
  ExpectSameModes(Read(kTotals), MakeShaft(bodies::MakeBeamElements(uniform, 3),
                                           BeamDescription::Flexibility::kTorsionAndBending));
}

TEST(BeamFile, WithoutElementsItIsARigidLink) {
  // a pendulum: rod of 0.6 m about its end, ω² = (m g l/2)/(m l²/3 + small terms of the section)
  const Mechanism rod = Read(R"(kind: mechanism
beams:
  rod:
    turned: [0, 90 deg, 0]
    root: spherical
    elements: 0
    material: {E: 210 GPa, G: 80 GPa, density: 7850 kg/m^3}
    segments:
      - {length: 0.6 m, section: round, diameter: 10 mm}
)");
  EXPECT_EQ(rod.system.model.velocities, 3);
  const double about_end = 0.6 * 0.6 / 3 + 0.01 * 0.01 / 16;
  const double expected = std::sqrt(9.80665 * 0.3 / about_end) / (2 * M_PI);
  const std::vector<solve::Mode> modes = CalcModes(rod);
  int count = 0;
  for (const solve::Mode& mode : modes) {
    if (mode.frequency == 0) continue;
    ++count;
    EXPECT_NEAR(mode.frequency / expected, 1, 1e-12);
  }
  EXPECT_EQ(count, 2);
}

TEST(BeamFile, ABeamMayBeginAtTheEndOfAnother) {
  const Mechanism mechanism = Read(R"(kind: mechanism
beams:
  first:
    elements: 1
    flexibility: torsion
    totals: {length: 0.5, mass: 1, axial_inertia: 1e-3, turning_stiffness: [100, 0, 0]}
  second:
    body: first.end
    elements: 1
    flexibility: torsion
    totals: {length: 0.5, mass: 1, axial_inertia: 1e-3, turning_stiffness: [100, 0, 0]}
bodies:
  disc: {mass: 1, inertia: [0.01, 0.01, 0.01]}
joints:
  weld: {type: fixed, parent: second.end, child: disc}
)");
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> rate(mechanism.system.size());
  evaluator.CalcRates(0, mechanism.start, rate);
  const mechanism::Frame disc = mechanism.GetBody("disc");
  const auto& w = evaluator.workspace();
  EXPECT_NEAR((w.R[disc.link] * disc.X_LF.p + w.p[disc.link]).x, 1.0, 1e-14);
}

TEST(BeamFile, MistakesAreNamedWithFileLineAndKey) {
  struct Mistake {
    const std::string& text;
    const char *what, *with, *message;
  };
  const Mistake mistakes[] = {
      {kShaft, "elements: 4", "elements: -1", "shaft.yaml:7: beams.shaft.elements"},
      {kShaft, "elements: 4", "elements: 4000", "shaft.yaml:7: beams.shaft.elements"},
      {kShaft, "at: [0, 0.1, 0]", "at: [0, 0.1 kg, 0]", "shaft.yaml:5: beams.shaft.at"},
      {kShaft, "at: [0, 0.1, 0]", "body: wrold", "did you mean 'world'"},
      {kShaft, "turned: [0, 0, 0.5]", "turned: [0, 0]", "shaft.yaml:6: beams.shaft.turned"},
      {kShaft, "y: torsion_and_bending", "y: bending", "shaft.yaml:8: beams.shaft.flexibility"},
      {kShaft, "y: torsion_and_bending", "y: torsion\n    shear: false",
       "shaft.yaml:9: beams.shaft.shear"},
      {kShaft, "y: torsion_and_bending", "y: torsion\n    root: prismatic",
       "shaft.yaml:9: beams.shaft.root"},
      {kShaft, "E: 210 GPa", "E: 210 GN", "shaft.yaml:9: beams.shaft.material.E"},
      {kShaft, "G: 80 GPa", "G: -80 GPa", "shaft.yaml:9: beams.shaft.material.G"},
      {kShaft, "density: 7850 kg/m^3", "density: 0", "shaft.yaml:9: beams.shaft.material.density"},
      {kShaft, "normal_damping: 2e6", "normal_damping: -1",
       "shaft.yaml:9: beams.shaft.material.normal_damping"},
      {kShaft, "shear_damping: 1 MPa s", "shear_damping: 1 MPa",
       "shaft.yaml:9: beams.shaft.material.shear_damping"},
      {kShaft, "length: 300 mm", "length: 0", "shaft.yaml:11: beams.shaft.segments[0].length"},
      {kShaft, "inner: 24 mm", "inner: 34 mm", "shaft.yaml:11: beams.shaft.segments[0]"},
      {kShaft, "inner: 24 mm", "diameter: 24 mm", "shaft.yaml:11: beams.shaft.segments[0]"},
      {kShaft, "end_diameter: 20 mm", "end_outer: 20 mm",
       "shaft.yaml:12: beams.shaft.segments[1].end_outer"},
      {kShaft, "section: rectangle", "section: box", "shaft.yaml:14: beams.shaft.segments[2]"},
      {kShaft, "width: 20 mm", "width: .nan", "shaft.yaml:15: beams.shaft.segments[2].width"},
      {kShaft, "area: 1e-4", "area: -1", "shaft.yaml:18: beams.shaft.segments[3].area"},
      {kShaft, "parent: shaft.end", "parent: shaft.ende",
       "shaft.yaml:22: joints.weld.parent: found 'shaft.ende'"},
      {kShaft, "    material: {E: 210 GPa, G: 80 GPa", "    materail: {E: 210 GPa, G: 80 GPa",
       "did you mean 'material'"},
      {kTotals, "mass: 1.5 kg", "mass: 0", "shaft.yaml:10: beams.shaft.totals.mass"},
      {kTotals, "turning_stiffness: [900,", "turning_stiffness: [-900,",
       "shaft.yaml:12: beams.shaft.totals.turning_stiffness"},
      {kTotals,
       "    totals:", "    segments: [{length: 1, section: round, diameter: 1 cm}]\n    totals:",
       "found segments and totals, expected either segments with a material, or totals"},
  };
  for (const Mistake& m : mistakes) {
    try {
      Read(Replace(m.text, m.what, m.with));
      ADD_FAILURE() << "accepted: " << m.with;
    } catch (const io::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(m.message)) << m.with;
    }
  }
}

}  // namespace
}  // namespace kingpin::joints
