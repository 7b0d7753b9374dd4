#include "models/planar/front_compliance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include <gtest/gtest.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "models/parameters/front_geometry.h"
#include "tests/models/parameters/c_segment.h"

namespace kingpin::planar {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using parameters::CSegment;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

// The stiffness of the rod's chain with the rack's mounts with which the data set was computed.
constexpr double kPrintedRod = 5.0e6;

FrontCompliance WithRod() { return {CSegment().front, {.tie_rod_stiffness = kPrintedRod}}; }
FrontCompliance WithoutRod() { return {CSegment().front, {}}; }

Vector3d WheelCentre() { return CSegment().front.hardpoints.wheel_centre; }
Vector3d Patch() {
  Vector3d patch = WheelCentre();
  patch.z() = CSegment().body.ground_height;
  return patch;
}

void ExpectPrinted(const Matrix3d& matrix, const double (&printed)[6]) {
  int k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j, ++k) {
      // Three printed digits: half a unit of the third one.
      const double unit = std::pow(10.0, std::floor(std::log10(std::abs(printed[k]))) - 2.0);
      EXPECT_NEAR(matrix(i, j), printed[k], 0.501 * unit) << i << ", " << j;
      EXPECT_NEAR(matrix(i, j), matrix(j, i), 1e-9 * matrix.norm());
    }
  }
}

// These assumptions give every printed digit: height free, coil and top mount in series along the
// strut, ball joint 4e7 N/m, rod (where it is) 5e6 N/m, no preload.
TEST(FrontCompliance, CondensedStiffnessIsThatOfTheDataSet) {
  ExpectPrinted(WithoutRod().CalcCondensed(WheelCentre(), false),
                {5.00e5, 2.38e5, 2.76e4, 3.98e6, 1.11e4, 1.52e3});
  // k_yy comes out as 5.575e6: printed 5.57e6, within rounding of the print.
  ExpectPrinted(WithRod().CalcCondensed(WheelCentre(), false),
                {5.26e5, 4.41e5, -1.06e4, 5.57e6, -2.88e5, 5.76e4});
  // Height held: c_L rises to 7.3e6 N/m.
  EXPECT_NEAR(WithoutRod().CalcCondensed(WheelCentre(), true)(1, 1), 7.3e6, 0.05e6);
}

