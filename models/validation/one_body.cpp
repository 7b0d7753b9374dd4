#include "models/validation/one_body.h"

namespace kingpin::validation {

namespace {

using Vector = OneBody::Vector;

void Set(Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& A, int row, int column,
         const Vector& v) {
  A(row, column) = v.x;
  A(row, column + 1) = v.y;
  A(row, column + 2) = v.z;
}

void Put(const Vector& v, Real* to) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

Vector Take(const Real* from) { return {from[0], from[1], from[2]}; }

}  // namespace

void OneBody::HoldPoint(const Vector& r, const Vector& n) {
  constraints.push_back([=](const Place& place) {
    const Vector arm = place.R * r;
    return Row{n, Cross(arm, n), -Dot(n, Cross(place.spin, Cross(place.spin, arm)))};
  });
}

void OneBody::HoldPerpendicular(const Vector& u, const Vector& w) {
  constraints.push_back([=](const Place& place) {
    const Vector e = place.R * u;
    return Row{{}, Cross(e, w), -Dot(w, Cross(place.spin, Cross(place.spin, e)))};
  });
}

void OneBody::HoldDistance(const Vector& r, const Vector& ground) {
  constraints.push_back([=](const Place& place) {
    const Vector arm = place.R * r, d = place.GetPoint(r) - ground, v = place.GetVelocity(r);
    return Row{d, Cross(arm, d), -Dot(d, Cross(place.spin, Cross(place.spin, arm))) - Dot(v, v)};
  });
}

void OneBody::HoldPitch(const Vector& r, const Vector& n, Real pitch) {
  constraints.push_back([=](const Place& place) {
    const Vector arm = place.R * r;
    return Row{n, Cross(arm, n) - pitch * n, -Dot(n, Cross(place.spin, Cross(place.spin, arm)))};
  });
}

State OneBody::MakeStart() const {
  State y(18, 0);
  Put(centre, &y[0]);
  y[3] = y[7] = y[11] = 1;
  return y;
}

OneBody::Place OneBody::GetPlace(const State& y) {
  return {Take(&y[0]), Take(&y[12]), Take(&y[15]), {Take(&y[3]), Take(&y[6]), Take(&y[9])}};
}

OneBody::Vector OneBody::CalcInertiaTimes(const Place& place, const Vector& w) const {
  const Vector local = place.R.TransposeTimes(w);
  const Eigen::Matrix<Real, 3, 1> h =
      inertia * Eigen::Matrix<Real, 3, 1>(local.x, local.y, local.z);
  return place.R * Vector{h[0], h[1], h[2]};
}

OneBody::Accelerations OneBody::CalcAccelerations(const Place& place) const {
  const int rows = static_cast<int>(constraints.size());
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> A(6 + rows, 6 + rows);
  Eigen::Matrix<Real, Eigen::Dynamic, 1> b(6 + rows);
  A.setZero();
  for (int i = 0; i < 3; ++i) {
    A(i, i) = mass;
    const Vector e{Real(i == 0), Real(i == 1), Real(i == 2)};
    Set(A, 3 + i, 3, CalcInertiaTimes(place, e));  // symmetric
  }
  const Load outer = load ? load(place) : Load{};
  Put(mass * gravity + outer.force, &b[0]);
  Put(outer.torque - Cross(place.spin, CalcInertiaTimes(place, place.spin)), &b[3]);
  for (int r = 0; r < rows; ++r) {
    const Row row = constraints[r](place);
    Set(A, 6 + r, 0, row.n);
    Set(A, 6 + r, 3, row.t);
    A.block(0, 6 + r, 6, 1) = A.block(6 + r, 0, 1, 6).transpose();
    b[6 + r] = row.c;
  }
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> x = A.partialPivLu().solve(b);
  return {Take(&x[0]), Take(&x[3])};
}

OneBody::Load OneBody::CalcTransmitted(const State& y) const {
  const Place place = GetPlace(y);
  const Accelerations a = CalcAccelerations(place);
  return {mass * (a.linear - gravity), CalcInertiaTimes(place, a.angular) +
                                           Cross(place.spin, CalcInertiaTimes(place, place.spin))};
}

void OneBody::Advance(Real from, Real to, State& y) const {
  Integrate(
      [this](Real, const State& s, State& rate) {
        const Place place = GetPlace(s);
        const Accelerations a = CalcAccelerations(place);
        Put(place.velocity, &rate[0]);
        Put(Cross(place.spin, place.R.x), &rate[3]);
        Put(Cross(place.spin, place.R.y), &rate[6]);
        Put(Cross(place.spin, place.R.z), &rate[9]);
        Put(a.linear, &rate[12]);
        Put(a.angular, &rate[15]);
      },
      from, to, y, 1e-15L);  // what rounding in the dense solution allows
}

}  // namespace kingpin::validation
