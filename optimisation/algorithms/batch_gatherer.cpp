#include "optimisation/algorithms/batch_gatherer.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/parallel/fibre.h"

namespace kingpin::optimisation {

struct BatchGatherer::Search : Evaluator {
  explicit Search(std::function<void(Evaluator&)> search) : body(std::move(search)) {}

  void Evaluate(Batch& batch) override {
    if (stopped) throw SearchStopped{};
    pending = &batch;
    answered = false;
    fibre->Yield();
    if (!answered) throw SearchStopped{};
  }

  std::function<void(Evaluator&)> body;
  std::unique_ptr<Fibre> fibre;
  Batch* pending = nullptr;
  bool answered = false;  ///< the pending batch holds values, also when all has to stop
  bool stopped = false;
};

BatchGatherer::BatchGatherer(const Problem& problem, Evaluator& evaluator, std::size_t concurrency)
    : problem_(problem), evaluator_(evaluator), concurrency_(concurrency) {}

BatchGatherer::~BatchGatherer() = default;

void BatchGatherer::Add(std::function<void(Evaluator&)> search) {
  searches_.push_back(std::make_unique<Search>(std::move(search)));
}

void BatchGatherer::Run() {
  std::exception_ptr error;
  bool stopped = false;
  std::size_t next = 0;
  const std::size_t limit =
      concurrency_ > 0 ? concurrency_ : std::max<std::size_t>(1, searches_.size());
  const auto resume = [&](Search& search) {
    search.pending = nullptr;
    search.stopped = stopped;
    try {
      search.fibre->Resume();
    } catch (const SearchStopped&) {
      // The search let it through, as it may.
    } catch (...) {
      if (!error) error = std::current_exception();
      stopped = true;
    }
  };
  while (true) {
    while (!stopped && active_.size() < limit && next < searches_.size()) {
      Search& search = *searches_[next++];
      search.fibre = std::make_unique<Fibre>([&search] { search.body(search); });
      active_.push_back(&search);
      resume(search);
      if (search.fibre->done()) {
        search.fibre.reset();
        active_.pop_back();
      }
    }
    if (active_.empty()) break;
    if (!stopped) {
      try {
        EvaluatePending(false);
        EvaluatePending(true);
      } catch (const SearchStopped&) {
        stopped = true;
      } catch (...) {
        error = std::current_exception();
        stopped = true;
      }
    }
    for (Search* search : active_) resume(*search);
    std::erase_if(active_, [](Search* search) {
      const bool done = search->fibre->done();
      if (done) search->fibre.reset();
      return done;
    });
  }
  searches_.clear();
  if (error) std::rethrow_exception(error);
}

void BatchGatherer::EvaluatePending(bool gradients) {
  std::size_t count = 0;
  Search* only = nullptr;
  std::size_t asking = 0;
  for (Search* search : active_) {
    if (search->pending->with_gradients != gradients) continue;
    count += search->pending->count;
    only = search;
    ++asking;
  }
  if (asking == 0) return;
  if (asking == 1) {
    evaluator_.Evaluate(*only->pending);
    only->answered = true;
    return;
  }
  merged_.Resize(problem_, count, gradients);
  auto point = merged_.points.begin();
  for (Search* search : active_) {
    if (search->pending->with_gradients != gradients) continue;
    point = std::copy(search->pending->points.begin(), search->pending->points.end(), point);
  }
  evaluator_.Evaluate(merged_);
  std::size_t done = 0;
  for (Search* search : active_) {
    Batch& part = *search->pending;
    if (part.with_gradients != gradients) continue;
    const auto take = [&](const std::vector<double>& from, std::vector<double>& to) {
      const std::size_t width = from.size() / count;
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(done * width), part.count * width,
                  to.begin());
    };
    take(merged_.objectives, part.objectives);
    take(merged_.inequalities, part.inequalities);
    take(merged_.equalities, part.equalities);
    take(merged_.objective_gradients, part.objective_gradients);
    take(merged_.inequality_gradients, part.inequality_gradients);
    take(merged_.equality_gradients, part.equality_gradients);
    done += part.count;
    search->answered = true;
  }
}

}  // namespace kingpin::optimisation
