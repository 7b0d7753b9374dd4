#include "joints/add_forces.h"

#include <Eigen/Dense>
#include <map>
#include <memory>
#include <set>
#include <typeindex>

#include <fmt/format.h>

#include "core/io/nearest_name.h"
#include "core/mechanism/kinematics.h"
#include "joints/axis_place.h"
#include "joints/body_force.h"
#include "joints/bushing.h"
#include "joints/callback.h"
#include "joints/element_group.h"
#include "joints/fail.h"
#include "joints/motor.h"
#include "joints/spring.h"
#include "joints/stop.h"

namespace kingpin::joints {

namespace {

constexpr double kCoincident = 1e-9;  // [m]: no direction can be taken from less

class Adder {
 public:
  explicit Adder(Mechanism& mechanism)
      : mechanism_(mechanism), start_(mechanism.start), w_(mechanism.system.model) {
    mechanism::UpdatePositions(mechanism.system.model, start_.data(), w_);
    mechanism::UpdateVelocities(mechanism.system.model,
                                start_.data() + mechanism.system.model.positions, w_);
  }

  void Add(const ForceDescription& description) {
    std::visit(
        [this](const auto& force) {
          source_ = &force.source;
          key_ = fmt::format("forces.{}", force.name);
          if (force.name.empty()) Fail(force.source, "forces", "an empty name", "a name");
          if (!names_.insert(force.name).second) {
            Fail(force.source, key_, "a name given twice", "one of each name");
          }
          AddForce(force);
        },
        description);
  }

  void Finish() {
    for (auto& group : groups_) mechanism_.system.Add(std::move(group));
  }

 private:
  std::string Key(const char* part) const { return key_ + '.' + part; }

  double CheckFinite(const char* part, double value) const {
    if (!std::isfinite(value)) Fail(*source_, Key(part), fmt::format("{:g}", value), "a number");
    return value;
  }
  double CheckNotNegative(const char* part, double value) const {
    if (!(CheckFinite(part, value) >= 0)) {
      Fail(*source_, Key(part), fmt::format("{:g}", value), "a number that is not negative");
    }
    return value;
  }

  mechanism::Frame MakeFrame(const char* part, const FrameDescription& frame) const {
    if (mechanism_.bodies.count(frame.body) == 0) {
      std::vector<std::string> known;
      for (const auto& [body, unused] : mechanism_.bodies) known.push_back(body);
      Fail(*source_, Key(part), fmt::format("'{}'", frame.body), "the name of a body",
           io::SuggestName(frame.body, known, "bodies"));
    }
    if (!IsFinite(frame.X_BF)) {
      Fail(*source_, Key(part), "a number that is not finite", "a pose");
    }
    return mechanism_.MakeFrame(frame);
  }

  void CheckApart(const FrameDescription& a, const mechanism::Frame& frame_a,
                  const FrameDescription& b, const mechanism::Frame& frame_b) const {
    if (frame_a.link != frame_b.link) return;
    Fail(*source_, key_, fmt::format("'{}' and '{}', which move as one", a.body, b.body),
         "two bodies that move against each other");
  }

  template <class Element>
  void AddElement(Element element) {
    auto& place = places_[std::type_index(typeid(Element))];
    if (!place) {
      groups_.push_back(std::make_unique<ElementGroup<Element>>());
      place = groups_.back().get();
    }
    static_cast<ElementGroup<Element>*>(place)->Add(key_.substr(key_.find('.') + 1),
                                                    std::move(element));
  }

  mechanism::ForceContext<double> MakeContext() {
    const mechanism::Model& model = mechanism_.system.model;
    return {model, 0.0, start_.data(), start_.data() + model.positions, nullptr, nullptr, w_};
  }

