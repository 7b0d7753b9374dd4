#include "models/parameters/part_schemas.h"

#include <Eigen/Eigenvalues>

#include <fmt/format.h>

namespace kingpin::parameters {

namespace {

// Beyond this no point of a car lies, in any direction [m].
constexpr double kFarthest = 10.0;

}  // namespace

const io::Schema<RigidBody>& RigidBodySchema() {
  static const io::Schema<RigidBody> schema = [] {
    io::Schema<RigidBody> s("rigid_body", "A rigid part in design position, car frame.");
    s.Quantity("mass", &RigidBody::mass, "kg", "mass").Positive().Max(1e5);
    s.Point("centre_of_mass", &RigidBody::centre_of_mass, "m", "centre of mass")
        .Min(-kFarthest)
        .Max(kFarthest);
    s.Point("inertia", &RigidBody::inertia, "kg m^2", "Ixx, Iyy, Izz about the centre of mass")
        .Positive()
        .Max(1e6);
    s.Quantity("inertia_xz", &RigidBody::inertia_xz, "kg m^2",
               "entry xz of the tensor, minus the integral of x z dm")
        .Min(-1e6)
        .Max(1e6)
        .Default(0.0);
    s.Check([](const RigidBody& body, io::Check& check) {
      Eigen::Matrix3d tensor = body.inertia.asDiagonal();
      tensor(0, 2) = tensor(2, 0) = body.inertia_xz;
      const Eigen::Vector3d principal =
          Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor, Eigen::EigenvaluesOnly)
              .eigenvalues();
      const double slack = 1e-9 * principal.sum();
      if (principal(0) <= 0.0) {
        check.Fail("inertia_xz", fmt::format("{:g} kg m^2", body.inertia_xz),
                   "a tensor with positive principal moments",
                   "|Ixz| must stay below sqrt(Ixx Izz)");
      } else if (principal(2) > principal(0) + principal(1) + slack) {
        check.Fail("inertia",
                   fmt::format("principal moments {:g}, {:g}, {:g} kg m^2", principal(0),
                               principal(1), principal(2)),
                   "each at most the sum of the other two",
                   "no mass distribution has such an inertia; check the order Ixx, Iyy, Izz");
      }
    });
    return s;
  }();
  return schema;
}

const io::Schema<RevolvedBody>& RevolvedBodySchema() {
  static const io::Schema<RevolvedBody> schema = [] {
    io::Schema<RevolvedBody> s("revolved_body", "A body of revolution about its axle.");
    s.Quantity("mass", &RevolvedBody::mass, "kg", "mass").Positive().Max(1e4);
    s.Quantity("spin_inertia", &RevolvedBody::spin_inertia, "kg m^2", "about the axle")
        .Positive()
        .Max(1e4);
    s.Quantity("diameter_inertia", &RevolvedBody::diameter_inertia, "kg m^2", "about a diameter")
        .Positive()
        .Max(1e4);
    s.Check([](const RevolvedBody& body, io::Check& check) {
      if (body.spin_inertia <= 2.0 * body.diameter_inertia) return;
      check.Fail(
          "spin_inertia", fmt::format("{:g} kg m^2", body.spin_inertia),
          fmt::format("at most {:g} kg m^2, twice diameter_inertia", 2.0 * body.diameter_inertia),
          "no mass distribution has such an inertia");
    });
    return s;
  }();
  return schema;
}

const io::Schema<BushingAxis>& BushingAxisSchema() {
  static const io::Schema<BushingAxis> schema = [] {
    io::Schema<BushingAxis> s("bushing_axis",
                              "One axis of a bushing: F = k d (1 + (|d|/d0)^4) + b d'.");
    s.Quantity("stiffness", &BushingAxis::stiffness, "N/m", "k, static").Positive().Max(1e10);
    s.Quantity("progression", &BushingAxis::progression, "m",
               "d0, the displacement at which the stiffness has doubled; absent: linear")
        .Positive()
        .Max(1.0)
        .Optional();
    s.Quantity("loss_factor", &BushingAxis::loss_factor, "1",
               "tan(delta); b = (loss factor) k/(2 pi f)")
        .NonNegative()
        .Max(3.0);
    s.Quantity("loss_frequency", &BushingAxis::loss_frequency, "Hz",
               "f, at which the loss factor was measured")
        .Positive()
        .Max(1000.0)
        .Default(15.0);
    return s;
  }();
  return schema;
}

const io::Schema<Bushing>& BushingSchema() {
  static const io::Schema<Bushing> schema = [] {
    io::Schema<Bushing> s("bushing", "A bushing, axes along the car's x, y, z.");
    s.Point("position", &Bushing::position, "m", "centre").Min(-kFarthest).Max(kFarthest);
    s.Section("x", &Bushing::x, BushingAxisSchema(), "along x");
    s.Section("y", &Bushing::y, BushingAxisSchema(), "along y");
    s.Section("z", &Bushing::z, BushingAxisSchema(), "along z");
    s.Point("rotation", &Bushing::rotation, "N m/rad", "rotational stiffness about x, y, z")
        .NonNegative()
        .Max(1e6);
    return s;
  }();
  return schema;
}

const io::Schema<SpringDamper>& SpringDamperSchema() {
  static const io::Schema<SpringDamper> schema = [] {
    io::Schema<SpringDamper> s("spring_damper", "Coil spring, damper and stops of one side.");
    s.Quantity("spring_rate", &SpringDamper::spring_rate, "N/m", "of the coil").Positive().Max(1e6);
    s.Curve("rebound", &SpringDamper::rebound, {"speed", "m/s"}, {"force", "N"},
            "damper being extended")
        .Increasing()
        .Monotone();
    s.Curve("compression", &SpringDamper::compression, {"speed", "m/s"}, {"force", "N"},
            "damper being compressed")
        .Increasing()
        .Monotone();
    s.Quantity("jounce_clearance", &SpringDamper::jounce_clearance, "m",
               "travel from design position to the bumper's contact")
        .NonNegative()
        .Max(1.0);
    s.Curve("bumper", &SpringDamper::bumper, {"compression", "m"}, {"force", "N"}, "bump stop")
        .Increasing()
        .Monotone();
    s.Quantity("rebound_clearance", &SpringDamper::rebound_clearance, "m",
               "travel from design position to the rebound stop")
        .NonNegative()
        .Max(1.0);
    s.Quantity("rebound_stop_stiffness", &SpringDamper::rebound_stop_stiffness, "N/m",
               "of the rebound stop")
        .Positive()
        .Max(1e9);
    s.Quantity("friction", &SpringDamper::friction, "N", "dry friction").NonNegative().Max(1e4);
    s.Quantity("gas_force", &SpringDamper::gas_force, "N", "pushes the damper apart")
        .NonNegative()
        .Max(1e4);
    s.Check([](const SpringDamper& part, io::Check& check) {
      for (const auto& [key, table] :
           {std::pair("rebound", &part.rebound), std::pair("compression", &part.compression),
            std::pair("bumper", &part.bumper)}) {
        if (table->x.front() >= 0.0 && table->y.front() >= 0.0) continue;
        check.Fail(key, fmt::format("first row {:g}, {:g}", table->x.front(), table->y.front()),
                   "rows that are not negative", "both directions have a table of their own");
      }
    });
    return s;
  }();
  return schema;
}

}  // namespace kingpin::parameters
