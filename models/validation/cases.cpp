#include "models/validation/cases.h"

namespace kingpin::validation {

std::vector<Case> ListCases() {
  return {MakePendulumCase(),
          MakeFourBarRowCase(),
          MakeSqueezerCase(),
          MakeBricardCase(),
          MakeGovernorCase(),
          MakeBicycleCase(),
          MakeFreeBodyCase(),
          MakeHeavyTopCase(),
          MakeDoublePendulumCase(),
          MakeSliderCrankCase(),
          MakeCoulombOscillatorCase(),
          MakeStickSlipCase(),
          MakeInclineCase(),
          MakeEveryJointCase(),
          MakeUniversalJointCase(),
          MakeBeamCase(),
          MakeMountsCase()};
}

}  // namespace kingpin::validation
