#include "core/solve/adaptive.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <arkode/arkode_arkstep.h>
#include <cvodes/cvodes.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "core/mechanism/jacobian.h"
#include "core/mechanism/kinematics.h"

namespace kingpin::solve {

namespace {

// What both libraries call back into: rates that report failure instead of throwing through C code.
struct Callbacks {
  mechanism::Evaluator* evaluator;
  StepperOptions options;
  std::string failure;

  int CalcRates(double time, N_Vector y, N_Vector rate) {
    const size_t n = static_cast<size_t>(N_VGetLength(y));
    try {
      evaluator->CalcRates(time, {N_VGetArrayPointer(y), n}, {N_VGetArrayPointer(rate), n});
    } catch (const std::runtime_error& error) {
      failure = error.what();
      return 1;
    }
    const double* r = N_VGetArrayPointer(rate);
    return std::all_of(r, r + n, [](double x) { return std::isfinite(x); }) ? 0 : 1;
  }
  int Project(double time, N_Vector y) {
    try {
      evaluator->Project(time, {N_VGetArrayPointer(y), static_cast<size_t>(N_VGetLength(y))},
                         options.projection_tolerance, 0);
    } catch (const std::runtime_error& error) {
      failure = error.what();
      return 1;
    }
    return 0;
  }
};

int CalcRatesOf(double time, N_Vector y, N_Vector rate, void* callbacks) {
  return static_cast<Callbacks*>(callbacks)->CalcRates(time, y, rate);
}

void Silent(int, const char*, const char*, char*, void*) {}

class SundialsStepper : public Stepper {
 public:
  SundialsStepper(mechanism::Evaluator& evaluator, const StepperOptions& options)
      : callbacks_{&evaluator, options, {}},
        y_(N_VNew_Serial(evaluator.system().size(), context_)) {}
  ~SundialsStepper() override { N_VDestroy(y_); }

 protected:
  void Load(std::span<const double> y) { std::copy(y.begin(), y.end(), N_VGetArrayPointer(y_)); }
  void Store(std::span<double> y) const {
    std::copy_n(N_VGetArrayPointer(y_), y.size(), y.begin());
  }
  [[noreturn]] void Fail(double time, const char* library, int flag) const {
    throw std::runtime_error(fmt::format("{} gives up at t = {:g} s (code {}){}{}", library, time,
                                         flag, callbacks_.failure.empty() ? "" : ": ",
                                         callbacks_.failure));
  }

  sundials::Context context_;
  Callbacks callbacks_;
  N_Vector y_;
};

class Explicit8 : public SundialsStepper {
 public:
  Explicit8(mechanism::Evaluator& evaluator, const StepperOptions& options)
      : SundialsStepper(evaluator, options) {}
  ~Explicit8() override { ARKStepFree(&memory_); }

  double Advance(double time, double limit, std::span<double> y) override {
    Start(time, y);
    if (int flag = ARKStepSetStopTime(memory_, limit); flag < 0) Fail(time, "ARKODE", flag);
    double reached = time;
    const int flag = ARKStepEvolve(memory_, limit, y_, &reached, ARK_ONE_STEP);
    if (flag < 0) Fail(reached, "ARKODE", flag);
    Store(y);
    ++steps;
    return reached;
  }
  // Integrated anew with the same tolerances: the interpolant of a method of order 8 has far lower
  // order.
  void Redo(double time, double end, std::span<double> y) override {
    started_ = false;
    Start(time, y);
    ARKStepSetStopTime(memory_, end);
    double reached = time;
    const int flag = ARKStepEvolve(memory_, end, y_, &reached, ARK_NORMAL);
    if (flag < 0) Fail(reached, "ARKODE", flag);
    Store(y);
    started_ = false;
  }
  void Restart() override { started_ = false; }

 private:
  void Start(double time, std::span<const double> y) {
    if (started_) return;
    Load(y);
    if (memory_ == nullptr) {
      memory_ = ARKStepCreate(CalcRatesOf, nullptr, time, y_, context_);
      ARKStepSetErrHandlerFn(memory_, Silent, nullptr);
      ARKStepSetUserData(memory_, &callbacks_);
      ARKStepSStolerances(memory_, callbacks_.options.relative_tolerance,
                          callbacks_.options.absolute_tolerance);
      ARKStepSetOrder(memory_, 8);
      ARKStepSetMaxNumSteps(memory_, 100000000);
      ARKStepSetPostprocessStepFn(memory_, [](double t, N_Vector v, void* callbacks) {
        return static_cast<Callbacks*>(callbacks)->Project(t, v);
      });
    } else if (int flag = ARKStepReset(memory_, time, y_); flag < 0) {
      Fail(time, "ARKODE", flag);
    }
    started_ = true;
  }

  void* memory_ = nullptr;
  bool started_ = false;
};

class Bdf : public SundialsStepper {
 public:
  Bdf(mechanism::Evaluator& evaluator, const StepperOptions& options)
      : SundialsStepper(evaluator, options),
        derivatives_(evaluator.system()),
        dense_(derivatives_.rows(), derivatives_.columns()),
        unit_(evaluator.system().model.velocities, 0.0),
        direction_(evaluator.system().model.positions),
        matrix_(SUNDenseMatrix(evaluator.system().size(), evaluator.system().size(), context_)),
        solver_(SUNLinSol_Dense(y_, matrix_, context_)) {}
  ~Bdf() override {
    CVodeFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
  }

