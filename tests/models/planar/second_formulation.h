#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "models/planar/parameters.h"

/// The planar model once more, written from docs/theory/planar-model.md and from nothing else:
/// generalised forces are complex-step gradients of one potential V and of elongations, splines
/// are solved densely, accelerations are M⁻¹ of the sum. Slow and short on purpose; it shares the
/// parameter struct with the product and no code.
namespace kingpin::planar::second {

using Complex = std::complex<double>;
template <class T>
using Vector5 = std::array<T, 5>;

/// Natural cubic spline by Gaussian elimination on the full system of its second derivatives.
class Spline {
 public:
  explicit Spline(const Curve<double>& curve)
      : x_(curve.x.begin(), curve.x.begin() + curve.count),
        f_(curve.f.begin(), curve.f.begin() + curve.count),
        m_(static_cast<std::size_t>(curve.count), 0.0) {
    const std::size_t n = x_.size();
    std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.0));
    a[0][0] = a[n - 1][n - 1] = 1.0;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double left = x_[i] - x_[i - 1];
      const double right = x_[i + 1] - x_[i];
      a[i][i - 1] = left / 6;
      a[i][i] = (left + right) / 3;
      a[i][i + 1] = right / 6;
      a[i][n] = (f_[i + 1] - f_[i]) / right - (f_[i] - f_[i - 1]) / left;
    }
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t i = k + 1; i < n; ++i) {
        const double ratio = a[i][k] / a[k][k];
        for (std::size_t j = k; j <= n; ++j) a[i][j] -= ratio * a[k][j];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      double sum = a[k][n];
      for (std::size_t j = k + 1; j < n; ++j) sum -= a[k][j] * m_[j];
      m_[k] = sum / a[k][k];
    }
  }

  Complex Value(Complex x) const { return Piece(x, false); }
  /// ∫_0^x of the spline, up to a constant that differs from piece to piece: good for gradients.
  Complex Integral(Complex x) const { return Piece(x, true); }

 private:
  Complex Piece(Complex x, bool integral) const {
    const std::size_t n = x_.size();
    if (x.real() < x_.front() || x.real() > x_.back()) {
      const bool low = x.real() < x_.front();
      const std::size_t i = low ? 0 : n - 2;
      const double h = x_[i + 1] - x_[i];
      const double chord = (f_[i + 1] - f_[i]) / h;
      const double slope =
          low ? chord - h * m_[1] / 6 : chord + h * m_[n - 2] / 6;  // m = 0 at the end itself
      const double x0 = low ? x_.front() : x_.back();
      const double f0 = low ? f_.front() : f_.back();
      const Complex u = x - x0;
      return integral ? f0 * u + 0.5 * slope * u * u : f0 + slope * u;
    }
    std::size_t i = 0;
    while (i + 2 < n && x.real() > x_[i + 1]) ++i;
    const double h = x_[i + 1] - x_[i];
    const Complex a = (x_[i + 1] - x) / h;
    const Complex b = (x - x_[i]) / h;
    if (!integral) {
      return a * f_[i] + b * f_[i + 1] +
             (h * h / 6) * ((a * a * a - a) * m_[i] + (b * b * b - b) * m_[i + 1]);
    }
    return h * (-0.5 * a * a * f_[i] + 0.5 * b * b * f_[i + 1] +
                (h * h / 6) * ((-0.25 * a * a * a * a + 0.5 * a * a) * m_[i] +
                               (0.25 * b * b * b * b - 0.5 * b * b) * m_[i + 1]));
  }

  std::vector<double> x_, f_, m_;
};

class Model {
 public:
  explicit Model(const Parameters<double>& p)
      : p_(p), longitudinal_(p.longitudinal_force), assist_(p.assist_force) {
    rest_length_ = 0.0;
    rest_length_ = RodElongation({}, true).real();
  }

  double rod_stiffness() const {
    return 1.0 / (rest_length_ / p_.rod_rigidity + p_.rod_compliance);
  }

