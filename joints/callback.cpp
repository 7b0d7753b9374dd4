#include "joints/callback.h"

#include "core/math/quaternion.h"

namespace kingpin::joints {

namespace {

constexpr int kLanes = 8;

Vector3<double> GetValue(const Vector3<Dual8>& a) { return {a.x.v, a.y.v, a.z.v}; }
Vector3<double> GetLane(const Vector3<Dual8>& a, int lane) {
  return {a.x.d[lane], a.y.d[lane], a.z.d[lane]};
}
Rotation<double> GetValue(const Rotation<Dual8>& R) {
  return {GetValue(R.x), GetValue(R.y), GetValue(R.z)};
}

// φ with dR = φ × R, from the columns: Σ e_k × de_k = 2 φ
Vector3<double> CalcTurn(const Rotation<Dual8>& R, int lane) {
  return 0.5 *
         (Cross(GetValue(R.x), GetLane(R.x, lane)) + Cross(GetValue(R.y), GetLane(R.y, lane)) +
          Cross(GetValue(R.z), GetLane(R.z, lane)));
}

double CalcSize(const Vector3<double>& a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

}  // namespace

Dual8 CallbackLaw::CalcForce(const Dual8& time, const Dual8& x, const Dual8& rate) const {
  const auto slope = [&](double value, const auto& f) {
    const double h = kDifferenceStep * std::max(1.0, std::abs(value));
    return (f(value + h) - f(value - h)) / (2 * h);
  };
  const double df_dx = slope(x.v, [&](double u) { return force(time.v, u, rate.v); });
  const double df_dv = slope(rate.v, [&](double u) { return force(time.v, x.v, u); });
  Dual8 result(force(time.v, x.v, rate.v));
  for (int lane = 0; lane < kLanes; ++lane) {
    result.d[lane] = df_dx * x.d[lane] + df_dv * rate.d[lane];
  }
  return result;
}

math::Wrench<Dual8> DifferencedWrench::operator()(const Dual8& time,
                                                  const RelativeMotion<Dual8>& motion) const {
  const RelativeMotion<double> at{GetValue(motion.R), GetValue(motion.p), GetValue(motion.v),
                                  GetValue(motion.w)};
  const math::Wrench<double> value = function(time.v, at);
  math::Wrench<Dual8> result{math::Convert<Dual8>(value.t), math::Convert<Dual8>(value.f)};
  for (int lane = 0; lane < kLanes; ++lane) {
    const Vector3<double> turn = CalcTurn(motion.R, lane);
    const Vector3<double> dp = GetLane(motion.p, lane), dv = GetLane(motion.v, lane),
                          dw = GetLane(motion.w, lane);
    const double size = std::max({CalcSize(turn), CalcSize(dp), CalcSize(dv), CalcSize(dw)});
    if (size == 0) continue;
    const double h = kDifferenceStep / size;
    const auto evaluate = [&](double step) {
      return function(time.v, {math::MakeRotation(math::MakeQuaternion(step * turn)) * at.R,
                               at.p + step * dp, at.v + step * dv, at.w + step * dw});
    };
    const math::Wrench<double> slope = (1 / (2 * h)) * (evaluate(h) - evaluate(-h));
    result.t.x.d[lane] = slope.t.x, result.t.y.d[lane] = slope.t.y, result.t.z.d[lane] = slope.t.z;
    result.f.x.d[lane] = slope.f.x, result.f.y.d[lane] = slope.f.y, result.f.z.d[lane] = slope.f.z;
  }
  return result;
}

}  // namespace kingpin::joints
