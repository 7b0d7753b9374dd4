#pragma once

#include <deque>
#include <string>
#include <vector>

#include "joints/beam.h"
#include "joints/force_description.h"
#include "joints/mechanism.h"

namespace kingpin::joints {

/// The frame of a body at a point, with the body's axes or turned by R.
inline FrameDescription At(std::string body, const Vector3<double>& point = {},
                           const Rotation<double>& R = {}) {
  return {std::move(body), {R, point}};
}

/// Where in the C++ source something is called: std::source_location, which Debian 12's clang does
/// not have.
struct CodePlace {
  const char* file = "";
  int line = 0;
  static constexpr CodePlace current(const char* file = __builtin_FILE(),
                                     int line = __builtin_LINE()) {
    return {file, line};
  }
};

/// Builds a mechanism in C++:
///
///   MechanismBuilder m("pendulum on a spring");
///   m.AddBody("slider", bodies::MakeBox(2, {0.1, 0.1, 0.1}));
///   m.AddBody("rod", bodies::Move(bodies::MakeRod(1, 0.5), {{}, {0.25, 0, 0}}));
///   m.AddPrismatic("rail", At("world"), At("slider"), {1, 0, 0});
///   m.AddRevolute("pin", At("slider"), At("rod"), {0, 1, 0}).Position(1.2);
///   m.AddSpring("spring", OnCoordinate{"rail"}).Stiffness(500).Damping(3);
///   Mechanism mechanism = m.Make();
///
/// Every Add... returns the new entry for its further values; it stays valid as long as the
/// builder. Errors found by Make name the source line that added the culprit.
class MechanismBuilder {
  using Where = CodePlace;

 public:
  class Joint {
   public:
    explicit Joint(JointDescription& d) : d_(d) {}
    Joint& Position(double q) { return Position(std::vector<double>{q}); }
    Joint& Velocity(double v) { return Velocity(std::vector<double>{v}); }
    /// Start values; Make holds them if the closures allow it.
    Joint& Position(std::vector<double> q) { return d_.position = std::move(q), *this; }
    Joint& Velocity(std::vector<double> v) { return d_.velocity = std::move(v), *this; }

   private:
    JointDescription& d_;
  };

  class Spring {
   public:
    explicit Spring(SpringDescription& d) : d_(d) {}
    Spring& Stiffness(double k) { return d_.stiffness.coefficient = k, *this; }
    Spring& Stiffness(LawDescription law) { return d_.stiffness = std::move(law), *this; }
    Spring& Damping(double c) { return d_.damping.coefficient = c, *this; }
    Spring& Damping(LawDescription law) { return d_.damping = std::move(law), *this; }
    Spring& Free(double x) { return d_.free = x, *this; }
    Spring& Preload(double force) { return d_.preload = force, *this; }

   private:
    SpringDescription& d_;
  };

  class Stop {
   public:
    explicit Stop(StopDescription& d) : d_(d) {}
    Stop& Above(double limit) { return d_.upper = true, d_.limit = limit, *this; }
    Stop& Below(double limit) { return d_.upper = false, d_.limit = limit, *this; }
    /// f = k δ^exponent.
    Stop& Stiffness(double k, double exponent = 1) {
      return d_.stiffness.coefficient = k, d_.exponent = exponent, *this;
    }
    Stop& Stiffness(LawDescription law) { return d_.stiffness = std::move(law), *this; }
    Stop& Damping(double c, double depth = 1e-3) { return d_.damping = c, d_.depth = depth, *this; }

   private:
    StopDescription& d_;
  };

  class Motor {
   public:
    explicit Motor(MotorDescription& d) : d_(d) {}
    Motor& Force(std::function<double(double)> f) { return d_.force = std::move(f), *this; }
    Motor& Follow(mechanism::Drive target, double proportional, double derivative) {
      d_.target = std::move(target), d_.proportional = proportional, d_.derivative = derivative;
      return *this;
    }
    Motor& Limit(double force) { return d_.limit = force, *this; }

   private:
    MotorDescription& d_;
  };

  class Bushing {
   public:
    explicit Bushing(BushingDescription& d) : d_(d) {}
    Bushing& Stiffness(const std::array<double, 6>& k) {
      for (int i = 0; i < 6; ++i) d_.stiffness[i] = {.coefficient = k[i], .points = {}};
      return *this;
    }
    Bushing& Damping(const std::array<double, 6>& c) {
      for (int i = 0; i < 6; ++i) d_.damping[i] = {.coefficient = c[i], .points = {}};
      return *this;
    }
    /// Of one axis: 0 to 2 translations, 3 to 5 rotations.
    Bushing& Stiffness(int axis, LawDescription law) {
      return d_.stiffness.at(axis) = std::move(law), *this;
    }
    Bushing& Damping(int axis, LawDescription law) {
      return d_.damping.at(axis) = std::move(law), *this;
    }
    Bushing& CoupledStiffness(const BushingDescription::Matrix6& K) {
      return d_.coupled_stiffness = K, *this;
    }
    Bushing& CoupledDamping(const BushingDescription::Matrix6& C) {
      return d_.coupled_damping = C, *this;
    }
    Bushing& Preload(const std::array<double, 6>& p) { return d_.preload = p, *this; }

