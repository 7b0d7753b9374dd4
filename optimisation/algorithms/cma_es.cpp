#include "optimisation/algorithms/cma_es.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <vector>

#include "optimisation/algorithms/random.h"

namespace kingpin::optimisation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

int CalcDefaultPopulation(std::size_t n) {
  const int standard = 4 + static_cast<int>(3 * std::log(static_cast<double>(n)));
  return (standard + 7) / 8 * 8;
}

// Width of the rounded zone at each end of [0, 1].
constexpr double kZone = 0.05;

/// Maps any v to [0, 1]: the identity inside, a parabola towards each bound, reached with slope
/// zero at -kZone and 1 + kZone, and mirrored there. In v an optimum on a bound is an ordinary
/// smooth minimum, so that neither step size nor covariance notice the bound.
double Fold(double v) {
  constexpr double kWidth = 1 + 2 * kZone;
  double t = std::fmod(std::abs(v + kZone), 2 * kWidth);
  if (t > kWidth) t = 2 * kWidth - t;
  if (t < 2 * kZone) return t * t / (4 * kZone);
  if (kWidth - t < 2 * kZone) return 1 - (kWidth - t) * (kWidth - t) / (4 * kZone);
  return t - kZone;
}

/// The v in [-kZone, 1 + kZone] with Fold(v) = u.
double Unfold(double u) {
  if (u < kZone) return 2 * std::sqrt(kZone * u) - kZone;
  if (1 - u < kZone) return 1 + kZone - 2 * std::sqrt(kZone * (1 - u));
  return u;
}

/// One run without restarts. Variable names follow the tutorial.
std::string RunOnce(SearchView& view, const CmaEsOptions& options, Random& random, VectorXd mean,
                    double sigma, int lambda, long limit) {
  for (double& value : mean) value = Unfold(value);
  const auto n = static_cast<Eigen::Index>(view.space().size());
  const double dim = static_cast<double>(n);
  const int mu = lambda / 2;
  VectorXd w(lambda);
  for (int i = 0; i < lambda; ++i) w[i] = std::log((lambda + 1) / 2.0) - std::log(i + 1.0);
  const double positive = w.head(mu).sum();
  const double mu_eff = positive * positive / w.head(mu).squaredNorm();
  const double negative = w.tail(lambda - mu).sum();
  const double mu_eff_minus = negative * negative / w.tail(lambda - mu).squaredNorm();
  const double c_c = (4 + mu_eff / dim) / (dim + 4 + 2 * mu_eff / dim);
  const double c_s = (mu_eff + 2) / (dim + mu_eff + 5);
  const double c_1 = 2 / ((dim + 1.3) * (dim + 1.3) + mu_eff);
  const double c_mu =
      std::min(1 - c_1, 2 * (0.25 + mu_eff + 1 / mu_eff - 2) / ((dim + 2) * (dim + 2) + mu_eff));
  const double d_s = 1 + 2 * std::max(0.0, std::sqrt((mu_eff - 1) / (dim + 1)) - 1) + c_s;
  const double chi = std::sqrt(dim) * (1 - 1 / (4 * dim) + 1 / (21 * dim * dim));
  const double alpha = std::min(
      {1 + c_1 / c_mu, 1 + 2 * mu_eff_minus / (mu_eff + 2), (1 - c_1 - c_mu) / (dim * c_mu)});
  w.head(mu) /= positive;
  w.tail(lambda - mu) *= -alpha / negative;

  MatrixXd C = MatrixXd::Identity(n, n);
  MatrixXd B = MatrixXd::Identity(n, n);
  VectorXd D = VectorXd::Ones(n);
  VectorXd p_s = VectorXd::Zero(n);
  VectorXd p_c = VectorXd::Zero(n);
  MatrixXd Y(n, lambda);
  std::vector<double> points(static_cast<std::size_t>(n) * lambda);
  std::vector<int> order(lambda);
  std::deque<double> recent;
  const std::size_t recent_size = 10 + static_cast<std::size_t>(std::ceil(30 * dim / lambda));
  const int decompose_every = std::max(1, static_cast<int>(1 / ((c_1 + c_mu) * dim * 10)));
  double best_of_run = std::numeric_limits<double>::infinity();
  long since_best = 0;
  long used = 0;
  for (int generation = 0; used < limit; ++generation) {
    for (int i = 0; i < lambda; ++i) {
      VectorXd z(n);
      for (Eigen::Index k = 0; k < n; ++k) z[k] = random.Normal();
      const VectorXd x = mean + sigma * (B * D.cwiseProduct(z));
      Y.col(i) = (x - mean) / sigma;
      for (Eigen::Index k = 0; k < n; ++k) points[i * n + k] = Fold(x[k]);
    }
    view.Evaluate(points, false, true);
    used += lambda;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return IsBetter(view.merit(a), view.merit(b)); });
    const Merit& best = view.merit(order[0]);
    if (std::isinf(best.violation) && generation > 20) return "no design in sight";

    VectorXd step = VectorXd::Zero(n);
    for (int i = 0; i < mu; ++i) step += w[i] * Y.col(order[i]);
    mean += sigma * step;
    const auto whiten = [&](const VectorXd& y) -> VectorXd {
      return B * (B.transpose() * y).cwiseQuotient(D);
    };
    p_s = (1 - c_s) * p_s + std::sqrt(c_s * (2 - c_s) * mu_eff) * whiten(step);
    const double decay = 1 - std::pow(1 - c_s, 2.0 * (generation + 1));
    const bool h_s = p_s.norm() / std::sqrt(decay) < (1.4 + 2 / (dim + 1)) * chi;
    p_c = (1 - c_c) * p_c;
    if (h_s) p_c += std::sqrt(c_c * (2 - c_c) * mu_eff) * step;
    const double missing = h_s ? 0 : c_c * (2 - c_c);
    C *= 1 + c_1 * missing - c_1 - c_mu * w.sum();
    C += c_1 * p_c * p_c.transpose();
    for (int i = 0; i < lambda; ++i) {
      const VectorXd y = Y.col(order[i]);
      double weight = w[i];
      if (weight < 0) weight *= dim / std::max(1e-12, whiten(y).squaredNorm());
      C += c_mu * weight * y * y.transpose();
    }
    sigma *= std::exp(std::min(1.0, c_s / d_s * (p_s.norm() / chi - 1)));
    if (generation % decompose_every == 0) {
      C = 0.5 * (C + C.transpose()).eval();
      const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(C);
      if (eigen.info() != Eigen::Success) return "ended: the covariance matrix broke down";
      B = eigen.eigenvectors();
      const double floor = 1e-14 * std::max(eigen.eigenvalues().maxCoeff(), 1e-300);
      D = eigen.eigenvalues().cwiseMax(floor).cwiseSqrt();
    }

    if (!std::isfinite(sigma) || !D.allFinite() || !mean.allFinite()) {
      return "ended: the step size broke down";
    }
    if (sigma * D.maxCoeff() < options.step_tolerance) {
      return "converged: the step is below its tolerance";
    }
    if (best.feasible()) {
      recent.push_back(best.value);
      if (recent.size() > recent_size) recent.pop_front();
      const auto [low, high] = std::minmax_element(recent.begin(), recent.end());
      if (recent.size() == recent_size &&
          *high - *low <= options.value_tolerance * std::max(std::abs(*low), 1e-300)) {
        return "converged: the value no longer changes";
      }
      since_best = best.value < best_of_run ? 0 : since_best + 1;
      best_of_run = std::min(best_of_run, best.value);
      if (since_best > 120 + static_cast<long>(30 * dim)) return "ended: no more progress";
    }
  }
  return "stopped at the limit of evaluations";
}

}  // namespace

