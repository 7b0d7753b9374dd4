#pragma once

#include <vector>

#include "models/validation/case.h"

namespace kingpin::validation {

// One file each, named after what moves.
Case MakePendulumCase();
Case MakeFreeBodyCase();
Case MakeHeavyTopCase();
Case MakeDoublePendulumCase();
Case MakeFourBarRowCase();
Case MakeSqueezerCase();
Case MakeBricardCase();
Case MakeGovernorCase();
Case MakeBicycleCase();
Case MakeSliderCrankCase();
Case MakeCoulombOscillatorCase();
Case MakeStickSlipCase();
Case MakeInclineCase();
Case MakeEveryJointCase();
Case MakeUniversalJointCase();
Case MakeBeamCase();
Case MakeMountsCase();

/// All of them, in the order in which they run.
std::vector<Case> ListCases();

}  // namespace kingpin::validation
