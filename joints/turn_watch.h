#pragma once

#include <string>
#include <vector>

#include "joints/axis_place.h"

namespace kingpin::joints {

/// Watches the angles that jump at half a turn, and that a stiffness, a stop or a target follows:
/// forces about axes that no joints' coordinates count (MakeAxisPlace), and bushings.
class TurnWatch {
 public:
  TurnWatch(const std::vector<ForceDescription>& forces, const Mechanism& mechanism);

  bool empty() const { return watches_.empty(); }
  /// To be called often enough that nothing turns by half a turn between.
  /// @throws std::runtime_error if an angle has jumped since the last call; the message names the
  /// force and the time
  void Look(const mechanism::ForceContext<double>& context);

 private:
  struct Watch {
    std::string name;
    bool is_bushing = false;
    AxisPlace place;
    Vector3<double> last;  ///< rotation vector; of an axis its angle in z
  };
  std::vector<Watch> watches_;
  bool looked_ = false;
};

}  // namespace kingpin::joints
