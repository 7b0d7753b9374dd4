#include "optimisation/algorithms/local_search.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlopt.h>

namespace kingpin::optimisation {
namespace {

struct Session {
  SearchView& view;
  nlopt_opt opt;
  bool compares_only;       ///< the algorithm uses the order of values and nothing else
  bool constrained;         ///< the algorithm is given the constraints
  bool has_bound_variable;  ///< the last variable is the common bound of all terms (Chebyshev)
  std::vector<double> point;
  bool has_gradient = false;
  int bad_points = 0;
  std::exception_ptr error;

  /// Makes the view hold `u`. False when there is nothing to show for it.
  bool Load(const double* u, bool gradient) {
    const std::size_t n = view.space().size();
    if (error) return false;
    for (std::size_t k = 0; k < n; ++k) {
      if (std::isfinite(u[k])) continue;
      if (++bad_points > 5) nlopt_force_stop(opt);
      return false;
    }
    if (point.size() == n && std::equal(point.begin(), point.end(), u) &&
        (has_gradient || !gradient)) {
      return true;
    }
    try {
      view.Evaluate({u, n}, gradient, !constrained && !view.space().rows().empty());
      point.assign(u, u + n);
      has_gradient = gradient;
      return true;
    } catch (...) {
      error = std::current_exception();
      point.clear();
      nlopt_force_stop(opt);
      return false;
    }
  }

  double CalcBarrier() const {
    if (view.highest() < view.lowest()) return 1.0;  // nothing finite yet
    const double spread = view.highest() - view.lowest();
    return view.highest() + spread + 1e-3 * std::max(std::abs(view.highest()), 1e-12);
  }

