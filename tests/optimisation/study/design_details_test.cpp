#include "optimisation/study/design_details.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "models/planar/paper_set.h"
#include "models/planar/simulate.h"

namespace kingpin::study {
namespace {

// F_T brakes; x points forward (ISO 8855).
TEST(Signals, TheRoadPushesBackwards) {
  const planar::PaperSet set =
      planar::ReadPaperSet(std::string(KINGPIN_SOURCE_DIR) + "/examples/paper/set_A.json");
  const planar::History h = planar::Simulate(set.parameters, planar::Excitation(set.pulses), {});
  const io::Signals signals = MakeSignals(h);
  const auto find = [&](const std::string& name) {
    const auto found = std::find_if(signals.channels.begin(), signals.channels.end(),
                                    [&](const auto& channel) { return channel.name == name; });
    EXPECT_NE(found, signals.channels.end()) << name;
    return found->values;
  };
  const std::vector<double> force = find("front.left.road.force_x");
  const std::vector<double> x = find("front.left.carrier.x");
  ASSERT_EQ(force.size(), h.size());
  for (std::size_t i = 0; i < h.size(); ++i) EXPECT_EQ(force[i], -h.road_force[i]);
  EXPECT_LT(*std::min_element(force.begin(), force.end()), -100.0);
  // It goes where it is pushed: first backwards.
  const auto moved = std::find_if(x.begin(), x.end(), [](double v) { return std::abs(v) > 1e-5; });
  ASSERT_NE(moved, x.end());
  EXPECT_LT(*moved, 0.0);
}

}  // namespace
}  // namespace kingpin::study
