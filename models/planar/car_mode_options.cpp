#include "models/planar/car_mode_options.h"

namespace kingpin::planar {

CarModeOptions CarModeOptions::PaperLike() {
  CarModeOptions options;
  options.assistance = Assistance::kNone;
  options.hands = HandsOnRim::kFree;
  options.aligning = Aligning::kNone;
  options.friction = Friction::kNone;
  options.opposite_wheel = false;
  options.torsion_bar_stops = false;
  options.column_damping = false;
  options.rack_damping = false;
  options.free_play = 0.0;
  options.support_axes = SupportAxes::kOrthogonal;
  options.yaw_inertia = YawInertia::kVertical;
  return options;
}

}  // namespace kingpin::planar