  double CalcValue() const {
    const Merit& merit = view.merit(0);
    if (compares_only) {
      if (merit.feasible()) return merit.value;
      if (!std::isfinite(merit.violation)) return 1e300;
      return 1e30 * (1e-9 + merit.violation);  // behind every feasible one, ordered by violation
    }
    return std::isfinite(merit.value) ? merit.value : CalcBarrier();
  }
};

double CallObjective(unsigned n, const double* u, double* gradient, void* data) {
  auto& session = *static_cast<Session*>(data);
  const std::size_t dim = session.view.space().size();
  if (gradient != nullptr) std::fill_n(gradient, n, 0.0);
  if (!session.Load(u, gradient != nullptr)) {
    return session.compares_only ? 1e300 : session.CalcBarrier();
  }
  if (gradient != nullptr) session.view.GetGradient(0, {gradient, dim});
  if (!session.has_bound_variable) return session.CalcValue();
  // The common bound, plus the small share of the sum that Scalarisation::Calc() adds.
  double value = u[dim];
  if (std::isfinite(session.view.merit(0).value)) {
    const std::size_t terms = session.view.scalarisation().weights.size();
    for (std::size_t k = 0; k < terms; ++k) value += 1e-3 * session.view.CalcTerm(0, k);
  }
  if (gradient != nullptr) {
    for (std::size_t k = 0; k < dim; ++k) gradient[k] *= 1e-3;
    gradient[dim] = 1;
  }
  return value;
}

void FillLinear(const Session& session, bool equality, std::size_t j, unsigned n, const double* u,
                double* result, double* gradient) {
  for (const SearchSpace::Row& row : session.view.space().rows()) {
    if (row.equality != equality) continue;
    double sum = -row.b;
    for (std::size_t k = 0; k < row.a.size(); ++k) sum += row.a[k] * u[k];
    result[j] = sum;
    if (gradient != nullptr) std::copy(row.a.begin(), row.a.end(), gradient + j * n);
    ++j;
  }
}

// A constraint of a bad point is called violated, by an amount that keeps the models finite.
double MakeFinite(double value) { return std::isfinite(value) ? value : 1.0; }

void CallInequalities(unsigned m, double* result, unsigned n, const double* u, double* gradient,
                      void* data) {
  auto& session = *static_cast<Session*>(data);
  std::fill_n(result, m, 1.0);
  if (gradient != nullptr) std::fill_n(gradient, std::size_t{m} * n, 0.0);
  if (!session.Load(u, gradient != nullptr)) return;
  const std::size_t dim = session.view.space().size();
  std::size_t at = 0;
  if (session.has_bound_variable) {
    for (; at < session.view.scalarisation().weights.size(); ++at) {
      const double term = session.view.CalcTerm(0, at);
      result[at] = std::isfinite(term) ? term - u[dim] : 1.0;
      if (gradient != nullptr) {
        session.view.GetTermGradient(0, at, {gradient + at * n, dim});
        gradient[at * n + dim] = -1;
      }
    }
  }
  const std::size_t nonlinear = session.view.problem().inequalities.names.size();
  for (std::size_t j = 0; j < nonlinear; ++j, ++at) {
    result[at] = MakeFinite(session.view.inequality(0, j));
    if (gradient != nullptr) session.view.GetInequalityGradient(0, j, {gradient + at * n, dim});
  }
  FillLinear(session, false, at, n, u, result, gradient);
}

void CallEqualities(unsigned m, double* result, unsigned n, const double* u, double* gradient,
                    void* data) {
  auto& session = *static_cast<Session*>(data);
  std::fill_n(result, m, 1.0);
  if (gradient != nullptr) std::fill_n(gradient, std::size_t{m} * n, 0.0);
  if (!session.Load(u, gradient != nullptr)) return;
  const std::size_t dim = session.view.space().size();
  const std::size_t nonlinear = session.view.problem().equalities.names.size();
  for (std::size_t j = 0; j < nonlinear; ++j) {
    result[j] = MakeFinite(session.view.equality(0, j));
    if (gradient != nullptr) session.view.GetEqualityGradient(0, j, {gradient + j * n, dim});
  }
  FillLinear(session, true, nonlinear, n, u, result, gradient);
}

nlopt_algorithm GetNloptAlgorithm(Algorithm algorithm, std::size_t n) {
  switch (algorithm) {
    case Algorithm::kSbplx:
      return NLOPT_LN_SBPLX;
    case Algorithm::kBobyqa:
      return n > 1 ? NLOPT_LN_BOBYQA : NLOPT_LN_NELDERMEAD;
    case Algorithm::kCobyla:
      return NLOPT_LN_COBYLA;
    case Algorithm::kSlsqp:
      return NLOPT_LD_SLSQP;
    default:
      return NLOPT_LN_NELDERMEAD;
  }
}

std::string Describe(nlopt_result code, const Session& session) {
  if (session.bad_points > 5) return "stopped: the algorithm proposed points that are not finite";
  switch (code) {
    case NLOPT_SUCCESS:
    case NLOPT_STOPVAL_REACHED:
      return "converged";
    case NLOPT_FTOL_REACHED:
      return "converged: the value no longer changes";
    case NLOPT_XTOL_REACHED:
      return "converged: the step is below its tolerance";
    case NLOPT_MAXEVAL_REACHED:
    case NLOPT_MAXTIME_REACHED:
      return "stopped at the limit of evaluations";
    case NLOPT_ROUNDOFF_LIMITED:
      return "converged as far as rounding allows";
    case NLOPT_FORCED_STOP:
      return "stopped";
    default:
      return "ended without convergence";
  }
}

}  // namespace

std::string RunLocalSearch(SearchView& view, const LocalOptions& options,
                           std::span<const double> start) {
  const std::size_t n = view.space().size();
  if (n == 0) {
    view.Evaluate({});
    return "nothing to vary";
  }
  const nlopt_algorithm kind = GetNloptAlgorithm(options.algorithm, n);
  const bool simplex = kind == NLOPT_LN_NELDERMEAD || kind == NLOPT_LN_SBPLX;
  std::vector<double> u(start.begin(), start.end());
  view.space().Project(u);
  std::string status;
  long used = 0;
  const int runs = simplex ? 1 + options.fresh_simplexes : 1;
  for (int run = 0; run < runs; ++run) {
    const bool with_bound = kind == NLOPT_LD_SLSQP && view.scalarisation().chebyshev;
    const std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)> opt(
        nlopt_create(kind, static_cast<unsigned>(with_bound ? n + 1 : n)), &nlopt_destroy);
    Session session{.view = view,
                    .opt = opt.get(),
                    .compares_only = simplex,
                    .constrained = kind == NLOPT_LN_COBYLA || kind == NLOPT_LD_SLSQP,
                    .has_bound_variable = with_bound,
                    .point = {},
                    .error = {}};
    nlopt_set_lower_bounds1(opt.get(), 0.0);
    nlopt_set_upper_bounds1(opt.get(), 1.0);
    if (with_bound) {
      // Terms are of order one; the bound begins where they are.
      nlopt_set_lower_bound(opt.get(), static_cast<int>(n), -1e3);
      nlopt_set_upper_bound(opt.get(), static_cast<int>(n), 1e3);
      view.Evaluate(u);
      double bound = -1e3;
      for (std::size_t k = 0; k < view.scalarisation().weights.size(); ++k) {
        bound = std::max(bound, view.CalcTerm(0, k));
      }
      u.push_back(std::clamp(bound, -1e3, 1e3));
    }
    nlopt_set_min_objective(opt.get(), &CallObjective, &session);
    if (session.constrained) {
      std::size_t inequalities = view.problem().inequalities.names.size();
      if (with_bound) inequalities += view.scalarisation().weights.size();
      std::size_t equalities = view.problem().equalities.names.size();
      for (const SearchSpace::Row& row : view.space().rows()) {
        ++(row.equality ? equalities : inequalities);
      }
      const std::vector<double> tolerance(std::max(inequalities, equalities), 1e-10);
      if (inequalities > 0) {
        nlopt_add_inequality_mconstraint(opt.get(), static_cast<unsigned>(inequalities),
                                         &CallInequalities, &session, tolerance.data());
      }
      if (equalities > 0) {
        nlopt_add_equality_mconstraint(opt.get(), static_cast<unsigned>(equalities),
                                       &CallEqualities, &session, tolerance.data());
      }
    }
    nlopt_set_xtol_abs1(opt.get(), options.step_tolerance);
    // A simplex can have equal values at its corners far from any minimum: only its size counts.
    nlopt_set_ftol_rel(opt.get(), simplex ? 0.0 : options.value_tolerance);
    nlopt_set_maxeval(opt.get(), static_cast<int>(std::max(1L, options.max_evaluations - used)));
    nlopt_set_initial_step1(opt.get(), options.initial_step);
    const Merit before = view.best();
    const bool had_best = view.evaluations() > 0;
    double value = 0;
    const nlopt_result code = nlopt_optimize(opt.get(), u.data(), &value);
    if (session.error) std::rethrow_exception(session.error);
    status = Describe(code, session);
    used += nlopt_get_numevals(opt.get());
    if (used >= options.max_evaluations || !std::isfinite(view.best().value)) break;
    const double gain = before.value - view.best().value;
    if (run > 0 && had_best && before.violation == view.best().violation &&
        gain <= 1e-9 * std::abs(view.best().value)) {
      break;
    }
    u = view.best_u();
  }
  return status;
}

}  // namespace kingpin::optimisation
