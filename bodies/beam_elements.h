#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bodies/beam_section.h"
#include "bodies/rigid_inertia.h"

namespace kingpin::bodies {

/// Kelvin-Voigt material: σ = E ε + η_normal ε̇, τ = G γ + η_shear γ̇.
struct BeamMaterial {
  double E = 0, G = 0;                   ///< [Pa]
  double density = 0;                    ///< [kg/m³]
  double eta_normal = 0, eta_shear = 0;  ///< [Pa s]
};

/// A piece of a beam: one material, one section or a taper between two of one shape.
struct BeamSegment {
  double length = 0;  ///< [m]
  Section section;
  std::optional<Section> end;  ///< absent: the same all along
  BeamMaterial material;
};

/// Rigid finite elements of a straight beam along x.
///
/// Primary division: n equal lengths Δ, one massless spring-damper element in the middle of each.
/// Secondary division: the n + 1 rigid elements between the springs, the two end ones Δ/2 long, the
/// others Δ. Stiffness of a spring about one of its axes: that of the length Δ it stands for,
///
///   tension E A/Δ, shear G A/(κ Δ), torsion G J/Δ, bending E I/Δ
///
/// where sections vary, 1/∫ds/(E A) over Δ and so on; damping k² ∫η/(E² A) ds, which is η/E times
/// the stiffness for one material. n = 0 is a rigid link.
///
/// Source: Wittbrodt, Adamiec-Wójcik, Wojciech, Dynamics of Flexible Multibody Systems. Rigid
/// Finite Element Method (2006). Exact for every n: twist under an end torque, slope under an end
/// moment. Deflection under an end force: F L³/(3 E I) (1 - 1/(4 n²)) + κ F L/(G A). Natural
/// frequencies converge with order 2.
struct BeamElements {
  struct Spring {
    double position = 0;  ///< x [m]
    /// Tension, shear along y and z, torsion, bending about y and z.
    std::array<double, 6> stiffness{}, damping{};
  };
  struct Element {
    double start = 0, end = 0;  ///< x [m]
    RigidInertia inertia;       ///< axes of the beam, origin at `start`
  };
  double length = 0;
  std::vector<Element> elements;
  std::vector<Spring> springs;  ///< springs[k] between elements k and k + 1
};

/// @param n number of springs over the whole length, however many segments there are
/// @throws std::invalid_argument saying which segment and number is wrong
BeamElements MakeBeamElements(const std::vector<BeamSegment>& segments, int n);

/// A uniform beam by its totals, as measured.
struct UniformBeam {
  double length = 0;         ///< [m]
  double mass = 0;           ///< [kg]
  double axial_inertia = 0;  ///< about x [kg m²]
  std::array<double, 6>
      stiffness{};  ///< whole length, order of Spring: end load / end displacement
  std::array<double, 6> damping{};
};

/// @throws std::invalid_argument as above
BeamElements MakeBeamElements(const UniformBeam& beam, int n);

}  // namespace kingpin::bodies
