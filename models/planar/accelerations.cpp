#include "models/planar/accelerations.h"

#include <cmath>

namespace kingpin::planar {

Dynamics<double> CalcForces(const Model<double>& model, const State<double>& x, double road_force,
                            double slip) {
  Dynamics<double> out;
  CalcDynamics(model.structure, model.constants, x, road_force, slip, out);
  return out;
}

void CalcAccelerations(const Model<double>& model, const State<double>& x, double road_force,
                       double* a, double slip) {
  const Dynamics<double> out = CalcForces(model, x, road_force, slip);
  for (int i = 0; i < kCoordinates; ++i) a[i] = out.a[i];
}

double CalcSlip(const Model<double>& model, const State<double>& x, double road_force) {
  if (x.v[3] != 0) return x.v[3] > 0 ? 1.0 : -1.0;
  const Dynamics<double> held = CalcForces(model, x, road_force, 0.0);
  if (std::abs(held.friction_force) <= held.friction_limit) return 0;
  return held.friction_force < 0 ? 1.0 : -1.0;
}

double CalcKineticEnergy(const Model<double>& model, const State<double>& x) {
  return CalcKineticEnergy(model.constants, x);
}

double CalcPotentialEnergy(const Model<double>& model, const State<double>& x) {
  return CalcPotentialEnergy(model.structure, model.constants, x);
}

}  // namespace kingpin::planar