std::string RunCmaEs(SearchView& view, const CmaEsOptions& options, std::span<const double> start) {
  const std::size_t n = view.space().size();
  if (n == 0) {
    view.Evaluate({});
    return "nothing to vary";
  }
  Random random(options.seed);
  const int base =
      std::max(4, options.population > 0 ? options.population : CalcDefaultPopulation(n));
  VectorXd mean = Eigen::Map<const VectorXd>(start.data(), static_cast<Eigen::Index>(n));
  view.space().Project({mean.data(), n});
  view.Evaluate({mean.data(), n});
  const long first = view.evaluations();
  const auto left = [&] { return options.max_evaluations - (view.evaluations() - first); };
  std::string status = RunOnce(view, options, random, mean, options.initial_step, base, left());
  if (options.restarts == CmaEsOptions::Restarts::kNone) return status;
  int large = base;
  long large_used = 0;
  long small_used = 0;
  int large_restarts = 0;
  while (left() >= base) {
    // Restarts begin anywhere; BIPOP lets short searches with small steps alternate with ones of
    // doubled populations, whichever has used fewer evaluations.
    for (std::size_t k = 0; k < n; ++k) mean[static_cast<Eigen::Index>(k)] = random.Uniform();
    view.space().Project({mean.data(), n});
    const long before = view.evaluations();
    if (options.restarts == CmaEsOptions::Restarts::kIpop || large_used <= small_used) {
      if (large_restarts++ == options.max_restarts) break;
      large *= 2;
      status = RunOnce(view, options, random, mean, options.initial_step, large, left());
      large_used += view.evaluations() - before;
    } else {
      const double u = random.Uniform();
      const int population =
          std::max(base, static_cast<int>(base * std::pow(0.5 * large / base, u * u)) / 8 * 8);
      const double sigma = options.initial_step * std::pow(10.0, -2 * random.Uniform());
      const long limit = std::min(left(), std::max<long>(large_used / 2, 20L * base));
      status = RunOnce(view, options, random, mean, sigma, population, limit);
      small_used += view.evaluations() - before;
    }
  }
  return status;
}

}  // namespace kingpin::optimisation
