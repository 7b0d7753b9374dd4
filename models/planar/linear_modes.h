#pragma once

#include <array>
#include <complex>
#include <string>
#include <string_view>
#include <vector>

#include "models/planar/linear_model.h"

/// Modes of a linear planar model: eigenvalues λ and eigenvectors of A.
///
/// - oscillatory: a pair λ = −ζ ω ± i ω sqrt(1 − ζ²), listed once; frequency ω/(2π), damping
///   ratio ζ = −Re λ/|λ| (negative when unstable)
/// - overdamped: a real pole, listed singly with its rate −λ [1/s]; a rod mode with
///   stiffness-proportional damping often splits into a slow and a very fast one
/// - drift: λ = 0, the free turning of the steering (double without any damping on it)
/// - lag: a real pole that lives in an extra state (assistance, aligning torque) rather than in a
///   coordinate
namespace kingpin::planar {

enum class ModeKind { kDrift, kOscillatory, kOverdamped, kLag };

std::string_view ToString(ModeKind kind);

struct Mode {
  ModeKind kind = ModeKind::kOscillatory;
  std::complex<double> eigenvalue;          ///< [1/s]; upper one of a pair; exactly 0 for drift
  double frequency = 0.0;                   ///< |λ|/(2π) [Hz], undamped natural frequency
  double damped_frequency = 0.0;            ///< |Im λ|/(2π) [Hz]
  double damping_ratio = 0.0;               ///< −Re λ/|λ|; 1 for overdamped, 0 for drift
  double time_constant = 0.0;               ///< −1/Re λ [s]; 0 where there is none
  std::vector<std::complex<double>> shape;  ///< eigenvector over all states of the model, largest
                                            ///< mass-weighted coordinate real, Σ m |q|² = 1
  /// Shares of the kinetic energy in the five coordinates; they sum to 1.
  std::array<double, 5> shares{};
  int dominant = 0;     ///< coordinate with the largest share
  std::string summary;  ///< e.g. `18.8 Hz, 3.1 %, carrier x (94 %)`
};

struct Modes {
  std::vector<Mode> modes;    ///< ascending |λ|
  bool stable = true;         ///< no eigenvalue with a positive real part; drift is allowed
  double fastest_rate = 0.0;  ///< max |λ| [1/s]: sets the step of explicit methods
  /// Largest stable step of the classical Runge-Kutta method for this A [s]; infinite when A = 0.
  double rk4_step_limit = 0.0;
};

/// @throws io::RunError when the eigenvalue iteration does not converge or A is not finite.
Modes CalcModes(const LinearModel& model);

}  // namespace kingpin::planar
