#include "models/parameters/input_kinds.h"

#include "models/parameters/car_derived.h"
#include "models/parameters/car_schema.h"

namespace kingpin::parameters {

void AddInputKinds(io::InputKinds* kinds) {
  kinds->Add<Car>(CarSchema(), {}, CalcDerivedQuantities);
  kinds->Add<Body>(BodySchema());
  kinds->Add<FrontSuspension>(FrontSuspensionSchema());
  kinds->Add<RearSuspension>(RearSuspensionSchema());
  kinds->Add<Steering>(SteeringSchema());
  kinds->Add<Driveline>(DrivelineSchema());
  kinds->Add<Tyres>(TyresSchema());
}

}  // namespace kingpin::parameters
