#include "tests/apps/program.h"

// Runs of mechanisms that do not reach their end: status 1, what was finished is kept and named,
// and nothing else is left.
namespace kingpin {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// A pendulum that would swing for some minutes of computing.
const std::string kLong = R"(kind: mechanism
name: pendulum
bodies: {bob: {mass: 1 kg, centre: [0, 0, -1], inertia: [0.1, 0.1, 0.1]}}
joints: {pin: {type: revolute, child: bob, axis: [0, 1, 0], angle: 1 rad}}
simulation: {method: rk4, step: 0.01 ms, duration: 10000 s, sample_interval: 10 ms}
)";

// Nothing but `kept` and what tests write; no hidden `.kept.partial-...`.
std::vector<std::string> ListResults(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  return names;
}

size_t CountLines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST_F(Program, AMechanismThatIsStoppedKeepsWhatIsFinished) {
  Write("m.yaml", kLong);
  const std::vector<std::array<std::string, 2>> signals = {
      {"INT", "Ctrl-C"}, {"TERM", "SIGTERM"}, {"HUP", "SIGHUP"}};
  for (const auto& [signal, name] : signals) {
    const Outcome outcome =
        Run("simulate m.yaml -o kept", "timeout --preserve-status --signal=" + signal + " 1");
    EXPECT_EQ(outcome.status, 1) << name;
    EXPECT_THAT(outcome.errors,
                StartsWith(fmt::format("kingpin: m.yaml: stopped by {} at t = ", name)));
    EXPECT_THAT(outcome.errors, HasSubstr("; what was finished is kept in kept\n"));
    EXPECT_THAT(ListResults(folder_), testing::ElementsAre("kept"));
    const nlohmann::json summary = Summary("kept");
    EXPECT_EQ(summary["finished"], false);
    EXPECT_FALSE(summary.contains("failure"));
    const double time = summary["time_reached"].get<double>();
    EXPECT_GT(time, 0);
    // rows of names and units, then the samples from 0 to the last
    EXPECT_EQ(CountLines(ReadAll(folder_ / "kept/signals.csv")),
              3 + static_cast<size_t>(std::lround(time / 0.01)));
    EXPECT_THAT(ReadAll(folder_ / "kept/report.html"), HasSubstr("stopped before its end"));
    fs::remove_all(folder_ / "kept");
  }
}

TEST_F(Program, ASignalThatIsToBeIgnoredIsIgnored) {
  Write("m.yaml", kLong);
  const Outcome outcome = Run("simulate m.yaml -o kept --set simulation.duration=10",
                              "sh -c 'trap \"\" HUP; \"$@\" & sleep 1; kill -HUP $!; wait $!' sh");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(Summary("kept")["finished"], true);
}

TEST_F(Program, AMechanismThatFailsKeepsWhatIsFinished) {
  // far beyond the stability limit of the explicit method
  Write("stiff.yaml", R"(kind: mechanism
name: stiff
bodies: {block: {mass: 1 kg, inertia: [1, 1, 1]}}
joints: {guide: {type: prismatic, child: block, axis: [1, 0, 0], displacement: 1 m}}
springs: {hard: {joint: guide, stiffness: 1e9}}
simulation: {method: rk4, step: 1 ms, duration: 1 s, sample_interval: 1 ms}
)");
  const Outcome outcome = Run("simulate stiff.yaml -o kept");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, StartsWith("kingpin: stiff.yaml: failed after t = "));
  EXPECT_THAT(outcome.errors, HasSubstr("smaller steps or less stiff forces may help"));
  EXPECT_THAT(outcome.errors, HasSubstr("; what was finished is kept in kept\n"));
  EXPECT_THAT(ListResults(folder_), testing::ElementsAre("kept"));
  const nlohmann::json summary = Summary("kept");
  EXPECT_EQ(summary["finished"], false);
  EXPECT_THAT(summary["failure"].get<std::string>(),
              HasSubstr("smaller steps or less stiff forces may help"));
  const std::string csv = ReadAll(folder_ / "kept/signals.csv");
  EXPECT_EQ(CountLines(csv),
            3 + static_cast<size_t>(std::lround(summary["time_reached"].get<double>() / 1e-3)));
  EXPECT_GT(CountLines(csv), 4U);
  // every number of it can be read again
  const Outcome metrics = Run("metrics kept/signals.csv --channel guide.acceleration");
  EXPECT_EQ(metrics.status, 0) << metrics.errors;
  EXPECT_THAT(ReadAll(folder_ / "kept/report.html"), HasSubstr("The run ended early: "));
  // the same name again: it is an earlier result of the same verb
  EXPECT_EQ(Run("simulate stiff.yaml -o kept --set simulation.step=1e-5").status, 0);
  EXPECT_EQ(Summary("kept")["finished"], true);
}

TEST_F(Program, AMechanismWithoutAnySampleLeavesNothing) {
  // an equilibrium that does not exist: nothing holds the block against its weight
  Write("falling.yaml", R"(kind: mechanism
bodies: {block: {mass: 1 kg, inertia: [1, 1, 1]}}
joints: {guide: {type: prismatic, child: block, axis: [0, 0, 1]}}
simulation: {start_at_rest: true}
)");
  for (const char* verb :
       {"simulate falling.yaml -o out", "modes falling.yaml -o out", "check falling.yaml -o out"}) {
    const Outcome outcome = Run(verb);
    EXPECT_EQ(outcome.status, 1) << verb;
    EXPECT_THAT(outcome.errors, StartsWith("kingpin: falling.yaml: ")) << verb;
    EXPECT_THAT(ListResults(folder_), testing::IsEmpty()) << verb;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << verb;
  }
}

TEST_F(Program, AMechanismShowsItsProgressOnATerminalOnly) {
  Write("m.yaml", kLong);
  const std::string arguments = "simulate m.yaml -o out --set simulation.duration=20";
  const fs::path seen = folder_ / "seen";
  const std::string on_terminal =
      fmt::format("cd '{}' && script -qec \"'{}' {}\" /dev/null >'{}'", folder_.string(),
                  KINGPIN_PROGRAM, arguments, seen.string());
  ASSERT_EQ(std::system(on_terminal.c_str()), 0);
  EXPECT_THAT(ReadAll(seen), HasSubstr("pendulum: 0/1000, 0 %"));
  EXPECT_THAT(ReadAll(seen), HasSubstr(" s of 20 s"));
  EXPECT_THAT(ReadAll(seen), HasSubstr(" left"));
  const Outcome piped = Run(arguments);
  EXPECT_EQ(piped.status, 0);
  EXPECT_EQ(piped.errors, "");
}

}  // namespace
}  // namespace kingpin