   private:
    BushingDescription& d_;
  };

  class BodyForce {
   public:
    explicit BodyForce(BodyForceDescription& d) : d_(d) {}
    BodyForce& Force(const Vector3<double>& f) { return d_.force = f, *this; }
    BodyForce& Torque(const Vector3<double>& t) { return d_.torque = t, *this; }
    /// Turns with the frame instead of keeping its world axes.
    BodyForce& InFrame() { return d_.axes = BodyForceDescription::Axes::kFrame, *this; }
    BodyForce& Scale(std::function<double(double)> f) { return d_.scale = std::move(f), *this; }

   private:
    BodyForceDescription& d_;
  };

  explicit MechanismBuilder(std::string name);

  MechanismBuilder& Gravity(const Vector3<double>& g);

  MechanismBuilder& AddBody(const std::string& name, const bodies::RigidInertia& inertia,
                            Where where = Where::current());

  // Joints of the tree.
  Joint AddJoint(const std::string& name, JointType type, const FrameDescription& parent,
                 const FrameDescription& child, const Vector3<double>& axis = {0, 0, 1},
                 Where where = Where::current());
  Joint AddFixed(const std::string& name, const FrameDescription& parent,
                 const FrameDescription& child, Where where = Where::current());
  Joint AddRevolute(const std::string& name, const FrameDescription& parent,
                    const FrameDescription& child, const Vector3<double>& axis,
                    Where where = Where::current());
  Joint AddPrismatic(const std::string& name, const FrameDescription& parent,
                     const FrameDescription& child, const Vector3<double>& axis,
                     Where where = Where::current());
  Joint AddCylindrical(const std::string& name, const FrameDescription& parent,
                       const FrameDescription& child, const Vector3<double>& axis,
                       Where where = Where::current());
  Joint AddScrew(const std::string& name, const FrameDescription& parent,
                 const FrameDescription& child, const Vector3<double>& axis, double pitch,
                 Where where = Where::current());
  Joint AddUniversal(const std::string& name, const FrameDescription& parent,
                     const FrameDescription& child, const Vector3<double>& axis,
                     const Vector3<double>& second_axis, Where where = Where::current());
  Joint AddPlanar(const std::string& name, const FrameDescription& parent,
                  const FrameDescription& child, Where where = Where::current());
  Joint AddSpherical(const std::string& name, const FrameDescription& parent,
                     const FrameDescription& child, Where where = Where::current());
  Joint AddFree(const std::string& name, const FrameDescription& parent,
                const FrameDescription& child, Where where = Where::current());

  // Constraints between bodies and between coordinates.
  MechanismBuilder& AddClosure(const std::string& name, ClosureType type, const FrameDescription& a,
                               const FrameDescription& b, Where where = Where::current());
  /// @param length 0: that of the start position
  MechanismBuilder& AddDistance(const std::string& name, const FrameDescription& a,
                                const FrameDescription& b, double length = 0,
                                Where where = Where::current());
  MechanismBuilder& AddRollingDisc(const std::string& name, const FrameDescription& disc,
                                   const FrameDescription& ground, double radius,
                                   Where where = Where::current());
  /// Σ factor q keeps its start value.
  MechanismBuilder& AddCoupling(const std::string& name,
                                std::vector<CouplingDescription::Term> terms,
                                Where where = Where::current());
  /// A coordinate follows s(t): value, rate, acceleration.
  MechanismBuilder& AddMotion(const std::string& name, const OnCoordinate& on,
                              mechanism::Drive motion, Where where = Where::current());

  // Forces.
  Spring AddSpring(const std::string& name, PlaceDescription place, Where where = Where::current());
  Stop AddStop(const std::string& name, PlaceDescription place, Where where = Where::current());
  Motor AddMotor(const std::string& name, PlaceDescription place, Where where = Where::current());
  Bushing AddBushing(const std::string& name, const FrameDescription& a, const FrameDescription& b,
                     Where where = Where::current());
  BodyForce AddForce(const std::string& name, const FrameDescription& at,
                     Where where = Where::current());
  MechanismBuilder& AddCallback(const std::string& name, PlaceDescription place,
                                std::function<double(double, double, double)> force,
                                Where where = Where::current());
  MechanismBuilder& AddWrenchCallback(
      const std::string& name, const FrameDescription& a, const FrameDescription& b,
      std::function<math::Wrench<double>(double, const RelativeMotion<double>&)> wrench,
      Where where = Where::current());

  /// A beam of rigid finite elements; its `source` is the line that adds it.
  BeamParts AddBeam(BeamDescription beam, Where where = Where::current());

  MechanismDescription MakeDescription() const;
  std::vector<ForceDescription> ListForces() const;

  /// @throws io::InputError as MakeMechanism and AddForces do
  Mechanism Make() const;

 private:
  template <class Description>
  Description& AddForceDescription(Description description, Where where);

  MechanismDescription rest_;            // all but the joints
  std::deque<JointDescription> joints_;  // deques keep what Add... has returned valid
  std::deque<ForceDescription> forces_;
};

}  // namespace kingpin::joints
