#include "tests/joints/absolute_formulation.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "core/mechanism/evaluator.h"
#include "joints/add_forces.h"
#include "tests/core/mechanism/random_mechanism.h"
#include "tests/joints/example_mechanisms.h"

// The engine against the second formulation: accelerations, reactions of closures, couplings and
// motions, and the loads of the joints of the tree. Both sides solve well-conditioned systems in
// double precision: 1e-10 leaves five digits for the dense solution's condition.

namespace kingpin::joints {
namespace {

constexpr double kTolerance = 1e-10;

using mechanism::RandomMechanism;

const std::vector<JointType> kJointTypes = {
    JointType::kFixed,  JointType::kRevolute,    JointType::kPrismatic,
    JointType::kScrew,  JointType::kCylindrical, JointType::kUniversal,
    JointType::kPlanar, JointType::kSpherical,   JointType::kFree};

// Closures that hold at any position of the tree, with the freedom they leave.
const std::vector<ClosureType> kClosureTypes = {
    ClosureType::kSpherical, ClosureType::kPointOnLine,  ClosureType::kPointOnPlane,
    ClosureType::kDistance,  ClosureType::kParallelAxes, ClosureType::kPerpendicular,
    ClosureType::kRevolute,  ClosureType::kPrismatic,    ClosureType::kCylindrical,
    ClosureType::kUniversal, ClosureType::kFixed};

int CountRows(ClosureType type) {
  switch (type) {
    case ClosureType::kSpherical:
    case ClosureType::kRollingDisc:
      return 3;
    case ClosureType::kPointOnLine:
    case ClosureType::kParallelAxes:
      return 2;
    case ClosureType::kPointOnPlane:
    case ClosureType::kDistance:
    case ClosureType::kPerpendicular:
      return 1;
    case ClosureType::kCylindrical:
    case ClosureType::kUniversal:
      return 4;
    case ClosureType::kRevolute:
    case ClosureType::kPrismatic:
      return 5;
    case ClosureType::kFixed:
      return 6;
  }
  return 0;
}

class RandomDescription {
 public:
  explicit RandomDescription(unsigned seed) : random_(seed) {}

  int Pick(int count) { return static_cast<int>(std::abs(random_.Normal()) * 1e6) % count; }
  template <class T>
  T PickFrom(const std::vector<T>& list) {
    return list[Pick(static_cast<int>(list.size()))];
  }
  std::vector<double> MakeNumbers(int count) {
    std::vector<double> x(count);
    for (double& value : x) value = random_.Normal();
    return x;
  }
  Transform<double> MakePose() { return {random_.MakeRotation(), random_.NormalVector()}; }

  MechanismDescription MakeTree(int bodies, const std::vector<JointType>& types) {
    MechanismDescription d;
    d.gravity = random_.NormalVector();
    const mechanism::Model inertias = random_.MakeTree(bodies, {mechanism::JointKind::kRevolute});
    for (int i = 0; i < bodies; ++i) {
      BodyDescription body;
      body.name = "body " + std::to_string(i);
      const mechanism::Link& link = inertias.links[i + 1];
      body.mass = link.mass;
      body.centre = link.centre;
      std::copy_n(link.central_inertia, 6, body.central_inertia.begin());
      d.bodies.push_back(body);
      JointDescription joint;
      joint.name = "joint " + std::to_string(Pick(1000)) + '/' + std::to_string(i);
      joint.type = types[Pick(static_cast<int>(types.size()))];
      const int parent = Pick(i + 1) - 1;
      joint.parent = {parent < 0 ? kWorld : d.bodies[parent].name, MakePose()};
      joint.child = {body.name, MakePose()};
      joint.axis = random_.UnitVector();
      const Vector3<double> other = Cross(joint.axis, random_.UnitVector());
      joint.second_axis = (1 / CalcNorm(other)) * other;
      if (joint.type == JointType::kPlanar) joint.axis = {0, 0, 1};
      joint.pitch = 0.3 * random_.Normal();
      SetStart(joint);
      d.joints.push_back(joint);
    }
    return d;
  }

  void SetStart(JointDescription& joint) {
    static const std::map<JointType, int> kFreedom = {
        {JointType::kFixed, 0},  {JointType::kRevolute, 1},    {JointType::kPrismatic, 1},
        {JointType::kScrew, 1},  {JointType::kCylindrical, 2}, {JointType::kUniversal, 2},
        {JointType::kPlanar, 3}, {JointType::kSpherical, 3},   {JointType::kFree, 6}};
    const int freedom = kFreedom.at(joint.type);
    joint.velocity = MakeNumbers(freedom);
    const bool quaternion = joint.type == JointType::kSpherical || joint.type == JointType::kFree;
    joint.position = MakeNumbers(freedom + (quaternion ? 1 : 0));
    if (quaternion) {
      double* e = &joint.position[joint.position.size() - 4];
      const double norm = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + e[3] * e[3]);
      for (int i = 0; i < 4; ++i) e[i] /= norm;
    }
  }