  /// Elongations of R, L, N and the column's twist.
  std::array<Complex, 4> Elongations(const Vector5<Complex>& q) const {
    return {RodElongation(q, p_.two_way), Link(q, p_.lateral_x, p_.lateral_y, p_.lateral_angle),
            Link(q, p_.longitudinal_x, p_.longitudinal_y, p_.longitudinal_angle),
            q[4] - p_.gear_ratio * q[3]};
  }

  /// Potential of all springs; pieces may differ by constants.
  Complex Potential(const Vector5<Complex>& q) const {
    const auto d = Elongations(q);
    return 0.5 * rod_stiffness() * Square(Dead(d[0], 0.5 * p_.rod_free_play)) +
           0.5 * p_.lateral_stiffness * Square(d[1]) + longitudinal_.Integral(d[2]) +
           TwistEnergy(d[3]) + 0.5 * Aligning() * Square(q[2]) +
           0.5 * p_.hands_stiffness * Square(q[4]);
  }

  /// Axial force of the tie rod, tension positive.
  double RodForce(const Vector5<double>& q, const Vector5<double>& v) const {
    const Complex d = Elongations(AlongRates(q, v))[0];
    const bool loaded = std::abs(d.real()) >= 0.5 * p_.rod_free_play;
    return loaded ? rod_stiffness() * (Dead(d.real(), 0.5 * p_.rod_free_play).real() +
                                       p_.damping_time * d.imag() / kStep)
                  : 0.0;
  }

  /// Elastic torque of the column.
  double ElasticTorque(const Vector5<double>& q) const {
    return TwistEnergy({q[4] - p_.gear_ratio * q[3], kStep}).imag() / kStep;
  }

  /// What the valve measures: the twist times c_k, with or without a stop beside it.
  double BarTorque(const Vector5<double>& q) const {
    return p_.column_stiffness * (q[4] - p_.gear_ratio * q[3]);
  }

  double AssistForce(double torque) const {
    return std::copysign(assist_.Value(std::abs(torque)).real(), torque);
  }

  /// M q̈ without assistance, lagged aligning torque and rack friction.
  Vector5<double> Forces(const Vector5<double>& q, const Vector5<double>& v, double road_force,
                         double moment) const {
    Vector5<double> force{};
    const auto rates = Elongations(AlongRates(q, v));
    const std::array<double, 4> damping{
        std::abs(rates[0].real()) >= 0.5 * p_.rod_free_play ? rod_stiffness() * p_.damping_time
                                                            : 0.0,
        p_.lateral_stiffness * p_.damping_time, p_.longitudinal_damping,
        p_.column_stiffness * p_.damping_time};
    for (std::size_t i = 0; i < 5; ++i) {
      Vector5<Complex> z{};
      for (std::size_t j = 0; j < 5; ++j) z[j] = q[j];
      z[i] += Complex{0, kStep};
      force[i] = -Potential(z).imag() / kStep;
      const auto d = Elongations(z);
      for (std::size_t k = 0; k < 4; ++k) {
        force[i] -= damping[k] * (rates[k].imag() / kStep) * (d[k].imag() / kStep);
      }
      // Virtual work of the road force (−F_T, −ρ F_T) and of the moment.
      const auto point = Displacement(z, p_.force_x, p_.force_y);
      force[i] -= road_force * (point[0].imag() + p_.lateral_share * point[1].imag()) / kStep;
    }
    if (!p_.two_way) force[3] = OneWayRack(q, v, damping[3]);
    force[2] += moment - Aligning() * p_.damping_time * v[2];
    force[3] -= p_.rack_damping * v[3];
    force[4] -= p_.hands_damping * v[4];
    return force;
  }

