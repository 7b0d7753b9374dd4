#pragma once

#include <complex>
#include <string>
#include <vector>

#include "core/solve/linearise.h"
#include "joints/mechanism_file.h"

namespace kingpin::joints {

/// ẋ = A x + B u, y = C x + D u of a mechanism file about its start, every input and output by
/// name.
///
/// Inputs are the motors, an additional force or torque of each [N, N m], and the forces on bodies:
/// a factor on force and torque as the file gives them [1]. Outputs have the names that signals.csv
/// gives them: COORDINATE, COORDINATE.rate, COORDINATE.acceleration, ROW.reaction, as differences
/// from the state that is linearised about; a rotation by a quaternion is a small turn about the
/// axes of the body, COORDINATE.angular_x and so on [rad].
///
/// B and D are exact: accelerations and reactions are linear in the applied forces, so a column is
/// what one unit alone does to the mechanism at rest without gravity.
struct StateSpace {
  struct Name {
    std::string name, unit;
  };
  solve::Linearisation linear;
  std::vector<Name> inputs, outputs;
  Eigen::MatrixXd B, C, D;
};

/// @param mechanism as MakeMechanism(file) has made it
StateSpace CalcStateSpace(const MechanismFile& file, const Mechanism& mechanism);

/// A frequency response that the file asks for.
struct ResponseCurve {
  std::string name, input, output, unit;
  std::vector<double> frequency;  ///< [Hz], evenly spaced in the logarithm
  std::vector<std::complex<double>> values;
};
std::vector<ResponseCurve> CalcResponses(const MechanismFile& file, const StateSpace& space);

/// Whether every response's input and output exist.
/// @throws io::InputError with file, line and key
void CheckResponses(const MechanismFile& file, const Mechanism& mechanism);

}  // namespace kingpin::joints
