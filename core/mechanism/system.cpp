#include "core/mechanism/system.h"

#include <algorithm>
#include <cmath>

namespace kingpin::mechanism {

void ClearForces(Workspace<double>& w) {
  std::fill(w.f.begin(), w.f.end(), Wrench<double>{});
  std::fill(w.generalised.begin(), w.generalised.end(), 0.0);
}

bool ForcesAreFinite(const Workspace<double>& w) {
  const auto finite = [](const Vector3<double>& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
  };
  return std::all_of(w.f.begin(), w.f.end(),
                     [&](const Wrench<double>& f) { return finite(f.t) && finite(f.f); }) &&
         std::all_of(w.generalised.begin(), w.generalised.end(),
                     [](double x) { return std::isfinite(x); });
}

std::string ForceGroup::FindNotFinite(const ForceContext<double>& context) const {
  ClearForces(context.w);
  AddForces(context);
  const bool finite = ForcesAreFinite(context.w) &&
                      std::all_of(context.state_rates, context.state_rates + CountStates(),
                                  [](double x) { return std::isfinite(x); });
  return finite ? "" : "of a group without names";
}

void System::Add(std::unique_ptr<ForceGroup> group) {
  first_state.push_back(states);
  states += group->CountStates();
  forces.push_back(std::move(group));
}

}  // namespace kingpin::mechanism
