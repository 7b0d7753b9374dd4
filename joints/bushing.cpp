#include "joints/bushing.h"

#include "joints/relative_motion.h"

namespace kingpin::joints {

namespace {

template <class S>
struct Deflection {
  S x[6], rate[6];

  Deflection(const RelativeMotion<S>& motion, const RotationVector<S>& rotation)
      : Deflection(motion.p, rotation.r, motion.v, rotation.CalcRate(motion.w)) {}

 private:
  Deflection(const Vector3<S>& d, const Vector3<S>& r, const Vector3<S>& d_dot,
             const Vector3<S>& r_dot)
      : x{d.x, d.y, d.z, r.x, r.y, r.z}, rate{d_dot.x, d_dot.y, d_dot.z,
                                              r_dot.x, r_dot.y, r_dot.z} {}
};

}  // namespace

template <class S>
void Bushing::AddForces(const mechanism::ForceContext<S>& context) const {
  const FramePair<S> pair(context.w, a, b);
  const RelativeMotion<S> motion = pair.CalcMotion(context.w, a.link, b.link);
  const RotationVector<S> rotation(motion.R);
  const Deflection<S> at(motion, rotation);
  S Q[6];
  for (int i = 0; i < 6; ++i) Q[i] = -(stiffness[i](at.x[i]) + preload[i] + damping[i](at.rate[i]));
  if (coupled) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) Q[i] = Q[i] - (K[i][j] * at.x[j] + C[i][j] * at.rate[j]);
    }
  }
  const Vector3<S> torque = rotation.CalcTorque({Q[3], Q[4], Q[5]});
  AddBetween(context.w, a.link, b.link, pair.p_B, pair.R_A * Vector3<S>{Q[0], Q[1], Q[2]},
             pair.R_A * torque);
}

template void Bushing::AddForces(const mechanism::ForceContext<double>&) const;
template void Bushing::AddForces(const mechanism::ForceContext<mechanism::Dual8>&) const;

mechanism::EnergyRates Bushing::CalcEnergy(const mechanism::ForceContext<double>& context) const {
  const FramePair<double> pair(context.w, a, b);
  const RelativeMotion<double> motion = pair.CalcMotion(context.w, a.link, b.link);
  const Deflection<double> at(motion, RotationVector<double>(motion.R));
  mechanism::EnergyRates energy;
  for (int i = 0; i < 6; ++i) {
    energy.potential += stiffness[i].CalcIntegral(at.x[i]) + preload[i] * at.x[i];
    energy.dissipated += damping[i](at.rate[i]) * at.rate[i];
    for (int j = 0; j < 6; ++j) {
      energy.potential += 0.5 * at.x[i] * K[i][j] * at.x[j];
      energy.dissipated += at.rate[i] * C[i][j] * at.rate[j];
    }
  }
  return energy;
}

}  // namespace kingpin::joints
