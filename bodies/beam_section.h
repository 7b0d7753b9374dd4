#pragma once

#include <array>
#include <variant>

namespace kingpin::bodies {

// Cross-sections of a beam along x, symmetric to y and z. Sizes in metres.

struct RoundSection {
  double diameter = 0;
};
struct TubeSection {
  double outer = 0, inner = 0;  ///< diameters
};
struct RectangularSection {
  double width = 0;   ///< along y
  double height = 0;  ///< along z
};
struct GivenSection {
  double area = 0;                      ///< A [m²]
  double Iy = 0, Iz = 0;                ///< ∫z² dA and ∫y² dA [m⁴]
  double torsion_constant = 0;          ///< J [m⁴]; Iy + Iz for round sections only
  double shear_y = 1.2, shear_z = 1.2;  ///< form factors κ: shear stiffness G A/κ
};
using Section = std::variant<RoundSection, TubeSection, RectangularSection, GivenSection>;

/// All numbers of a section. Form factors κ: 1.2 rectangle, 10/9 solid circle, 2 thin tube (energy
/// method, as in Wittbrodt, Adamiec-Wójcik, Wojciech, 2006); a thick tube between them,
/// κ = (10 (1 + m²)² + 32 m²)/(9 (1 + m²)²) with the ratio of diameters m, the shape of Cowper's
/// formula (J. Appl. Mech. 33, 1966). Others are given by GivenSection. Torsion of the rectangle by
/// Saint-Venant's series.
/// @throws std::invalid_argument for sizes that are not positive, or an inner diameter not below
/// the outer
GivenSection CalcSection(const Section& section);

/// The section between two of one shape at the fraction s of the way: sizes linear (a cone for
/// round ones), given numbers linear, too.
/// @throws std::invalid_argument for two shapes
Section Interpolate(const Section& from, const Section& to, double s);

}  // namespace kingpin::bodies