  PointPlace MakePlace(const BetweenPoints& points) {
    const PointPlace place{MakeFrame("a", points.a), MakeFrame("b", points.b)};
    CheckApart(points.a, place.a, points.b, place.b);
    const double distance = place.Calc(MakeContext()).x;
    if (distance < kCoincident) {
      Fail(*source_, key_, fmt::format("points {:g} m apart at the start", distance),
           "points that do not coincide: the force acts along the line between them",
           "a bushing acts on points that coincide");
    }
    return place;
  }
  AxisPlace MakePlace(const AboutAxis& axis) {
    CheckApart(axis.a, MakeFrame("a", axis.a), axis.b, MakeFrame("b", axis.b));
    AxisPlace place = MakeAxisPlace(mechanism_, axis);
    const Vector3<double> A = w_.R[place.a.link] * place.a.X_LF.R.z;
    const Vector3<double> B = w_.R[place.b.link] * place.b.X_LF.R.z;
    if (Dot(A, B) < -1 + 1e-9) {
      Fail(*source_, key_, "z axes that are opposite at the start", "axes that are near parallel",
           "turn one of the frames by half a turn about its x axis");
    }
    return place;
  }
  CoordinatePlace MakePlace(const OnCoordinate& on) {
    std::vector<std::string> known;
    for (const Mechanism::JointPlace& joint : mechanism_.joints) {
      known.push_back(joint.name);
      if (joint.name != on.joint) continue;
      if (on.coordinate < 0 || on.coordinate >= joint.velocities) {
        Fail(*source_, Key("coordinate"),
             fmt::format("coordinate {} of joint '{}'", on.coordinate, on.joint),
             fmt::format("a coordinate from 0 to {}", joint.velocities - 1));
      }
      if (joint.positions != joint.velocities) {
        Fail(*source_, Key("joint"),
             fmt::format("joint '{}', whose rotation is a quaternion", on.joint),
             "a joint with angles or displacements", "use a bushing, or an axis between frames");
      }
      return {joint.q + on.coordinate, joint.v + on.coordinate};
    }
    Fail(*source_, Key("joint"), fmt::format("'{}'", on.joint), "the name of a joint that moves",
         io::SuggestName(on.joint, known, "joints"));
  }

  template <class Law>
  void AddLaw(const PlaceDescription& place, const Law& law) {
    std::visit(
        [&](const auto& where) {
          const auto made = MakePlace(where);
          AddElement(LawAtPlace<std::remove_const_t<decltype(made)>, Law>{made, law});
        },
        place);
  }

  void AddForce(const SpringDescription& spring) {
    SpringLaw law;
    law.stiffness = ScalarLaw(spring.stiffness, *source_, Key("stiffness"));
    law.damping = MakeDampingLaw(spring.damping, *source_, Key("damping"));
    law.preload = CheckFinite("preload", spring.preload);
    if (spring.free) {
      law.free = CheckFinite("free", *spring.free);
    } else if (const auto* points = std::get_if<BetweenPoints>(&spring.place)) {
      law.free = MakePlace(*points).Calc(MakeContext()).x;
    }
    if (std::holds_alternative<BetweenPoints>(spring.place)) CheckNotNegative("free", law.free);
    AddLaw(spring.place, law);
  }

  void AddForce(const StopDescription& stop) {
    StopLaw law;
    law.sign = stop.upper ? 1 : -1;
    law.limit = CheckFinite("limit", stop.limit);
    law.stiffness = MakeContactLaw(stop.stiffness, *source_, Key("stiffness"));
    law.coefficient = stop.stiffness.coefficient;
    law.exponent = CheckFinite("exponent", stop.exponent);
    law.damping = CheckNotNegative("damping", stop.damping);
    law.depth = CheckFinite("depth", stop.depth);
    if (law.exponent < 1) {
      Fail(*source_, Key("exponent"), fmt::format("{:g}", law.exponent),
           "an exponent of 1 or more");
    }
    if (law.exponent != 1 && !stop.stiffness.points.empty()) {
      Fail(*source_, Key("exponent"), fmt::format("{:g} with points", law.exponent),
           "a coefficient with an exponent, or points without");
    }
    if (!(law.depth > 0)) {
      Fail(*source_, Key("depth"), fmt::format("{:g}", law.depth), "a depth above zero");
    }
    AddLaw(stop.place, law);
  }

  void AddForce(const MotorDescription& motor) {
    MotorLaw law;
    law.force = motor.force;
    law.target = motor.target;
    law.proportional = CheckNotNegative("proportional", motor.proportional);
    law.derivative = CheckNotNegative("derivative", motor.derivative);
    if (motor.limit) law.limit = CheckNotNegative("limit", *motor.limit);
    if (motor.target && law.proportional == 0 && law.derivative == 0) {
      Fail(*source_, Key("proportional"), "0, with a target", "a gain above zero",
           "a motion follows a target exactly");
    }
    AddLaw(motor.place, law);
  }

