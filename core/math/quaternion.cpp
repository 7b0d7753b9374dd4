#include "core/math/quaternion.h"

#include <cmath>

namespace kingpin::math {

Quaternion<double> MakeQuaternion(const Rotation<double>& R) {
  const double trace = R.x.x + R.y.y + R.z.z;
  Quaternion<double> q;
  if (trace >= R.x.x && trace >= R.y.y && trace >= R.z.z) {
    q = {1.0 + trace, R.y.z - R.z.y, R.z.x - R.x.z, R.x.y - R.y.x};
  } else if (R.x.x >= R.y.y && R.x.x >= R.z.z) {
    q = {R.y.z - R.z.y, 1.0 + R.x.x - R.y.y - R.z.z, R.x.y + R.y.x, R.z.x + R.x.z};
  } else if (R.y.y >= R.z.z) {
    q = {R.z.x - R.x.z, R.x.y + R.y.x, 1.0 + R.y.y - R.x.x - R.z.z, R.y.z + R.z.y};
  } else {
    q = {R.x.y - R.y.x, R.z.x + R.x.z, R.y.z + R.z.y, 1.0 + R.z.z - R.x.x - R.y.y};
  }
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  const double scale = (q.w < 0 ? -1.0 : 1.0) / norm;
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

Quaternion<double> MakeQuaternion(const Vector3<double>& r) {
  const double angle = CalcNorm(r);
  // sin(a/2)/a by its series where the quotient would lose digits
  const double a2 = angle * angle;
  const double s =
      angle < 1e-3 ? 0.5 - a2 / 48.0 + a2 * a2 / 3840.0 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), s * r.x, s * r.y, s * r.z};
}

Rotation<double> MakeRotationWithZ(const Vector3<double>& z) {
  const double ax = std::abs(z.x), ay = std::abs(z.y), az = std::abs(z.z);
  Vector3<double> x = {1, 0, 0};
  if (ay < ax && ay <= az) x = {0, 1, 0};
  if (az < ax && az < ay) x = {0, 0, 1};
  x = x - Dot(x, z) * z;
  x = (1.0 / CalcNorm(x)) * x;
  return {x, Cross(z, x), z};
}

}  // namespace kingpin::math
