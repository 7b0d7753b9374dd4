#include "core/io/csv.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/io/error.h"
#include "tests/floating_point_traps.h"

namespace kingpin::io {
namespace {

TEST(Csv, SignalsAreConvertedToSi) {
  const Signals signals = ParseSignals(
      "time,steering.wheel.angle,\"a, quoted \"\"name\"\"\"\r\nms,deg,mm/s^2\r\n0,180,1500\r\n"
      "# a remark\r\n20,-90,2.5e3\r\n",
      "a.csv");
  ASSERT_EQ(signals.channels.size(), 2u);
  EXPECT_EQ(signals.time, (std::vector<double>{0.0, 0.02}));
  EXPECT_EQ(signals.channels[0].name, "steering.wheel.angle");
  EXPECT_EQ(signals.channels[0].unit, "deg");
  EXPECT_EQ(signals.channels[0].si_unit, "rad");
  EXPECT_DOUBLE_EQ(signals.channels[0].values[1], -1.5707963267948966);
  EXPECT_EQ(signals.channels[1].name, "a, quoted \"name\"");
  EXPECT_EQ(signals.channels[1].si_unit, "m/s^2");
  EXPECT_EQ(signals.channels[1].values, (std::vector<double>{1.5, 2.5}));
}

TEST(Csv, TwoPlainColumnsAreASignal) {
  for (const char* text : {"0,1\n1,2\n", "t,x\n0,1\n1,2\n",
                           "\xef\xbb\xbf"
                           "0,1\n1,2\n"}) {
    const Signals signals = ParseSignals(text, "a.csv");
    EXPECT_EQ(signals.time, (std::vector<double>{0.0, 1.0}));
    EXPECT_EQ(signals.channels.at(0).values, (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ(signals.channels.at(0).unit, "");
  }
}

TEST(Csv, MissingChannelListsTheOnesThere) {
  const Signals signals =
      ParseSignals("time,rack.force,rack.speed\ns,N,m/s\n0,1,2\n1,2,3\n", "a.csv");
  EXPECT_EQ(GetChannel(signals, "rack.speed").values[1], 3.0);
  try {
    GetChannel(signals, "rack.forse");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a.csv:1: rack.forse: found no such channel, expected one of rack.force, "
                 "rack.speed; did you mean 'rack.force'?");
  }
}

TEST(Csv, WrittenSignalsReadBackExactly) {
  const WithoutTraps signalling_nans_are_drawn;
  std::mt19937_64 random(3);
  Signals signals;
  signals.channels.resize(3);
  signals.channels[0] = {.name = "a", .unit = {}, .si_unit = "rad/s^2", .values = {}};
  signals.channels[1] = {.name = "b,\"c\"", .unit = {}, .si_unit = "N m s/rad", .values = {}};
  signals.channels[2] = {.name = "d", .unit = {}, .si_unit = "1", .values = {}};
  double time = 0.0;
  for (int i = 0; i < 2000; ++i) {
    time += 1e-3 * static_cast<double>(1 + random() % 1000);
    signals.time.push_back(time);
    for (auto& channel : signals.channels) {
      double value = 0.0;
      do value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
      while (!std::isnormal(value));
      channel.values.push_back(value);
    }
  }
  const Signals read = ParseSignals(FormatSignals(signals), "a.csv");
  EXPECT_EQ(read.time, signals.time);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.channels[i].name, signals.channels[i].name);
    EXPECT_EQ(read.channels[i].si_unit, signals.channels[i].si_unit);
    EXPECT_EQ(read.channels[i].values, signals.channels[i].values);
  }
}

}  // namespace
}  // namespace kingpin::io
