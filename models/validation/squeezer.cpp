#include <Eigen/Dense>
#include <cmath>

#include <fmt/format.h>

#include "joints/add_forces.h"
#include "models/validation/cases.h"
#include "models/validation/extrapolation.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double m1 = 0.04325, m2 = 0.00365, m3 = 0.02373, m4 = 0.00706, m5 = 0.07050, m6 = 0.00706,
                 m7 = 0.05498;
constexpr double i1 = 2.194e-6, i2 = 4.41e-7, i3 = 5.255e-6, i4 = 5.667e-7, i5 = 1.169e-5,
                 i6 = 5.667e-7, i7 = 1.912e-5;
constexpr double xa = -0.06934, ya = -0.00227, xb = -0.03635, yb = 0.03273, xc = 0.014, yc = 0.072;
constexpr double c0 = 4530, l0 = 0.07785, mom = 0.033;
constexpr double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092,
                 ss = 0.035, sa = 0.01874, sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308,
                 tb = 0.00916, u = 0.04, ua = 0.01228, ub = 0.00449, zf = 0.02, zt = 0.04,
                 fa = 0.01421;
constexpr double kDuration = 0.03;

// beta, theta, gamma, phi, delta, omega, epsilon
constexpr const char* kNames[] = {"beta", "theta", "gamma", "phi", "delta", "omega", "epsilon"};
constexpr Real kStart[] = {-0.0617138900142764496358948458001L, 0,
                           0.455279819163070380255912382449L,   0.222668390165885884674473185609L,
                           0.487364979543842550225598953530L,   -0.222668390165885884674473185609L,
                           1.23054744454982119249735015568L};
constexpr double kPublished[] = {15.81077119629904,   -15.75637105984298, 0.04082224013073101,
                                 -0.5347301163226948, 0.5244099658805304, 0.5347301163226948,
                                 1.048080741042263};

// Bars as a tree of hinges about z, whose angles are the seven angles of the published equations.
Mechanism MakeSqueezer() {
  MechanismDescription m;
  m.name = "squeezer";
  m.gravity = {};
  const auto body = [&](const char* name, double mass, const Vector3<double>& centre,
                        double inertia) {
    // only the motion in the plane matters
    m.bodies.push_back(MakeBody(name, mass, centre, {inertia, inertia, inertia, 0, 0, 0}));
  };
  const auto hinge = [&](int angle, const std::string& parent, const Vector3<double>& at,
                         const std::string& child) {
    m.joints.push_back(MakeJoint(kNames[angle], JointType::kRevolute, parent, at, child));
    m.joints.back().position = {static_cast<double>(kStart[angle])};
  };
  body("K1", m1, {ra, 0, 0}, i1);
  body("K2", m2, {-da, 0, 0}, i2);   // from F; E lies at -x
  body("K3", m3, {sb, -sa, 0}, i3);  // from B; E lies at -y
  body("K4", m4, {0, -(e - ea), 0}, i4);
  body("K5", m5, {ta, tb, 0}, i5);
  body("K6", m6, {zf - fa, 0, 0}, i6);
  body("K7", m7, {-ub, -ua, 0}, i7);
  hinge(0, kWorld, {}, "K1");
  hinge(1, "K1", {rr, 0, 0}, "K2");
  hinge(2, kWorld, {xb, yb, 0}, "K3");
  hinge(4, kWorld, {xa, ya, 0}, "K5");
  hinge(3, "K5", {zt, 0, 0}, "K4");
  hinge(6, kWorld, {xa, ya, 0}, "K7");
  hinge(5, "K7", {0, -u, 0}, "K6");
  const auto end = At("K2", {-d, 0, 0});
  m.closures = {MakeClosure("E3", ClosureType::kSpherical, At("K3", {0, -ss, 0}), end),
                MakeClosure("E4", ClosureType::kSpherical, At("K4", {0, -e, 0}), end),
                MakeClosure("E6", ClosureType::kSpherical, At("K6", {zf, 0, 0}), end)};
  Mechanism squeezer = MakeMechanism(m);
  joints::SpringDescription spring;
  spring.name = "spring";
  spring.place = joints::BetweenPoints{At("K3", {sd, -sc, 0}), At(kWorld, {xc, yc, 0})};
  spring.stiffness.coefficient = c0;
  spring.free = l0;
  joints::MotorDescription drive;
  drive.name = "drive";
  drive.place = joints::OnCoordinate{"beta"};
  drive.force = [](double) { return mom; };
  AddForces({std::move(spring), std::move(drive)}, squeezer);
  return squeezer;
}

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

