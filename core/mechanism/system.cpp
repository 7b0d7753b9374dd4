#include "core/mechanism/system.h"

namespace kingpin::mechanism {

void System::Add(std::unique_ptr<ForceGroup> group) {
  first_state.push_back(states);
  states += group->CountStates();
  forces.push_back(std::move(group));
}

}  // namespace kingpin::mechanism