  double Advance(double time, double limit, std::span<double> y) override {
    Start(time, y);
    CVodeSetStopTime(memory_, limit);
    double reached = time;
    const int flag = CVode(memory_, limit, y_, &reached, CV_ONE_STEP);
    if (flag < 0) Fail(reached, "CVODE", flag);
    Store(y);
    ++steps;
    return reached;
  }
  void Redo(double /*time*/, double end, std::span<double> y) override {
    const int flag = CVodeGetDky(memory_, end, 0, y_);
    if (flag < 0) Fail(end, "CVODE", flag);
    callbacks_.Project(end, y_);
    Store(y);
  }
  void Restart() override { started_ = false; }

 private:
  void Start(double time, std::span<const double> y) {
    if (started_) return;
    Load(y);
    if (memory_ == nullptr) {
      memory_ = CVodeCreate(CV_BDF, context_);
      CVodeSetErrHandlerFn(memory_, Silent, nullptr);
      CVodeInit(
          memory_,
          [](double t, N_Vector v, N_Vector rate, void* self) {
            return static_cast<Bdf*>(self)->callbacks_.CalcRates(t, v, rate);
          },
          time, y_);
      CVodeSetUserData(memory_, this);
      CVodeSStolerances(memory_, callbacks_.options.relative_tolerance,
                        callbacks_.options.absolute_tolerance);
      CVodeSetLinearSolver(memory_, solver_, matrix_);
      CVodeSetJacFn(memory_, CalcJacobian);
      CVodeSetMaxNumSteps(memory_, 100000000);
      CVodeSetProjFn(memory_, Correct);
      CVodeSetProjFrequency(memory_, 1);
    } else if (int flag = CVodeReInit(memory_, time, y_); flag < 0) {
      Fail(time, "CVODE", flag);
    }
    started_ = true;
  }

  static int CalcJacobian(double time, N_Vector y, N_Vector, SUNMatrix matrix, void* self, N_Vector,
                          N_Vector, N_Vector) {
    return static_cast<Bdf*>(self)->FillJacobian(time, y, matrix) ? 0 : 1;
  }
  static int Correct(double time, N_Vector y, N_Vector correction, double /*tolerance*/,
                     N_Vector error, void* self) {
    return static_cast<Bdf*>(self)->CalcCorrection(time, y, correction, error);
  }

  int CalcCorrection(double time, N_Vector y, N_Vector correction, N_Vector /*error*/) {
    N_VScale(1, y, correction);
    if (callbacks_.Project(time, correction) != 0) return 1;
    N_VLinearSum(1, correction, -1, y, correction);
    return 0;
  }

  // d(q̇, v̇, ż)/d(q, v, z). The accelerations' derivatives come along directions of motion u; for
  // quaternions q = N u, so that ∂/∂q = ∂/∂u Nᵀ (NᵀN)⁻¹, and N(q) has orthogonal columns.
  // @returns false in a singular position, which a shorter step avoids
  bool FillJacobian(double time, N_Vector state, SUNMatrix matrix) {
    const mechanism::System& system = callbacks_.evaluator->system();
    const mechanism::Model& model = system.model;
    const int nq = model.positions, nv = model.velocities, nz = system.states, n = nv + nz;
    const std::span<const double> y(N_VGetArrayPointer(state), system.size());
    if (!derivatives_.Calc(time, y, callbacks_.evaluator->workspace().active, dense_)) return false;
    SUNMatZero(matrix);
    for (int j = 0; j < nv; ++j) {
      unit_[j] = 1;
      CalcPositionRates(model, y.data(), unit_.data(), direction_.data());
      unit_[j] = 0;
      double square = 0;
      for (double d : direction_) square += d * d;
      for (int r = 0; r < nq; ++r) {
        if (direction_[r] == 0) continue;
        SM_ELEMENT_D(matrix, r, nq + j) += direction_[r];
        for (int i = 0; i < n; ++i) {
          SM_ELEMENT_D(matrix, nq + i, r) += dense_(i, j) * direction_[r] / square;
        }
      }
      for (int i = 0; i < n; ++i) SM_ELEMENT_D(matrix, nq + i, nq + j) += dense_(i, nv + j);
    }
    for (int j = 0; j < nz; ++j) {
      for (int i = 0; i < n; ++i) SM_ELEMENT_D(matrix, nq + i, nq + nv + j) = dense_(i, 2 * nv + j);
    }
    ++jacobians;
    return true;
  }

  mechanism::JacobianEvaluator derivatives_;
  Eigen::MatrixXd dense_;
  std::vector<double> unit_, direction_;
  SUNMatrix matrix_;
  SUNLinearSolver solver_;
  void* memory_ = nullptr;
  bool started_ = false;
};

}  // namespace

std::unique_ptr<Stepper> MakeAdaptive(mechanism::Evaluator& evaluator,
                                      const StepperOptions& options) {
  if (options.method == Method::kExplicit8) return std::make_unique<Explicit8>(evaluator, options);
  return std::make_unique<Bdf>(evaluator, options);
}

}  // namespace kingpin::solve