// The published equations (Hairer and Wanner, Solving ODEs II, VII.7), in long double, reduced to
// the one coordinate beta: the other six follow from the six loop equations by Newton's method.
class Reduced {
 public:
  Reduced() : q_(Eigen::Map<const Vector>(kStart, 7)) {}

  Vector Solve(Real beta) {
    q_[0] = beta;
    for (int k = 0; k < 50; ++k) {
      const Vector step = Gradient().rightCols(6).partialPivLu().solve(Residual());
      q_.tail(6) -= step;
      if (step.cwiseAbs().maxCoeff() < 1e-18L) break;
    }
    return q_;
  }
  void CalcRates(const State& s, State& r) {
    const Vector q = Solve(s[0]);
    const Matrix G = Gradient();
    const auto loops = G.rightCols(6).partialPivLu();
    Vector n(7), c(7);
    n[0] = 1;
    n.tail(6) = -loops.solve(G.col(0));
    const Vector v = n * s[1];
    c[0] = 0;
    c.tail(6) = -loops.solve(Curvature(v));
    const Matrix M = Mass(q);
    r[0] = s[1];
    r[1] = n.dot(Force(q, v) - M * c) / n.dot(M * n);
  }

 private:
  // a cos or sin of (q_i + q_j); j = -1: of q_i alone
  struct Term {
    int row;
    Real factor;
    bool sine;
    int i, j;
  };
  static const std::vector<Term>& Terms() {
    static const std::vector<Term> terms = [] {
      std::vector<Term> list;
      for (int loop = 0; loop < 3; ++loop) {
        list.push_back({2 * loop, rr, false, 0, -1});
        list.push_back({2 * loop + 1, rr, true, 0, -1});
        list.push_back({2 * loop, -d, false, 0, 1});
        list.push_back({2 * loop + 1, -d, true, 0, 1});
      }
      list.push_back({0, -ss, true, 2, -1});
      list.push_back({1, ss, false, 2, -1});
      list.push_back({2, -e, true, 3, 4});
      list.push_back({3, e, false, 3, 4});
      list.push_back({2, -zt, false, 4, -1});
      list.push_back({3, -zt, true, 4, -1});
      list.push_back({4, -zf, false, 5, 6});
      list.push_back({5, -zf, true, 5, 6});
      list.push_back({4, -u, true, 6, -1});
      list.push_back({5, u, false, 6, -1});
      return list;
    }();
    return terms;
  }
  Real Angle(const Term& t, const Vector& x) const { return x[t.i] + (t.j < 0 ? 0 : x[t.j]); }
  Vector Residual() const {
    Vector g(6);
    g << -xb, -yb, -xa, -ya, -xa, -ya;
    for (const Term& t : Terms()) {
      g[t.row] += t.factor * (t.sine ? std::sin(Angle(t, q_)) : std::cos(Angle(t, q_)));
    }
    return g;
  }
  Matrix Gradient() const {
    Matrix G = Matrix::Zero(6, 7);
    for (const Term& t : Terms()) {
      const Real slope = t.factor * (t.sine ? std::cos(Angle(t, q_)) : -std::sin(Angle(t, q_)));
      G(t.row, t.i) += slope;
      if (t.j >= 0) G(t.row, t.j) += slope;
    }
    return G;
  }
  Vector Curvature(const Vector& v) const {  // Ġ v
    Vector g = Vector::Zero(6);
    for (const Term& t : Terms()) {
      const Real rate = Angle(t, v);
      g[t.row] -=
          t.factor * (t.sine ? std::sin(Angle(t, q_)) : std::cos(Angle(t, q_))) * rate * rate;
    }
    return g;
  }
  static Matrix Mass(const Vector& q) {
    const Real ct = std::cos(q[1]), sp = std::sin(q[3]), so = std::sin(q[5]);
    const Real f = e - ea, h = zf - fa;
    Matrix M = Matrix::Zero(7, 7);
    M(0, 0) = m1 * ra * ra + m2 * (rr * rr - 2 * da * rr * ct + da * da) + i1 + i2;
    M(1, 0) = M(0, 1) = m2 * (da * da - da * rr * ct) + i2;
    M(1, 1) = m2 * da * da + i2;
    M(2, 2) = m3 * (sa * sa + sb * sb) + i3;
    M(3, 3) = m4 * f * f + i4;
    M(4, 3) = M(3, 4) = m4 * (f * f + zt * f * sp) + i4;
    M(4, 4) = m4 * (zt * zt + 2 * zt * f * sp + f * f) + m5 * (ta * ta + tb * tb) + i4 + i5;
    M(5, 5) = m6 * h * h + i6;
    M(6, 5) = M(5, 6) = m6 * (h * h - u * h * so) + i6;
    M(6, 6) = m6 * (h * h - 2 * u * h * so + u * u) + m7 * (ua * ua + ub * ub) + i6 + i7;
    return M;
  }
  static Vector Force(const Vector& q, const Vector& v) {
    const Real cg = std::cos(q[2]), sg = std::sin(q[2]);
    const Real xd = sd * cg + sc * sg + xb, yd = sd * sg - sc * cg + yb;
    const Real length = std::hypot(xd - xc, yd - yc);
    const Real pull = -c0 * (length - l0) / length;
    const Real fx = pull * (xd - xc), fy = pull * (yd - yc);
    Vector f(7);
    f[0] = mom - m2 * da * rr * v[1] * (v[1] + 2 * v[0]) * std::sin(q[1]);
    f[1] = m2 * da * rr * v[0] * v[0] * std::sin(q[1]);
    f[2] = fx * (sc * cg - sd * sg) + fy * (sd * cg + sc * sg);
    f[3] = m4 * zt * (e - ea) * v[4] * v[4] * std::cos(q[3]);
    f[4] = -m4 * zt * (e - ea) * v[3] * (v[3] + 2 * v[4]) * std::cos(q[3]);
    f[5] = -m6 * u * (zf - fa) * v[6] * v[6] * std::cos(q[5]);
    f[6] = m6 * u * (zf - fa) * v[5] * (v[5] + 2 * v[6]) * std::cos(q[5]);
    return f;
  }