TEST(FrontCompliance, CondensingIsInvertingTheCompliance) {
  const FrontCompliance front = WithRod();
  Matrix3d compliance;
  const Vector3d zero = Vector3d::Zero();
  const FrontCompliance::Vector12 loads[3] = {
      front.CalcLoad(WheelCentre(), Vector3d::UnitX()),
      front.CalcLoad(WheelCentre(), Vector3d::UnitY()),
      front.CalcLoad(WheelCentre(), zero, Vector3d::UnitZ())};
  for (int j = 0; j < 3; ++j) {
    const FrontCompliance::Displacement d = front.CalcLinearResponse(loads[j]);
    compliance.col(j) << d.translation.x(), d.translation.y(), d.rotation.z();
  }
  const Matrix3d product = compliance * front.CalcCondensed(WheelCentre(), false);
  EXPECT_LT((product - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(FrontCompliance, WithoutARodOnlyTheSteeringAxisIsFree) {
  const Vector3d k = parameters::CalcFrontGeometry(CSegment()).axis_at_hub;
  const Matrix3d at_k = WithoutRod().CalcCondensed(k, false);
  // Rank two: yaw about K costs nothing, to rounding.
  EXPECT_LT(at_k.col(2).cwiseAbs().maxCoeff(), 1e-8 * at_k.norm());
  const auto eigenvalues =
      Eigen::SelfAdjointEigenSolver<FrontCompliance::Matrix12>(WithoutRod().CalcStiffness())
          .eigenvalues();
  EXPECT_LT(std::abs(eigenvalues(0)), 1e-8);
  EXPECT_GT(eigenvalues(1), 1.0);
  EXPECT_THROW(
      WithoutRod().CalcLinearResponse(WithoutRod().CalcLoad(WheelCentre(), Vector3d::UnitX())),
      std::invalid_argument);
}

TEST(FrontCompliance, LinearComplianceIsThatOfTheDataSet) {
  const FrontCompliance front = WithRod();
  const double force = 1000.0;
  // Free-rolling wheel; printed x -2.05 mm, y +0.19 mm, toe +0.034 deg, camber -0.005 deg.
  FrontCompliance::Displacement d =
      front.CalcLinearResponse(front.CalcLoad(WheelCentre(), -force * Vector3d::UnitX()));
  EXPECT_NEAR(d.translation.x() * 1e3, -2.05, 0.005);
  EXPECT_NEAR(d.translation.y() * 1e3, 0.19, 0.005);
  EXPECT_NEAR(d.toe() / kDegree, 0.034, 0.0006);  // 0.0335: rounded up in print
  EXPECT_NEAR(d.camber() / kDegree, -0.005, 0.0005);
  // Locked wheel; -3.07 mm, toe -0.091 deg, camber -0.003 deg.
  d = front.CalcLinearResponse(front.CalcLoad(Patch(), -force * Vector3d::UnitX()));
  // -3.0646: one unit of the last digit off; the patch's height, itself rounded, counts 0.003 per
  // mm.
  EXPECT_NEAR(d.translation.x() * 1e3, -3.07, 0.01);
  EXPECT_NEAR(d.toe() / kDegree, -0.091, 0.0005);
  EXPECT_NEAR(d.camber() / kDegree, -0.003, 0.0005);
  // Lateral force at the patch; y +0.37 mm, z +5.6 mm, toe +0.033 deg, camber -0.122 deg.
  d = front.CalcLinearResponse(front.CalcLoad(Patch(), force * Vector3d::UnitY()));
  EXPECT_NEAR(d.translation.y() * 1e3, 0.37, 0.005);
  EXPECT_NEAR(d.translation.z() * 1e3, 5.6, 0.05);
  EXPECT_NEAR(d.toe() / kDegree, 0.033, 0.0005);
  EXPECT_NEAR(d.camber() / kDegree, -0.122, 0.0005);
  // Moment of 100 N m; toe +0.135 deg, camber +0.013 deg.
  d = front.CalcLinearResponse(
      front.CalcLoad(WheelCentre(), Vector3d::Zero(), 100.0 * Vector3d::UnitZ()));
  EXPECT_NEAR(d.toe() / kDegree, 0.135, 0.0005);
  EXPECT_NEAR(d.camber() / kDegree, 0.013, 0.0005);
  // Vertical force; z +47.2 mm, toe +0.18 deg, camber -0.64 deg.
  d = front.CalcLinearResponse(front.CalcLoad(WheelCentre(), force * Vector3d::UnitZ()));
  EXPECT_NEAR(d.translation.z() * 1e3, 47.2, 0.05);
  EXPECT_NEAR(d.toe() / kDegree, 0.18, 0.005);
  EXPECT_NEAR(d.camber() / kDegree, -0.64, 0.005);
  // Wheel rate with bushings 21.2 kN/m.
  EXPECT_NEAR(force / d.translation.z(), 21.2e3, 50.0);
}

double Recession(const FrontCompliance& front, double force) {
  const FrontCompliance::Vector12 q =
      front.SolveEquilibrium(front.CalcLoad(WheelCentre(), force * Vector3d::UnitX()));
  return q(0);
}

// The data set's recession curve is that of the rear bushing's law alone, with the share of the
// force that goes through it fixed at its linear value: that reproduces the table to 0.01 mm. In
// equilibrium the share falls as the bushing stiffens, which gives up to 0.05 mm less.
TEST(FrontCompliance, RecessionCurveIsThatOfTheDataSet) {
  const double forces[] = {1e3, 2e3, 3e3, 4e3, 6e3, 8e3};
  const double printed[] = {2.04e-3, 3.86e-3, 5.31e-3, 6.54e-3, 8.71e-3, 10.68e-3};
  const FrontCompliance front(CSegment().front,
                              {.tie_rod_stiffness = kPrintedRod,
                               .progression = FrontComplianceOptions::Progression::kRearLateral});
  const parameters::BushingAxis& rear = CSegment().front.arm_rear.y;
  const FrontCompliance::Vector12 unit = front.CalcLoad(WheelCentre(), Vector3d::UnitX());
  const FrontCompliance::Vector12 shape = front.CalcStiffness().ldlt().solve(unit);
  double share = 0.0;
  for (const FrontCompliance::Element& element : front.elements()) {
    if (element.progression > 0.0) share = rear.stiffness * element.row.dot(shape);
  }
  for (std::size_t i = 0; i < std::size(forces); ++i) {
    const double through = std::abs(share) * forces[i];
    double d = 0.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      const double r4 = std::pow(d / rear.progression, 4);
      d -= (rear.stiffness * d * (1.0 + r4) - through) / (rear.stiffness * (1.0 + 5.0 * r4));
    }
    const double superposed =
        unit.dot(shape) * forces[i] - std::abs(share) * (through / rear.stiffness - d);
    EXPECT_NEAR(superposed, printed[i], 0.01e-3) << forces[i];
    const double solved = Recession(front, forces[i]);
    EXPECT_NEAR(solved, printed[i], 0.05e-3) << forces[i];
    EXPECT_LT(solved, superposed + 1e-9);
  }
}

TEST(FrontCompliance, LawsOfAllBushingsStiffenRecessionFurther) {
  const FrontCompliance all(CSegment().front, {.tie_rod_stiffness = kPrintedRod});
  const FrontCompliance rear(CSegment().front,
                             {.tie_rod_stiffness = kPrintedRod,
                              .progression = FrontComplianceOptions::Progression::kRearLateral});
  double last = 0.0;
  for (double force = 500.0; force <= 8000.0; force += 500.0) {
    const double x = Recession(all, force);
    EXPECT_GT(x, last);
    EXPECT_LT(x, Recession(rear, force));
    EXPECT_NEAR(Recession(all, -force), -x, 1e-12);
    last = x;
  }
}

TEST(FrontCompliance, SolvedForceGivesTheRecessionAskedFor) {
  const FrontCompliance front = WithoutRod();
  const Vector3d k = parameters::CalcFrontGeometry(CSegment()).axis_at_hub;
  for (const double recession : {-9e-3, -2e-3, -1e-6, 1e-6, 1e-3, 5e-3, 1.2e-2}) {
    const double force = front.SolveForce(k, recession);
    const FrontCompliance::Vector12 q =
        front.SolveEquilibrium(front.CalcLoad(k, force * Vector3d::UnitX()));
    EXPECT_NEAR(front.CalcPointDisplacement(q, k).x(), recession, 1e-9 * std::abs(recession));
  }
}

struct KinsolProblem {
  const FrontCompliance* front;
  FrontCompliance::Vector12 load;
};

int KinsolResidual(N_Vector x, N_Vector f, void* data) {
  const auto* problem = static_cast<const KinsolProblem*>(data);
  const Eigen::Map<const FrontCompliance::Vector12> q(N_VGetArrayPointer(x));
  Eigen::Map<FrontCompliance::Vector12> residual(N_VGetArrayPointer(f));
  residual = -problem->load;
  for (const FrontCompliance::Element& element : problem->front->elements()) {
    const double d = element.row.dot(q);
    residual += element.stiffness * d * (1.0 + std::pow(d * element.progression, 4)) *
                element.row.transpose();
  }
  return 0;
}

// Second route: SUNDIALS KINSOL with difference Jacobians on the residual.
TEST(FrontCompliance, EquilibriumAgreesWithKinsol) {
  const FrontCompliance front(CSegment().front, {.tie_rod_stiffness = kPrintedRod});
  sundials::Context context;
  for (const double force : {300.0, 3000.0, -8000.0}) {
    KinsolProblem problem{&front,
                          front.CalcLoad(Patch(), Vector3d(force, 0.5 * force, -0.2 * force))};
    N_Vector x = N_VNew_Serial(12, context);
    N_Vector one = N_VNew_Serial(12, context);
    N_VConst(0.0, x);
    N_VConst(1.0, one);
    void* memory = KINCreate(context);
    ASSERT_EQ(KINInit(memory, KinsolResidual, x), KIN_SUCCESS);
    KINSetUserData(memory, &problem);
    KINSetFuncNormTol(memory, 1e-7);
    KINSetScaledStepTol(memory, 1e-16);
    KINSetMaxNewtonStep(memory, 1.0);
    SUNMatrix matrix = SUNDenseMatrix(12, 12, context);
    SUNLinearSolver solver = SUNLinSol_Dense(x, matrix, context);
    ASSERT_EQ(KINSetLinearSolver(memory, solver, matrix), KIN_SUCCESS);
    const int status = KINSol(memory, x, KIN_LINESEARCH, one, one);
    EXPECT_GE(status, 0) << force;
    const FrontCompliance::Vector12 ours = front.SolveEquilibrium(problem.load);
    const Eigen::Map<const FrontCompliance::Vector12> theirs(N_VGetArrayPointer(x));
    // A residual of 1e-7 N over the softest stiffness, 2e4 N/m, is 5e-12 m.
    EXPECT_LT((ours - theirs).cwiseAbs().maxCoeff(), 1e-10) << force;
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    KINFree(&memory);
    N_VDestroy(one);
    N_VDestroy(x);
  }
}

TEST(FrontCompliance, DampingOfTheHydraulicBushingIsThatOfTheDataSet) {
  // b = 0.45 k/(2π 17 Hz) = 2.3e3 N s/m.
  EXPECT_NEAR(CalcBushingDamping(CSegment().front.arm_rear.y), 2.3e3, 50.0);
  // η = 0.12/(2π 15 Hz) = 1.3e-3 s.
  const parameters::BushingAxis& axis = CSegment().front.arm_front.y;
  EXPECT_NEAR(CalcBushingDamping(axis) / axis.stiffness, 1.3e-3, 0.05e-3);
}

// For a harmonic motion with the static shape, the energy each damper takes per cycle is
// π b ω (j q)²; the sum is that of one damper b_x on the point's own motion.
TEST(FrontCompliance, ProjectedDampingDissipatesTheSameEnergy) {
  const FrontCompliance front = WithoutRod();
  const Vector3d k = parameters::CalcFrontGeometry(CSegment()).axis_at_hub;
  const FrontCompliance::Displacement d =
      front.CalcLinearResponse(front.CalcLoad(k, 1000.0 * Vector3d::UnitX()));
  // The same motion from its own geometry: arm rotation about z from both bushings.
  const double x = (d.translation + d.rotation.cross(k - WheelCentre())).x();
  const FrontCompliance::Vector12 q =
      front.SolveEquilibrium(front.CalcLoad(k, 1e-3 * Vector3d::UnitX()));
  double sum = 0.0;
  for (const FrontCompliance::Element& element : front.elements()) {
    sum += element.damping * std::pow(element.row.dot(q) * 1e6 / x, 2);
  }
  EXPECT_NEAR(front.CalcDamping(k), sum, 1e-6 * sum);
  // Of the order of the hydraulic bushing's, which nearly moves as the wheel centre does.
  EXPECT_GT(front.CalcDamping(k), 0.5 * CalcBushingDamping(CSegment().front.arm_rear.y));
  EXPECT_LT(front.CalcDamping(k), CalcBushingDamping(CSegment().front.arm_rear.y));
}

TEST(FrontCompliance, DynamicRubberStiffensButLeavesSteelAlone) {
  const FrontCompliance soft = WithRod();
  const FrontCompliance stiff(CSegment().front,
                              {.tie_rod_stiffness = kPrintedRod, .dynamic_rubber = true});
  const double ratio = Recession(soft, 1.0) / Recession(stiff, 1.0);
  EXPECT_GT(ratio, 1.2);
  EXPECT_LT(ratio, CSegment().front.rubber_dynamic_factor);
}

}  // namespace
}  // namespace kingpin::planar