  /// Component of the tie rod's unit vector (inner to outer end) along x and y.
  std::array<double, 2> RodDirection(const Vector5<double>& q) const {
    Vector5<Complex> z{};
    for (std::size_t j = 0; j < 5; ++j) z[j] = q[j];
    std::array<double, 2> e{};
    for (std::size_t i = 0; i < 2; ++i) {
      auto s = z;
      s[i] += Complex{0, kStep};
      e[i] = RodElongation(s, p_.two_way).imag() / kStep;
    }
    return e;
  }

  /// Accelerations with the assistance of no lag and smoothed or no friction.
  Vector5<double> Accelerations(const Vector5<double>& q, const Vector5<double>& v,
                                double road_force, double moment = 0.0) const {
    auto force = Forces(q, v, road_force, moment);
    force[3] += AssistForce(BarTorque(q));
    if (p_.friction_law == FrictionLaw::kSmoothed) {
      force[3] -= FrictionLimit(q, v) * v[3] / std::hypot(v[3], p_.friction_speed);
    }
    const Vector5<double> mass{p_.carrier_mass, p_.carrier_mass, p_.carrier_yaw_inertia,
                               p_.rack_mass, p_.wheel_inertia};
    for (std::size_t i = 0; i < 5; ++i) force[i] /= mass[i];
    return force;
  }

  double FrictionLimit(const Vector5<double>& q, const Vector5<double>& v) const {
    return p_.friction_coefficient *
               (std::abs(RodForce(q, v) * RodDirection(q)[0]) + p_.friction_preload) +
           p_.friction_constant;
  }

 private:
  static constexpr double kStep = 1e-40;

  static Complex Square(Complex z) { return z * z; }

  static Complex Dead(Complex d, double half) {
    if (d.real() > half) return d - half;
    if (d.real() < -half) return d + half;
    return 0.0;
  }

  double Aligning() const { return p_.aligning_lag > 0 ? 0.0 : p_.aligning_stiffness; }

  Complex TwistEnergy(Complex twist) const {
    const Complex elastic = 0.5 * p_.column_stiffness * Square(twist);
    if (p_.stop_angle <= 0.0) return elastic;
    return elastic +
           0.5 * (p_.stop_stiffness - p_.column_stiffness) * Square(Dead(twist, p_.stop_angle));
  }

  static std::array<Complex, 2> Displacement(const Vector5<Complex>& q, double x, double y) {
    const Complex c = std::cos(q[2]);
    const Complex s = std::sin(q[2]);
    return {q[0] + c * x - s * y, q[1] + s * x + c * y};
  }

  static Complex Link(const Vector5<Complex>& q, double x, double y, double angle) {
    const auto r = Displacement(q, x, y);
    return std::cos(angle) * (r[0] - x) + std::sin(angle) * (r[1] - y);
  }

  Complex RodElongation(const Vector5<Complex>& q, bool two_way) const {
    const auto outer = Displacement(q, p_.design_origin_x + p_.outer_joint_x,
                                    p_.design_origin_y + p_.outer_joint_y);
    const Complex x = outer[0] - (p_.design_origin_x + p_.rack_position);
    const Complex y = outer[1] - (p_.rack_half_length - p_.half_track + (two_way ? q[3] : 0.0));
    return std::sqrt(x * x + y * y) - rest_length_;
  }

  static Vector5<Complex> AlongRates(const Vector5<double>& q, const Vector5<double>& v) {
    Vector5<Complex> z{};
    for (std::size_t i = 0; i < 5; ++i) z[i] = Complex{q[i], kStep * v[i]};
    return z;
  }

  double OneWayRack(const Vector5<double>& q, const Vector5<double>& v, double damping) const {
    const double twist_rate = v[4] - p_.gear_ratio * v[3];
    return RodForce(q, v) * RodDirection(q)[1] +
           p_.gear_ratio * (ElasticTorque(q) + damping * twist_rate);
  }

  Parameters<double> p_;
  Spline longitudinal_, assist_;
  double rest_length_ = 0.0;
};

}  // namespace kingpin::planar::second