  Vector q_;
};

struct Result {
  double angle[7];
  solve::Ledger ledger;
};

Result CalcResult(solve::Method method, double tolerance) {
  const Mechanism squeezer = MakeSqueezer();
  const Motion motion = Run(squeezer, MakeOptions(method, tolerance, kDuration));
  Result result;
  for (int k = 0; k < 7; ++k) result.angle[k] = motion.y[squeezer.GetJoint(kNames[k]).q];
  result.ledger = motion.ledger;
  return result;
}

std::vector<Check> Calc() {
  Reduced reduced;
  State s = {kStart[0], 0};
  Integrate([&](Real, const State& x, State& r) { reduced.CalcRates(x, r); }, 0, kDuration, s,
            1e-16L);
  const Vector wanted = reduced.Solve(s[0]);
  const Result coarse = CalcResult(solve::Method::kExplicit8, 1e-8);
  const Result fine = CalcResult(solve::Method::kExplicit8, 1e-10);
  const Result tight = CalcResult(solve::Method::kExplicit8, 1e-12);
  const Result bdf = CalcResult(solve::Method::kBdf, 1e-10);
  std::vector<Check> checks;
  for (int k = 0; k < 7; ++k) {
    const double exact = static_cast<double>(wanted[k]);
    const auto name = [&](const char* what) { return fmt::format("{}, {}", kNames[k], what); };
    checks.push_back(CompareRelative(name("published, explicit 8, 1e-12 [rad]"), kPublished[k],
                                     tight.angle[k], 1e-7));
    checks.push_back(CompareRelative(name("explicit 8, 1e-12 [rad]"), exact, tight.angle[k], 1e-9));
    checks.push_back(CompareRelative(name("explicit 8, 1e-10 [rad]"), exact, fine.angle[k], 1e-7));
    checks.push_back(CompareRelative(name("BDF, 1e-10 [rad]"), exact, bdf.angle[k], 1e-5));
  }
  // 0.5 J are worked; the ledger integrates power with order 4 only
  checks.push_back(
      Bound("energy, explicit 8, 1e-12, error [J]", tight.ledger.largest_energy_error, 1e-7));
  checks.push_back(
      Bound("loops, residual [m, rad]", tight.ledger.largest_position_residual, 1e-12));
  const double exact = static_cast<double>(wanted[0]);
  checks.push_back(CheckConvergence("beta, explicit 8, 1e-10", std::abs(coarse.angle[0] - exact),
                                    std::abs(fine.angle[0] - exact)));
  return checks;
}

}  // namespace

Case MakeSqueezerCase() {
  return {"A03", "Andrews' squeezer mechanism at 0.03 s",
          "Hairer and Wanner, Solving ODEs II, VII.7; IVP test set (PSIDE, 1e-14); and their "
          "equations by extrapolation in one coordinate",
          Calc};
}

}  // namespace kingpin::validation
