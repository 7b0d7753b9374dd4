#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "joints/add_forces.h"
#include "models/validation/cases.h"
#include "models/validation/one_body.h"
#include "models/validation/run.h"

namespace kingpin::validation {

namespace {

constexpr double kDuration = 5, kInterval = 0.1;
constexpr double kPitch = 0.2, kLink = 0.7;
constexpr double kStiffness = 60, kCubic = 30, kDamping = 1.5, kFree = 1.2;
constexpr double kTwist = 50, kTwistDamping = 4, kTwistFree = 0.3;

const Vector3<double> kCentre{2, 0, 0}, kGround{0.3, -0.2, 1.5};
// A joint axis that is nobody's friend, and two directions across it.
const Vector3<double> kAxis{1.0 / 3, 2.0 / 3, 2.0 / 3}, kAcross{2.0 / 3, 1.0 / 3, -2.0 / 3};
const Vector3<double> kThird = Cross(kAxis, kAcross);
const std::array<double, 6> kInertia = {0.3, 1.2, 1.4, 0.05, -0.1, 0.08};

/// A body on a joint: as a mechanism, and as the constraints of an absolute body.
struct Hung {
  MechanismDescription mechanism;
  std::vector<joints::ForceDescription> forces;
  OneBody body;
};

OneBody::Vector Exact(const Vector3<double>& v) { return math::Convert<Real>(v); }

OneBody MakeReference() {
  OneBody body;
  body.centre = Exact(kCentre);
  const auto& J = kInertia;
  body.inertia << J[0], J[3], J[4], J[3], J[1], J[5], J[4], J[5], J[2];
  return body;
}

Hung Hang(JointType type) {
  Hung hung;
  hung.body = MakeReference();
  hung.body.gravity = {0, 0, Real(-9.80665)};  // the double
  hung.mechanism.name = "body";
  hung.mechanism.bodies = {MakeBody("body", 1, kCentre, kInertia)};
  hung.mechanism.joints = {MakeJoint("joint", type, kWorld, {}, "body", kAxis)};
  hung.mechanism.joints[0].second_axis = kAcross;
  hung.mechanism.joints[0].pitch = type == JointType::kScrew ? kPitch : 0;
  return hung;
}

// Constraints of the reference, at the body's origin.
void HoldOrigin(OneBody& body, std::initializer_list<Vector3<double>> directions) {
  for (const auto& n : directions) body.HoldPoint(-body.centre, Exact(n));
}
void HoldAxis(OneBody& body) {
  body.HoldPerpendicular(Exact(kAxis), Exact(kAcross));
  body.HoldPerpendicular(Exact(kAxis), Exact(kThird));
}

void Close(Hung& hung, ClosureType type) {
  hung.mechanism.closures = {
      MakeClosure("cut", type, At("body", {}, kAxis), At(kWorld, {}, kAxis))};
}

Hung HangOnScrew() {
  Hung hung = Hang(JointType::kScrew);
  HoldOrigin(hung.body, {kAcross, kThird});
  HoldAxis(hung.body);
  hung.body.HoldPitch(-hung.body.centre, Exact(kAxis), kPitch);
  return hung;
}

Hung HangOnUniversal(bool cut) {
  Hung hung = Hang(cut ? JointType::kFree : JointType::kUniversal);
  HoldOrigin(hung.body, {kAxis, kAcross, kThird});
  hung.body.HoldPerpendicular(Exact(kAcross), Exact(kAxis));
  if (cut) {
    hung.mechanism.closures = {MakeClosure("cut", ClosureType::kUniversal, At("body", {}, kAcross),
                                           {kWorld, {{kAxis, kAcross, kThird}, {}}})};
  }
  return hung;
}

// A massless link turns about y; the body hangs on its end.
Hung HangOnLink() {
  Hung hung = Hang(JointType::kSpherical);
  hung.mechanism.bodies.push_back(MakeBody("link", 0, {}, {}));
  hung.mechanism.joints[0].parent = {"link", {{}, {kLink, 0, 0}}};
  hung.mechanism.joints.push_back(
      MakeJoint("pivot", JointType::kRevolute, kWorld, {-kLink, 0, 0}, "link", {0, 1, 0}));
  HoldOrigin(hung.body, {{0, 1, 0}});
  hung.body.HoldDistance(-hung.body.centre, Exact({-kLink, 0, 0}));
  return hung;
}

Hung HangOnDistance() {
  Hung hung = Hang(JointType::kFree);
  hung.mechanism.closures = {
      MakeClosure("rod", ClosureType::kDistance, At("body", {}), At(kWorld, kGround))};
  hung.body.HoldDistance(-hung.body.centre, Exact(kGround));
  return hung;
}

// Force between the body's origin and a point of the ground; `law` gives what pulls them together.
Hung HangOnSpring(const std::function<Real(Real length, Real rate)>& law) {
  Hung hung = Hang(JointType::kFree);
  const OneBody::Vector arm = -hung.body.centre;
  hung.body.load = [=](const OneBody::Place& place) {
    const OneBody::Vector d = Exact(kGround) - place.GetPoint(arm);
    const Real length = CalcNorm(d);
    const OneBody::Vector n = (1 / length) * d;
    const OneBody::Vector f = law(length, -Dot(n, place.GetVelocity(arm))) * n;
    return OneBody::Load{f, Cross(place.R * arm, f)};
  };
  return hung;
}

Hung HangOnLinearSpring() {
  Hung hung = HangOnSpring([](Real length, Real rate) {
    return Real(kStiffness) * (length - Real(kFree)) + Real(kDamping) * rate;
  });
  joints::SpringDescription spring;
  spring.name = "spring";
  spring.place = joints::BetweenPoints{At("body", {}), At(kWorld, kGround)};
  spring.stiffness.coefficient = kStiffness;
  spring.damping.coefficient = kDamping;
  spring.free = kFree;
  hung.forces.push_back(spring);
  return hung;
}

Hung HangOnHardeningSpring() {
  const auto law = [](auto length, auto rate) {
    const auto x = length - kFree;
    return kStiffness * x + kCubic * x * x * x + kDamping * rate;
  };
  Hung hung = HangOnSpring(law);
  joints::CallbackDescription spring;
  spring.name = "spring";
  spring.place = joints::BetweenPoints{At("body", {}), At(kWorld, kGround)};
  spring.force = [law](double, double length, double rate) { return -law(length, rate); };
  hung.forces.push_back(spring);
  return hung;
}

Hung HangOnTorsionSpring() {
  Hung hung = Hang(JointType::kRevolute);
  HoldOrigin(hung.body, {kAxis, kAcross, kThird});
  HoldAxis(hung.body);
  joints::SpringDescription spring;
  spring.name = "spring";
  spring.place = joints::OnCoordinate{"joint", 0};
  spring.stiffness.coefficient = kTwist;
  spring.damping.coefficient = kTwistDamping;
  spring.free = kTwistFree;
  hung.forces.push_back(spring);
  hung.body.load = [](const OneBody::Place& place) {
    // the angle about the axis, from the direction across it
    const OneBody::Vector across = place.R * Exact(kAcross), axis = Exact(kAxis);
    const Real angle = std::atan2(Dot(across, Exact(kThird)), Dot(across, Exact(kAcross)));
    const Real pull =
        Real(kTwist) * (angle - Real(kTwistFree)) + Real(kTwistDamping) * Dot(axis, place.spin);
    return OneBody::Load{{}, -pull * axis};
  };
  return hung;
}

Hung HangOnTree(JointType type) {
  Hung hung = Hang(type);
  switch (type) {
    case JointType::kRevolute:
      HoldOrigin(hung.body, {kAxis, kAcross, kThird});
      HoldAxis(hung.body);
      break;
    case JointType::kPrismatic:
      HoldOrigin(hung.body, {kAcross, kThird});
      HoldAxis(hung.body);
      hung.body.HoldPerpendicular(Exact(kAcross), Exact(kThird));
      break;
    case JointType::kCylindrical:
      HoldOrigin(hung.body, {kAcross, kThird});
      HoldAxis(hung.body);
      break;
    case JointType::kPlanar:
      HoldOrigin(hung.body, {kAxis});
      HoldAxis(hung.body);
      break;
    default:
      HoldOrigin(hung.body, {kAxis, kAcross, kThird});
  }
  return hung;
}

Hung HangOnCut(JointType same, ClosureType type) {
  Hung hung = HangOnTree(same);
  hung.mechanism.joints[0].type = JointType::kFree;
  Close(hung, type);
  return hung;
}

struct Errors {
  double place = 0, force = 0, torque = 0;
};

// What the ground exerts on the body through its joint or closure, about the body's centre.
OneBody::Load CalcOurs(const Mechanism& mechanism, mechanism::Evaluator& evaluator,
                       const Vector3<double>& centre) {
  const auto& w = evaluator.workspace();
  math::Wrench<double> sum = evaluator.CalcJointWrenches()[mechanism.GetBody("body").link];
  for (int r = 0; r < mechanism.system.model.rows; ++r) {
    sum = sum + evaluator.reactions()[r] * w.W[r];
  }
  return {Exact(sum.f), Exact(sum.t - Cross(centre, sum.f))};
}

Errors CalcErrors(const Hung& hung) {
  Mechanism mechanism = MakeMechanism(hung.mechanism);
  AddForces(hung.forces, mechanism);
  const mechanism::Frame& body = mechanism.GetBody("body");
  const Vector3<double> in_link = body.X_LF * kCentre;
  State reference = hung.body.MakeStart();
  Real reached = 0;
  Errors errors;
  Run(mechanism, MakeOptions(solve::Method::kExplicit8, 1e-10, kDuration, kInterval),
      [&](double time, std::span<const double>, mechanism::Evaluator& evaluator) {
        if (time > reached) hung.body.Advance(reached, time, reference);
        reached = time;
        const auto& w = evaluator.workspace();
        const Vector3<double> centre =
            w.R[body.link] * in_link + w.p[body.link];  // from the common point
        errors.place = std::max(errors.place,
                                static_cast<double>(CalcNorm(Exact(w.reference + centre) -
                                                             OneBody::GetPlace(reference).centre)));
        if (hung.body.constraints.empty()) return;  // nothing that transmits
        const OneBody::Load ours = CalcOurs(mechanism, evaluator, centre);
        const OneBody::Load exact = hung.body.CalcTransmitted(reference);
        errors.force =
            std::max(errors.force, static_cast<double>(CalcNorm(ours.force - exact.force)));
        errors.torque =
            std::max(errors.torque, static_cast<double>(CalcNorm(ours.torque - exact.torque)));
      });
  return errors;
}

std::vector<Check> Calc() {
  const std::pair<const char*, Hung> all[] = {
      {"revolute", HangOnTree(JointType::kRevolute)},
      {"prismatic", HangOnTree(JointType::kPrismatic)},
      {"cylindrical", HangOnTree(JointType::kCylindrical)},
      {"screw", HangOnScrew()},
      {"universal", HangOnUniversal(false)},
      {"planar", HangOnTree(JointType::kPlanar)},
      {"spherical", HangOnTree(JointType::kSpherical)},
      {"spherical on a massless link", HangOnLink()},
      {"distance", HangOnDistance()},
      {"spherical, cut", HangOnCut(JointType::kSpherical, ClosureType::kSpherical)},
      {"revolute, cut", HangOnCut(JointType::kRevolute, ClosureType::kRevolute)},
      {"prismatic, cut", HangOnCut(JointType::kPrismatic, ClosureType::kPrismatic)},
      {"universal, cut", HangOnUniversal(true)},
      {"spring and damper", HangOnLinearSpring()},
      {"hardening spring", HangOnHardeningSpring()},
      {"torsion spring on a revolute", HangOnTorsionSpring()}};
  std::vector<Check> checks;
  for (const auto& [name, hung] : all) {
    const Errors errors = CalcErrors(hung);
    checks.push_back(Bound(fmt::format("{}: place, largest error [m]", name), errors.place, 1e-7));
    if (hung.body.constraints.empty()) continue;
    checks.push_back(
        Bound(fmt::format("{}: transmitted force, largest error [N]", name), errors.force, 1e-5));
    checks.push_back(Bound(fmt::format("{}: transmitted torque, largest error [N m]", name),
                           errors.torque, 1e-5));
  }
  return checks;
}

}  // namespace

Case MakeEveryJointCase() {
  return {
      "J01", "one body on each kind of joint, cut and spring, released at rest, 5 s",
      "after the joint tests of Project Chrono; reference: absolute coordinates and multipliers, "
      "long double",
      Calc};
}

}  // namespace kingpin::validation