  // A closure between two bodies that the present position meets; false if these two move as one.
  bool AddClosure(ClosureType type, MechanismDescription& d) {
    const Mechanism mechanism = MakeMechanism(d);
    ClosureDescription closure;
    closure.name = "closure " + std::to_string(d.closures.size());
    closure.type = type;
    const int a = Pick(static_cast<int>(d.bodies.size()));
    const int b = Pick(static_cast<int>(d.bodies.size()) + 1) - 1;
    closure.a = {d.bodies[a].name, MakePose()};
    closure.b.body = b < 0 ? kWorld : d.bodies[b].name;
    if (mechanism.GetBody(closure.a.body).link == mechanism.GetBody(closure.b.body).link) {
      return false;
    }
    AbsoluteFormulation absolute(d, mechanism);
    absolute.Move(mechanism.start);
    // what b's frame sees of a's
    const Vector3<double> x{1, 0, 0}, z{0, 0, 1};
    Transform<double> seen;
    const auto turn = [](const Vector3<double>& axis, double angle) {
      return math::MakeRotation(math::MakeQuaternion(angle * axis));
    };
    switch (type) {
      case ClosureType::kPointOnLine:
        seen = {random_.MakeRotation(), random_.Normal() * z};
        break;
      case ClosureType::kPointOnPlane:
        seen = {random_.MakeRotation(), {random_.Normal(), random_.Normal(), 0}};
        break;
      case ClosureType::kSpherical:
        seen.R = random_.MakeRotation();
        break;
      case ClosureType::kDistance:
        seen = MakePose();
        break;
      case ClosureType::kParallelAxes:
        seen = {turn(z, random_.Normal()), random_.NormalVector()};
        break;
      case ClosureType::kPerpendicular:
        seen = {turn(x, random_.Normal()) * turn(z, random_.Normal()), random_.NormalVector()};
        break;
      case ClosureType::kRevolute:
        seen.R = turn(z, random_.Normal());
        break;
      case ClosureType::kPrismatic:
        seen.p = random_.Normal() * z;
        break;
      case ClosureType::kCylindrical:
        seen = {turn(z, random_.Normal()), random_.Normal() * z};
        break;
      case ClosureType::kUniversal:
        seen.R = turn(x, random_.Normal()) * turn(z, random_.Normal());
        break;
      default:
        break;
    }
    const auto convert = [](const std::pair<Eigen::Matrix3d, Eigen::Vector3d>& pose) {
      const Eigen::Matrix3d& R = pose.first;
      const Eigen::Vector3d& p = pose.second;
      return Transform<double>{
          {{R(0, 0), R(1, 0), R(2, 0)}, {R(0, 1), R(1, 1), R(2, 1)}, {R(0, 2), R(1, 2), R(2, 2)}},
          {p.x(), p.y(), p.z()}};
    };
    const Transform<double> X_WA = convert(absolute.CalcPose(closure.a));
    const Transform<double> X_WB = convert(absolute.CalcPose({closure.b.body, {}}));
    closure.b.X_BF = X_WB.Inverse() * (X_WA * seen.Inverse());
    d.closures.push_back(closure);
    return true;
  }

  CouplingDescription::Term PickTerm(const MechanismDescription& d) {
    for (;;) {
      const JointDescription& joint = PickFrom(d.joints);
      const bool quaternion = joint.type == JointType::kSpherical || joint.type == JointType::kFree;
      if (joint.velocity.empty() || quaternion) continue;
      return {joint.name, Pick(static_cast<int>(joint.velocity.size())), random_.Normal()};
    }
  }

  std::vector<ForceDescription> MakeLoads(const MechanismDescription& d,
                                          std::vector<AbsoluteFormulation::Load>& loads) {
    std::vector<ForceDescription> forces;
    for (const BodyDescription& body : d.bodies) {
      BodyForceDescription force;
      force.name = "load on " + body.name;
      const Vector3<double> p = random_.NormalVector(), f = random_.NormalVector(),
                            t = random_.NormalVector();
      force.at = {body.name, {random_.MakeRotation(), p}};
      force.force = f;
      force.torque = t;
      loads.push_back({body.name, {p.x, p.y, p.z}, {f.x, f.y, f.z}, {t.x, t.y, t.z}});
      forces.push_back(force);
    }
    return forces;
  }

