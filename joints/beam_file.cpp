#include "joints/beam_file.h"

#include <stdexcept>

#include <fmt/format.h>

#include "joints/fail.h"

namespace kingpin::joints {

namespace {

using Material = FileBeamMaterial;
using Segment = FileBeamSegment;
using Shape = FileBeamShape;
using Totals = FileBeamTotals;

const io::Schema<Material>& MaterialSchema() {
  static const io::Schema<Material> schema = [] {
    io::Schema<Material> s("material", "Elastic material with Kelvin-Voigt damping.");
    s.Quantity("E", &Material::E, "Pa", "Young's modulus").Positive();
    s.Quantity("G", &Material::G, "Pa", "shear modulus").Positive();
    s.Quantity("density", &Material::density, "kg/m^3", "density").Positive();
    s.Quantity("normal_damping", &Material::normal_damping, "Pa s",
               "stress per strain rate in tension and bending")
        .NonNegative()
        .Default("0 Pa s");
    s.Quantity("shear_damping", &Material::shear_damping, "Pa s",
               "stress per strain rate in torsion and shear")
        .NonNegative()
        .Default("0 Pa s");
    return s;
  }();
  return schema;
}

const io::Schema<Segment>& SegmentSchema() {
  static const io::Schema<Segment> schema = [] {
    io::Schema<Segment> s("segment", "A piece of a beam, of one section or a taper.");
    s.Quantity("length", &Segment::length, "m", "length of the piece").Positive();
    s.Choice("section", &Segment::shape,
             {{"round", Shape::kRound, "solid circle"},
              {"tube", Shape::kTube, "circular tube"},
              {"rectangle", Shape::kRectangle, "solid rectangle"},
              {"given", Shape::kGiven, "numbers of the section"}},
             "shape of the section");
    const auto size = [&s](const char* key, auto member, auto end_member, const char* shape,
                           const char* text) {
      s.Quantity(key, member, "m", text).Positive().OnlyIf("section", {shape});
      s.Quantity(fmt::format("end_{}", key), end_member, "m",
                 fmt::format("{}, at the far end; absent: the same all along", text))
          .Positive()
          .OnlyIf("section", {shape})
          .Optional();
    };
    size("diameter", &Segment::diameter, &Segment::end_diameter, "round", "diameter");
    size("outer", &Segment::outer, &Segment::end_outer, "tube", "outer diameter");
    size("inner", &Segment::inner, &Segment::end_inner, "tube", "inner diameter");
    size("width", &Segment::width, &Segment::end_width, "rectangle", "along y");
    size("height", &Segment::height, &Segment::end_height, "rectangle", "along z");
    const auto given = [&s](const char* key, auto member, const char* unit, const char* text) {
      return s.Quantity(key, member, unit, text).Positive().OnlyIf("section", {"given"});
    };
    given("area", &Segment::area, "m^2", "A");
    given("Iy", &Segment::Iy, "m^4", "∫z² dA, of bending about y");
    given("Iz", &Segment::Iz, "m^4", "∫y² dA, of bending about z");
    given("torsion_constant", &Segment::torsion_constant, "m^4", "J");
    given("shear_y", &Segment::shear_y, "1", "form factor of shear along y").Default("1.2");
    given("shear_z", &Segment::shear_z, "1", "form factor of shear along z").Default("1.2");
    s.Section("material", &Segment::material, MaterialSchema(), "if not that of the beam")
        .Optional();
    return s;
  }();
  return schema;
}

const io::Schema<Totals>& TotalsSchema() {
  static const io::Schema<Totals> schema = [] {
    io::Schema<Totals> s("totals",
                         "A uniform beam by what was measured on the whole: end load over end "
                         "displacement.");
    s.Quantity("length", &Totals::length, "m", "length").Positive();
    s.Quantity("mass", &Totals::mass, "kg", "mass").Positive();
    s.Quantity("axial_inertia", &Totals::axial_inertia, "kg m^2", "about its axis").Positive();
    s.Point("stiffness", &Totals::stiffness, "N/m", "tension, shear along y, along z")
        .Default("[0, 0, 0]");
    s.Point("turning_stiffness", &Totals::turning_stiffness, "N m/rad",
            "torsion, bending about y, about z");
    s.Point("damping", &Totals::damping, "N s/m", "as stiffness").Default("[0, 0, 0]");
    s.Point("turning_damping", &Totals::turning_damping, "N m s/rad", "as turning_stiffness")
        .Default("[0, 0, 0]");
    s.Check([](const Totals& t, io::Check& check) {
      const auto look = [&check](const char* key, const FilePoint& values) {
        for (double value : values) {
          if (value < 0) {
            check.Fail(key, fmt::format("{:g}", value), "numbers that are not negative");
            return;
          }
        }
      };
      look("stiffness", t.stiffness);
      look("turning_stiffness", t.turning_stiffness);
      look("damping", t.damping);
      look("turning_damping", t.turning_damping);
    });
    return s;
  }();
  return schema;
}

bodies::BeamMaterial MakeMaterial(const Material& m) {
  return {m.E, m.G, m.density, m.normal_damping, m.shear_damping};
}

bodies::BeamSegment MakeSegment(const Segment& s, const bodies::BeamMaterial& material) {
  bodies::BeamSegment segment;
  segment.length = s.length;
  segment.material = material;
  switch (s.shape) {
    case Shape::kRound:
      segment.section = bodies::RoundSection{s.diameter};
      if (s.end_diameter) segment.end = bodies::RoundSection{*s.end_diameter};
      break;
    case Shape::kTube:
      segment.section = bodies::TubeSection{s.outer, s.inner};
      if (s.end_outer || s.end_inner) {
        segment.end =
            bodies::TubeSection{s.end_outer.value_or(s.outer), s.end_inner.value_or(s.inner)};
      }
      break;
    case Shape::kRectangle:
      segment.section = bodies::RectangularSection{s.width, s.height};
      if (s.end_width || s.end_height) {
        segment.end = bodies::RectangularSection{s.end_width.value_or(s.width),
                                                 s.end_height.value_or(s.height)};
      }
      break;
    case Shape::kGiven:
      segment.section =
          bodies::GivenSection{s.area, s.Iy, s.Iz, s.torsion_constant, s.shear_y, s.shear_z};
      break;
  }
  return segment;
}

}  // namespace

const io::Schema<FileBeam>& FileBeamSchema() {
  using Flexibility = BeamDescription::Flexibility;
  static const io::Schema<FileBeam> schema = [] {
    io::Schema<FileBeam> s(
        "beam",
        "A beam or shaft of rigid finite elements. A beam NAME has bodies NAME.0, NAME.1, ..., "
        "joints NAME.root, NAME.joint1, ..., and the frame NAME.end at its far end, to be used "
        "like a body.");
    s.Text("body", &FileBeam::body, "body in which it begins").Default("world");
    s.Point("at", &FileBeam::at, "m", "where it begins, in that body").Default("[0, 0, 0]");
    s.Point("turned", &FileBeam::turned, "rad",
            "rotation vector of its frame in that body; it lies along x")
        .Default("[0, 0, 0]");
    s.Choice("root", &FileBeam::root,
             {{"fixed", JointType::kFixed, "clamped"},
              {"revolute", JointType::kRevolute, "turns about its axis"},
              {"spherical", JointType::kSpherical, "held in a ball joint"},
              {"free", JointType::kFree, "held by what else is attached to it"}},
             "how it hangs on that body")
        .Default("fixed");
    s.Integer("elements", &FileBeam::elements, "springs along it; 0: a rigid link")
        .Min(0)
        .Max(kMostFileElements);
    s.Choice("flexibility", &FileBeam::flexibility,
             {{"torsion", Flexibility::kTorsion, "twists only: one coordinate for each spring"},
              {"torsion_and_bending", Flexibility::kTorsionAndBending,
               "twists and bends: three coordinates for each"},
              {"all", Flexibility::kAll, "with shear and tension: up to six"}},
             "how it deforms")
        .Default("torsion_and_bending");
    s.Boolean("shear", &FileBeam::shear, "with shear")
        .Default("true")
        .OnlyIf("flexibility", {"all"});
    s.Boolean("tension", &FileBeam::tension, "with tension")
        .Default("true")
        .OnlyIf("flexibility", {"all"});
    s.Section("material", &FileBeam::material, MaterialSchema(),
              "of all segments that name no other")
        .Optional();
    s.List("segments", &FileBeam::segments, SegmentSchema(),
           "its pieces from its beginning; stepped and tapered shafts have several")
        .Optional();
    s.Section("totals", &FileBeam::totals, TotalsSchema(),
              "a uniform beam by its stiffness, instead of segments")
        .Optional();
    s.Check([](const FileBeam& beam, io::Check& check) {
      if (beam.totals.has_value() == !beam.segments.empty()) {
        check.Fail(beam.totals ? "totals" : "",
                   beam.totals ? "segments and totals" : "neither segments nor totals",
                   "either segments with a material, or totals");
      }
      for (size_t i = 0; i < beam.segments.size(); ++i) {
        if (beam.material || beam.segments[i].material) continue;
        check.Fail(fmt::format("segments[{}]", i), "no material",
                   "one of this segment or of the whole beam");
      }
    });
    return s;
  }();
  return schema;
}

BeamDescription MakeBeamDescription(const std::string& name, const FileBeam& beam,
                                    const std::function<Source(const std::string& key)>& find) {
  BeamDescription result;
  result.name = name;
  result.at = {beam.body, MakePose(beam.at, beam.turned)};
  result.flexibility = beam.flexibility;
  result.shear = beam.shear;
  result.tension = beam.tension;
  result.root = beam.root;
  result.source = find("");
  const std::string path = "beams." + name;
  const auto make = [&](const auto& input) {
    try {
      return bodies::MakeBeamElements(input, beam.elements);
    } catch (const std::invalid_argument& error) {
      Fail(find(""), path, error.what(), "a beam that can be made");
    }
  };
  if (beam.totals) {
    const Totals& t = *beam.totals;
    bodies::UniformBeam uniform{t.length, t.mass, t.axial_inertia, {}, {}};
    for (int i = 0; i < 3; ++i) {
      uniform.stiffness[i] = t.stiffness[i];
      uniform.stiffness[3 + i] = t.turning_stiffness[i];
      uniform.damping[i] = t.damping[i];
      uniform.damping[3 + i] = t.turning_damping[i];
    }
    result.elements = make(uniform);
    return result;
  }
  std::vector<bodies::BeamSegment> segments;
  for (size_t i = 0; i < beam.segments.size(); ++i) {
    const Segment& segment = beam.segments[i];
    segments.push_back(
        MakeSegment(segment, MakeMaterial(segment.material ? *segment.material : *beam.material)));
    // by itself, so that a mistake has its line
    const bodies::BeamSegment& made = segments.back();
    try {
      bodies::CalcSection(made.section);
      if (made.end) bodies::CalcSection(*made.end);
    } catch (const std::invalid_argument& error) {
      const std::string key = fmt::format("segments[{}]", i);
      Fail(find(key), fmt::format("{}.{}", path, key), error.what(), "a section that can be made");
    }
  }
  result.elements = make(segments);
  return result;
}

}  // namespace kingpin::joints