  void AddForce(const CallbackDescription& callback) {
    if (!callback.force) Fail(*source_, Key("force"), "nothing", "a function");
    AddLaw(callback.place, CallbackLaw{callback.force});
  }

  void AddForce(const WrenchCallbackDescription& callback) {
    if (!callback.wrench) Fail(*source_, Key("wrench"), "nothing", "a function");
    WrenchFunction<DifferencedWrench> element;
    element.a = MakeFrame("a", callback.a);
    element.b = MakeFrame("b", callback.b);
    CheckApart(callback.a, element.a, callback.b, element.b);
    element.function = {callback.wrench};
    AddElement(std::move(element));
  }

  void CheckMatrix(const char* part, const BushingDescription::Matrix6& matrix) const {
    Eigen::Matrix<double, 6, 6> M;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) M(i, j) = CheckFinite(part, matrix[i][j]);
    }
    // translations and rotations have their own units: compare in those that make the diagonal 1
    Eigen::Matrix<double, 6, 1> scale = M.diagonal().cwiseAbs().cwiseSqrt();
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < i; ++j) {
        if (std::abs(M(i, j) - M(j, i)) > 1e-9 * (std::abs(M(i, j)) + std::abs(M(j, i)))) {
          Fail(*source_, Key(part),
               fmt::format("{:g} in row {}, column {}, and {:g} mirrored", M(i, j), i + 1, j + 1,
                           M(j, i)),
               "a symmetric matrix: no other has a potential");
        }
      }
      scale[i] = scale[i] > 0 ? 1 / scale[i] : 1;
    }
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(
                             scale.asDiagonal() * M * scale.asDiagonal(), Eigen::EigenvaluesOnly)
                             .eigenvalues()[0];
    if (least < -1e-9) {
      Fail(*source_, Key(part), "a matrix with a negative eigenvalue",
           "a positive semi-definite matrix");
    }
  }

  void AddForce(const BushingDescription& bushing) {
    static constexpr const char* kAxes[6] = {"x", "y", "z", "turn_x", "turn_y", "turn_z"};
    Bushing element;
    element.a = MakeFrame("a", bushing.a);
    element.b = MakeFrame("b", bushing.b);
    CheckApart(bushing.a, element.a, bushing.b, element.b);
    for (int i = 0; i < 6; ++i) {
      element.stiffness[i] =
          ScalarLaw(bushing.stiffness[i], *source_, Key("stiffness.") + kAxes[i]);
      element.damping[i] = MakeDampingLaw(bushing.damping[i], *source_, Key("damping.") + kAxes[i]);
      element.preload[i] = CheckFinite("preload", bushing.preload[i]);
    }
    if (bushing.coupled_stiffness) {
      CheckMatrix("coupled_stiffness", *bushing.coupled_stiffness);
      element.K = *bushing.coupled_stiffness;
      element.coupled = true;
    }
    if (bushing.coupled_damping) {
      CheckMatrix("coupled_damping", *bushing.coupled_damping);
      element.C = *bushing.coupled_damping;
      element.coupled = true;
    }
    AddElement(std::move(element));
  }

  void AddForce(const BodyForceDescription& force) {
    if (!IsFinite(force.force)) Fail(*source_, Key("force"), "a number that is not finite", "N");
    if (!IsFinite(force.torque)) {
      Fail(*source_, Key("torque"), "a number that is not finite", "N m");
    }
    BodyForce element;
    element.at = MakeFrame("at", force.at);
    if (element.at.link == 0) {
      Fail(*source_, Key("at"), fmt::format("'{}', which does not move", force.at.body),
           "a body that moves");
    }
    element.force = force.force;
    element.torque = force.torque;
    element.turns = force.axes == BodyForceDescription::Axes::kFrame;
    element.scale = force.scale;
    AddElement(std::move(element));
  }

  Mechanism& mechanism_;
  std::vector<double> start_;
  mechanism::Workspace<double> w_;
  std::vector<std::unique_ptr<mechanism::ForceGroup>> groups_;
  std::map<std::type_index, mechanism::ForceGroup*> places_;
  std::set<std::string> names_;
  const Source* source_ = nullptr;
  std::string key_;
};

}  // namespace

void AddForces(const std::vector<ForceDescription>& forces, Mechanism& mechanism) {
  Adder adder(mechanism);
  for (const ForceDescription& force : forces) adder.Add(force);
  adder.Finish();
}

}  // namespace kingpin::joints