 private:
  RandomMechanism random_;
};

int CountCoordinates(const MechanismDescription& d) {
  int count = 0;
  for (const JointDescription& joint : d.joints) count += static_cast<int>(joint.velocity.size());
  return count;
}

// Bodies that a load can move: those welded to the world are no link of the engine's.
void DropLoadsOnTheWorld(const Mechanism& mechanism, std::vector<ForceDescription>& forces,
                         std::vector<AbsoluteFormulation::Load>& loads) {
  for (size_t i = loads.size(); i-- > 0;) {
    if (mechanism.GetBody(loads[i].body).link != 0) continue;
    loads.erase(loads.begin() + static_cast<long>(i));
    forces.erase(forces.begin() + static_cast<long>(i));
  }
}

// @returns how many of the second formulation's equations depend on the others
int ExpectAgreement(const MechanismDescription& d, RandomDescription& random,
                    const std::string& what) {
  Mechanism mechanism = MakeMechanism(d);
  std::vector<AbsoluteFormulation::Load> loads;
  std::vector<ForceDescription> forces = random.MakeLoads(d, loads);
  DropLoadsOnTheWorld(mechanism, forces, loads);
  AddForces(forces, mechanism);
  mechanism::Evaluator evaluator(mechanism.system);
  std::vector<double> rate(mechanism.system.size());
  evaluator.CalcRates(0, mechanism.start, rate);
  AbsoluteFormulation absolute(d, mechanism);
  absolute.Solve(mechanism.start, 0, loads);
  // beside a singular position rounding alone is more: a unit in the last place of what was given
  const double tolerance = std::max(kTolerance, 1e-16 * absolute.condition());

  const int nv = mechanism.system.model.velocities;
  const Eigen::Map<const Eigen::VectorXd> ours(evaluator.accelerations().data(), nv);
  const Eigen::VectorXd theirs = absolute.CalcJointAccelerations();
  EXPECT_LT((ours - theirs).norm(), tolerance * theirs.norm())
      << what << "\nengine   " << ours.transpose() << "\nabsolute " << theirs.transpose();
  if (absolute.CountDependentRows() > 0) return absolute.CountDependentRows();

  double size = 0;
  for (double r : evaluator.reactions()) size = std::max(size, std::abs(r));
  for (const Mechanism::RowPlace& place : mechanism.rows) {
    const std::vector<double> reaction = absolute.GetReaction(place.name);
    EXPECT_EQ(static_cast<int>(reaction.size()), place.count) << what;
    for (int r = 0; r < place.count; ++r) {
      EXPECT_NEAR(evaluator.reactions()[place.first + r], reaction[r], tolerance * size)
          << what << ": " << mechanism.system.model.row_names[place.first + r];
    }
  }
  const auto wrenches = evaluator.CalcJointWrenches();
  const Vector3<double> at = evaluator.workspace().reference;
  for (const JointDescription& joint : d.joints) {
    if (joint.type == JointType::kFixed) continue;
    const math::Wrench<double>& w = wrenches[mechanism.GetJoint(joint.name).link];
    const Vector3<double> t = w.t + Cross(at, w.f);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << t.x, t.y, t.z, w.f.x, w.f.y, w.f.z;
    const Eigen::Matrix<double, 6, 1> other = absolute.CalcJointWrench(joint);
    // a light joint may carry a small difference of what its neighbours carry
    EXPECT_LT((wrench - other).norm(), tolerance * (10 + size + other.norm()))
        << what << ": " << joint.name << "\nengine   " << wrench.transpose() << "\nabsolute "
        << other.transpose();
  }
  return 0;
}

TEST(AbsoluteFormulation, AgreesOnTreesOfEveryJointType) {
  RandomDescription random(20110117);
  for (JointType type : kJointTypes) {
    if (type == JointType::kFixed) continue;
    EXPECT_EQ(ExpectAgreement(random.MakeTree(3, {type}), random,
                              "type " + std::to_string(static_cast<int>(type))),
              0);
  }
  for (int trial = 0; trial < 40; ++trial) {
    MechanismDescription d = random.MakeTree(3 + trial % 8, kJointTypes);
    if (CountCoordinates(d) == 0) continue;
    EXPECT_EQ(ExpectAgreement(d, random, "tree " + std::to_string(trial)), 0);
  }
}

TEST(AbsoluteFormulation, AgreesOnLoopsOfEveryClosureType) {
  RandomDescription random(20110118);
  int loops = 0;
  std::set<ClosureType> seen;
  for (int trial = 0; trial < 330; ++trial) {
    MechanismDescription d = random.MakeTree(5 + trial % 4, kJointTypes);
    int freedom = CountCoordinates(d);
    // the type of this trial first, then any, as long as two coordinates stay free
    ClosureType type = kClosureTypes[trial % kClosureTypes.size()];
    for (int k = 0; k < 6; ++k) {
      if (CountRows(type) + 2 <= freedom && random.AddClosure(type, d)) freedom -= CountRows(type);
      type = random.PickFrom(kClosureTypes);
    }
    if (d.closures.empty()) continue;
    if (ExpectAgreement(d, random, "loop " + std::to_string(trial)) > 0) continue;
    ++loops;
    for (const ClosureDescription& closure : d.closures) seen.insert(closure.type);
  }
  EXPECT_GE(loops, 40);                          // reactions compared, too
  EXPECT_EQ(seen.size(), kClosureTypes.size());  // of every type
}

// Gears, racks and differentials are linear couplings of two or three coordinates, of any joints
// that have any; motions drive one.
TEST(AbsoluteFormulation, AgreesOnCouplingsAndMotions) {
  RandomDescription random(20110119);
  const std::vector<JointType> types = {JointType::kRevolute,  JointType::kPrismatic,
                                        JointType::kScrew,     JointType::kCylindrical,
                                        JointType::kUniversal, JointType::kPlanar};
  int compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    MechanismDescription d = random.MakeTree(5, types);
    for (int k = 0; k < 2; ++k) {
      CouplingDescription coupling;
      coupling.name = "coupling " + std::to_string(k);
      while (static_cast<int>(coupling.terms.size()) < 2 + trial % 2) {
        const CouplingDescription::Term term = random.PickTerm(d);
        const bool named =
            std::any_of(coupling.terms.begin(), coupling.terms.end(), [&](const auto& other) {
              return other.joint == term.joint && other.coordinate == term.coordinate;
            });
        if (!named) coupling.terms.push_back(term);
      }
      d.couplings.push_back(coupling);
    }
    const CouplingDescription::Term driven = random.PickTerm(d);
    const auto joint = std::find_if(d.joints.begin(), d.joints.end(),
                                    [&](const auto& j) { return j.name == driven.joint; });
    const double s0 = joint->position.empty() ? 0 : joint->position.at(driven.coordinate);
    const double rate = driven.factor;
    MotionDescription motion;
    motion.name = "motion";
    motion.joint = driven.joint;
    motion.coordinate = driven.coordinate;
    motion.motion = [=](double t) {
      return std::array<double, 3>{s0 + rate * t + 0.7 * t * t, rate + 1.4 * t, 1.4};
    };
    d.motions.push_back(motion);
    try {
      MakeMechanism(d);
    } catch (const std::exception&) {
      continue;  // the couplings may leave the motion no coordinate to move
    }
    if (ExpectAgreement(d, random, "coupling " + std::to_string(trial)) == 0) ++compared;
  }
  EXPECT_GE(compared, 30);
}

