#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/io/schema.h"
#include "joints/beam.h"
#include "joints/file_frame.h"

namespace kingpin::joints {

/// Most springs of one beam in a file: each has up to six coordinates.
inline constexpr int kMostFileElements = 500;

struct FileBeamMaterial {
  double E = 0, G = 0, density = 0, normal_damping = 0, shear_damping = 0;
};

enum class FileBeamShape { kRound, kTube, kRectangle, kGiven };

struct FileBeamSegment {
  double length = 0;
  FileBeamShape shape = FileBeamShape::kRound;
  double diameter = 0, outer = 0, inner = 0, width = 0, height = 0;
  std::optional<double> end_diameter, end_outer, end_inner, end_width, end_height;
  double area = 0, Iy = 0, Iz = 0, torsion_constant = 0, shear_y = 1.2, shear_z = 1.2;
  std::optional<FileBeamMaterial> material;
};

/// What was measured on a whole uniform beam.
struct FileBeamTotals {
  double length = 0, mass = 0, axial_inertia = 0;
  FilePoint stiffness{}, turning_stiffness{}, damping{}, turning_damping{};
};

/// A beam as a mechanism file says it (`beams:`): a list of segments of one material or several, or
/// the totals of a uniform one.
struct FileBeam {
  std::string body = kWorld;
  FilePoint at{}, turned{};
  JointType root = JointType::kFixed;
  int elements = 0;
  BeamDescription::Flexibility flexibility = BeamDescription::Flexibility::kTorsionAndBending;
  bool shear = true, tension = true;
  std::optional<FileBeamMaterial> material;
  std::vector<FileBeamSegment> segments;
  std::optional<FileBeamTotals> totals;
};

const io::Schema<FileBeam>& FileBeamSchema();

/// `find` gives the place of a key below the beam, such as `segments[1].diameter`.
/// @throws io::InputError with file, line and key for sizes no beam can have
BeamDescription MakeBeamDescription(const std::string& name, const FileBeam& beam,
                                    const std::function<Source(const std::string& key)>& find);

}  // namespace kingpin::joints
