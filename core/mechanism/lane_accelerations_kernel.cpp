// Compiled once per instruction set; KINGPIN_ISA names its tag.
#include "core/math/pack.h"
#include "core/mechanism/dynamics.h"
#include "core/mechanism/lane_accelerations.h"

namespace kingpin::mechanism {

namespace {

using Isa = isa::KINGPIN_ISA;

/// N lanes, as many at a time as a register holds: the workspace of more of them would not fit into
/// the first-level cache, nor their values into the registers.
template <int N>
class Kernel final : public LaneAccelerations {
 public:
  static constexpr int kWidth = N < Isa::kLanes ? N : Isa::kLanes;
  using S = math::Pack<double, kWidth, Isa>;

  explicit Kernel(const Model& model)
      : model_(model), w_(model), q_(model.positions), v_(model.velocities), drive_(model.rows) {}

  int lanes() const override { return N; }

  bool Calc(const double* q, const double* v, const double* force, double* acceleration,
            double* reaction) override {
    bool safe = true;
    for (int lane = 0; lane < N; lane += kWidth) {
      safe &= CalcRegister(q + lane, v + lane, force + lane, acceleration + lane, reaction + lane);
    }
    return safe;
  }

 private:
  bool CalcRegister(const double* q, const double* v, const double* force, double* acceleration,
                    double* reaction) {
    const int nv = model_.velocities;
    for (int i = 0; i < model_.positions; ++i) q_[i] = S::Load(q + i * N);
    for (int i = 0; i < nv; ++i) v_[i] = S::Load(v + i * N);
    for (int i = 0; i < nv; ++i) w_.generalised[i] = S::Load(force + i * N);
    UpdatePositions(model_, q_.data(), w_);
    UpdateVelocities(model_, v_.data(), w_);
    UpdateClosures(model_, w_);
    for (Wrench<S>& f : w_.f) f = {};
    AssembleEquations(model_, drive_.data(), w_);
    model_.pattern.Factorise(w_.k.data());
    model_.pattern.BackSubstitute(w_.k.data(), w_.x.data());
    for (int i = 0; i < nv; ++i) w_.x[model_.pattern.position(i)].Store(acceleration + i * N);
    for (int r = 0; r < model_.rows; ++r) {
      (-w_.x[model_.pattern.position(model_.coordinates + r)]).Store(reaction + r * N);
    }
    auto safe = S(0.0) < S(1.0);
    for (int k = 0; k < model_.pattern.unknowns(); ++k) {
      const S share = w_.k[k] * S(model_.pivot_limits[k]);
      safe = safe & (share > S(0.0)) & (share < S(1.0));
    }
    return All(safe);
  }

  const Model& model_;
  Workspace<S> w_;
  std::vector<S> q_, v_, drive_;
};

}  // namespace

std::unique_ptr<LaneAccelerations> MakeLaneAccelerations(const Model& model, int lanes, Isa) {
  if (lanes == 1) return std::unique_ptr<LaneAccelerations>(new Kernel<1>(model));
  return std::unique_ptr<LaneAccelerations>(new Kernel<8>(model));
}

}  // namespace kingpin::mechanism
