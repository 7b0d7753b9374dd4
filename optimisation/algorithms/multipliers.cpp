#include "optimisation/algorithms/multipliers.h"

#include <Eigen/Dense>
#include <cmath>

namespace kingpin::optimisation {

std::vector<ActiveConstraint> FindActiveConstraints(Evaluator& evaluator, const Problem& problem,
                                                    const std::vector<double>& x,
                                                    double tolerance) {
  const auto n = static_cast<Eigen::Index>(problem.size());
  Batch batch;
  batch.Resize(problem, 1, true);
  batch.points = x;
  bool known = true;
  try {
    evaluator.Evaluate(batch);
  } catch (const SearchStopped&) {
    known = false;
    batch.inequalities.assign(batch.inequalities.size(), -1e300);
  }
  // Columns of the normals in scaled variables u, so that the least squares treats all alike.
  Eigen::VectorXd range(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Variable& variable = problem.variables[i];
    range[i] = variable.upper - variable.lower;
  }
  std::vector<ActiveConstraint> active;
  std::vector<Eigen::VectorXd> normals;
  const auto add = [&](const std::string& name, const char* kind, const Eigen::VectorXd& normal) {
    active.push_back({name, kind, std::nullopt});
    normals.push_back(normal.cwiseProduct(range));
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Variable& variable = problem.variables[i];
    if (variable.lower == variable.upper) continue;
    const double near = tolerance * range[i];
    if (x[i] - variable.lower <= near) {
      add(variable.name, "lower bound", -Eigen::VectorXd::Unit(n, i));
    }
    if (variable.upper - x[i] <= near) {
      add(variable.name, "upper bound", Eigen::VectorXd::Unit(n, i));
    }
  }
  for (const LinearConstraint& row : problem.linear) {
    if (CalcLinearViolation(problem, row, x) < -tolerance) continue;
    add(row.name, row.equality ? "equality" : "linear",
        Eigen::Map<const Eigen::VectorXd>(row.coefficients.data(), n));
  }
  const std::size_t inequalities = problem.inequalities.names.size();
  for (std::size_t j = 0; j < inequalities; ++j) {
    if (batch.inequalities[j] < -tolerance) continue;
    add(problem.inequalities.names[j], "inequality",
        Eigen::Map<const Eigen::VectorXd>(batch.inequality_gradients.data() + j * n, n));
  }
  for (std::size_t j = 0; j < problem.equalities.names.size(); ++j) {
    add(problem.equalities.names[j], "equality",
        Eigen::Map<const Eigen::VectorXd>(batch.equality_gradients.data() + j * n, n));
  }
  if (!known || active.empty()) return active;
  const Eigen::VectorXd gradient =
      Eigen::Map<const Eigen::VectorXd>(batch.objective_gradients.data(), n).cwiseProduct(range);
  Eigen::MatrixXd matrix(n, static_cast<Eigen::Index>(normals.size()));
  for (std::size_t j = 0; j < normals.size(); ++j) {
    matrix.col(static_cast<Eigen::Index>(j)) = normals[j];
  }
  if (!gradient.allFinite() || !matrix.allFinite() || !std::isfinite(batch.objectives[0])) {
    return active;
  }
  const Eigen::VectorXd lambda = matrix.completeOrthogonalDecomposition().solve(-gradient);
  for (std::size_t j = 0; j < active.size(); ++j) {
    active[j].multiplier = lambda[static_cast<Eigen::Index>(j)];
  }
  return active;
}

}  // namespace kingpin::optimisation
