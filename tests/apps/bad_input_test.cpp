#include "tests/apps/program.h"

// Bad input of the verbs that run one model, bad command lines, and Ctrl-C.
namespace kingpin {
namespace {

using testing::HasSubstr;

const std::string kScenario = R"(kind: scenario
name: s
model:
  paper_set: {}/examples/paper/set_C.json
load_cases:
  - name: knock
    history: force.csv
duration: 0.5 s
)";

TEST_F(Program, SimulateAndModesNameFileLineAndKey) {
  Write("force.csv", "time,F\ns,N\n0,0\n0.1,1000\n0.2,0\n");
  const std::string good = fmt::format(fmt::runtime(kScenario), KINGPIN_SOURCE_DIR);
  const struct {
    std::string before, after, message;
  } cases[] = {
      {"duration: 0.5 s", "duration: 0.5 kg", "s.yaml:8: duration: found '0.5 kg' (a mass)"},
      {"duration: 0.5 s", "duraton: 0.5 s", "s.yaml:8: duraton: found an unknown key"},
      {"duration: 0.5 s", "sample_interval: 0.3 ms",
       "s.yaml:8: sample_interval: found 0.0003, expected a whole fraction of the duration"},
      {"set_C.json", "set_D.json", "s.yaml:4: model.paper_set: found"},
      {"history: force.csv",
       "pulses: [{shape: half_sine, peak: 1 kN, start: 2 s, duration: 20 ms}]",
       "s.yaml:7: load_cases[0].pulses[0].start: found 2 s: the pulse of load case 'knock' begins "
       "when the run is over, expected less than the duration, 0.5 s"},
      {"duration: 0.5 s", "design: {carrier_mass: 0 kg}",
       "s.yaml:8: design.planar.carrier_mass: found 0, expected a number > 0 [kg]; without it the "
       "mass matrix is singular"},
      {"name: knock", "weight: 0", "s.yaml:6: load_cases[0].name: found nothing"},
  };
  for (const auto& c : cases) {
    std::string text = good;
    text.replace(text.find(c.before), c.before.size(), c.after);
    Write("s.yaml", text);
    for (const char* verb : {"simulate", "modes"}) {
      const Outcome outcome = Run(std::string(verb) + " s.yaml -o out");
      EXPECT_EQ(outcome.status, 2) << verb << ": " << c.after;
      EXPECT_THAT(outcome.errors, HasSubstr("kingpin: " + c.message)) << verb << ": " << c.after;
      EXPECT_EQ(outcome.output, "");
      EXPECT_FALSE(fs::exists(folder_ / "out")) << verb << ": " << c.after;
    }
  }
  Write("s.yaml", good);
  const std::pair<std::string, std::string> histories[] = {
      {"time,F\ns,m\n0,0\n0.1,1\n", "force.csv:2: F: found unit 'm', expected a force"},
      {"time,F\ns,N\n0,0\n0.1,nan\n", "force.csv:4"},
      {"time,F\ns,N\n0,0\n", "force.csv"},
      {"time,F,G\ns,N,N\n0,0,0\n0.1,1,1\n", "2 channels beside the time"},
      {"time,F\ns,N\n0,0\n0.1,0\n", "s.yaml:6: load_cases[0]: found load case 'knock' without any"},
      {"time,F\ns,N\n0.6,0\n0.7,1\n", "s.yaml:6: load_cases[0]: found load case 'knock' without"},
  };
  for (const auto& [text, message] : histories) {
    Write("force.csv", text);
    const Outcome outcome = Run("simulate s.yaml -o out");
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << text;
  }
}

TEST_F(Program, AHistoryIsTheSameInEveryUnitOfForce) {
  Write("s.yaml", fmt::format(fmt::runtime(kScenario), KINGPIN_SOURCE_DIR));
  Write("force.csv", "time,F\ns,N\n0,0\n0.125,1000\n0.25,0\n");
  ASSERT_EQ(Run("simulate s.yaml -o newton --quiet").status, 0);
  Write("force.csv", "time,F\nms,kN\n0,0\n125,1\n250,0\n");
  const Outcome outcome = Run("simulate s.yaml -o kilonewton --quiet");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(ReadAll(folder_ / "newton/signals.csv"), ReadAll(folder_ / "kilonewton/signals.csv"));
}

TEST_F(Program, EveryNumberOfASimulationHasItsUnit) {
  Write("s.yaml", fmt::format(fmt::runtime(kScenario), KINGPIN_SOURCE_DIR));
  Write("force.csv", "time,F\ns,N\n0,0\n0.1,1000\n0.2,0\n");
  ASSERT_EQ(Run("simulate s.yaml -o out --quiet").status, 0);
  const nlohmann::json summary = Summary("out");
  const auto look = [](const auto& self, const nlohmann::json& json,
                       const std::string& path) -> void {
    if (json.is_number()) {
      ADD_FAILURE() << path << " has no unit";
    } else if (json.is_object() && json.contains("value")) {
      EXPECT_TRUE(json.contains("unit")) << path;
    } else if (json.is_structured()) {
      for (const auto& [key, value] : json.items()) self(self, value, path + "." + key);
    }
  };
  look(look, summary, "");
  EXPECT_EQ(summary["rim_acceleration"]["vdv_weighted"]["unit"], "m/s^1.75");
  EXPECT_EQ(summary["rim_acceleration"]["short_decay_time"]["unit"], "s");
  EXPECT_EQ(summary["torsion_torque"]["impulse"]["unit"], "N m s");
}

TEST_F(Program, CommandLinesThatMakeNoSenseAreExplained) {
  const std::string study = WriteStudy();
  const std::pair<std::string, std::string> cases[] = {
      {"", "kingpin: found nothing, expected a verb; known verbs: study, simulate"},
      {"--foo", "kingpin: found '--foo', expected a verb before any option; known verbs: study"},
      {"--hep", "did you mean '--help'?"},
      {"simulate", "kingpin: command line: FILE is required; see 'kingpin simulate --help'"},
      {"study " + study + " --threads 0",
       "kingpin: command line: --threads: found '0', expected a whole number from 1 to 1024"},
      {"study " + study + " --seed -1",
       "kingpin: command line: --seed: found '-1', expected a whole number of 0 or more"},
      {"study " + study + " --seed 1.5", "--seed: found '1.5'"},
      {"study " + study + " --thread 2",
       "kingpin: command line: found '--thread', expected an option of 'study'; did you mean "
       "'--threads'?"},
      {"simulate " + study + " --threads 2", "found '--threads', expected an option of 'simulate'"},
      {"modes " + study + " --seed 2", "found '--seed', expected an option of 'modes'"},
      {"metrics " + study + " --quiet", "found '--quiet', expected an option of 'metrics'"},
      {"check " + study + " --threads 2", "found '--threads', expected an option of 'check'"},
      {"schema --set a=1", "found '--set', expected an option of 'schema'"},
      {"simulate " + study, "quick.yaml:1: kind: found 'study', expected 'scenario'"},
      {"simulate .", "scenario.yaml"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.errors, testing::StartsWith("kingpin: ")) << arguments;
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << arguments;
    EXPECT_EQ(outcome.output, "") << arguments;
  }
}

TEST_F(Program, CtrlCEndsAnOptimisationWithStatusOneAndKeepsWhatIsThere) {
  const std::string study = WriteStudy();
  const Outcome outcome = Run("optimise " + study +
                                  " -o kept.json --set cases[0].stages[0].algorithm=multistart"
                                  " --set cases[0].stages[0].max_evaluations=0"
                                  " --set cases[0].stages[0].random_starts=1000",
                              "timeout --preserve-status --signal=INT 2");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors,
              HasSubstr("kingpin: stopped by Ctrl-C; what was finished is kept in kept.json"));
  const auto summary = nlohmann::json::parse(ReadAll(folder_ / "kept.json"));
  EXPECT_EQ(summary["cases"][0]["designs"][0]["name"], "initial");
}

}  // namespace
}  // namespace kingpin