// Plane mechanisms with spatial closures: up to three rows of each loop depend on the others. What
// moves is the same, and so are the accelerations.
TEST(AbsoluteFormulation, AccelerationsAgreeWithRedundantRows) {
  RandomDescription random(20110120);
  for (ClosureType type : {ClosureType::kSpherical, ClosureType::kRevolute,
                           ClosureType::kCylindrical, ClosureType::kUniversal}) {
    MechanismDescription d = MakeFourBar(7);
    d.closures[0].type = type;
    // frames whose z axes lie along the hinges
    const Rotation<double> hinge{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
    d.closures[0].a.X_BF.R = d.closures[0].b.X_BF.R = hinge;
    std::vector<AbsoluteFormulation::Load> loads;
    Mechanism mechanism = MakeMechanism(d);
    mechanism::Evaluator evaluator(mechanism.system);
    std::vector<double> rate(mechanism.system.size());
    evaluator.CalcRates(0, mechanism.start, rate);
    AbsoluteFormulation absolute(d, mechanism);
    absolute.Solve(mechanism.start, 0, loads);
    const Eigen::Map<const Eigen::VectorXd> ours(evaluator.accelerations().data(), 3);
    const Eigen::VectorXd theirs = absolute.CalcJointAccelerations();
    EXPECT_GT(theirs.norm(), 1);
    EXPECT_LT((ours - theirs).norm(), kTolerance * theirs.norm()) << static_cast<int>(type);
    EXPECT_GT(absolute.CountDependentRows(), 0);
  }
}

}  // namespace
}  // namespace kingpin::joints
