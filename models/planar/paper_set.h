#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "models/planar/excitation.h"
#include "models/planar/parameters.h"

/// The identified parameter sets of the paper (`examples/paper/set_A.json` and its like): explicit
/// numbers, from which paper mode runs.
namespace kingpin::planar {

struct PaperDesign {
  double rack_half_length = 0;  ///< r_L [m]
  double rack_position = 0;     ///< r_X [m]
  double outer_joint_x = 0;     ///< x_tr [m]
  double outer_joint_y = 0;     ///< y_tr [m]
  /// The parameters of the set with this design, and with whatever else it changes (friction,
  /// one-way rod, aligning stiffness).
  Parameters<double> parameters;
};

struct PaperSet {
  std::string name;               ///< `A`, `B` or `C`
  double gamma_3_scale = 1;       ///< c3, the scale of the printed Γ_3
  Parameters<double> parameters;  ///< with the set's own design
  std::vector<Pulse> pulses;      ///< three cubed parabolas
  std::map<std::string, PaperDesign> designs;
};

/// Throws io::InputError with file and key for a file that cannot be read, a missing key, a wrong
/// type, a number that is not finite, curves of unequal length, or parameters that make no model.
PaperSet ReadPaperSet(const std::filesystem::path& file);

}  // namespace kingpin::planar
