#include "core/io/results.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/io/error.h"
#include "core/io/sha256.h"
#include "core/io/version.h"
#include "core/io/yaml_document.h"

namespace kingpin::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Results : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "kingpin-results-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_, fs::perms::owner_all, ignored);
    fs::remove_all(folder_, ignored);
  }

  // Names in the folder, hidden ones included.
  std::set<std::string> Names() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  void WriteResult(const std::string& content) const {
    ResultDirectory results(folder_ / "run", "study");
    results.WriteText("signals.csv", content);
    WriteManifest(RunManifest{}, &results);
    results.Commit();
  }

  fs::path folder_;
};

template <class Error, class F>
std::string MessageOf(F&& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Results, AFolderAppearsOnlyWhenItIsComplete) {
  ResultDirectory results(folder_ / "deep" / "run", "study");
  results.WriteText("stages/one/a.txt", "a");
  EXPECT_FALSE(fs::exists(folder_ / "deep" / "run"));
  results.Commit();
  EXPECT_EQ(ReadTextFile(folder_ / "deep" / "run" / "stages" / "one" / "a.txt"), "a");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "deep"), fs::directory_iterator()), 1);
}

TEST_F(Results, AnAbandonedRunLeavesNothing) {
  try {
    ResultDirectory results(folder_ / "run", "study");
    results.WriteText("a.txt", "a");
    throw std::runtime_error("the simulation diverged");
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(Names().empty());
}

TEST_F(Results, ANewResultReplacesTheOldOneWhole) {
  {
    ResultDirectory results(folder_ / "run", "study");
    results.WriteText("signals.csv", "old");
    results.WriteText("stages/left_over.txt", "from the old run");
    WriteManifest(RunManifest{}, &results);
    results.Commit();
  }
  WriteResult("new");
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "new");
  EXPECT_FALSE(fs::exists(folder_ / "run" / "stages"));
  EXPECT_EQ(Names(), std::set<std::string>{"run"});
}

TEST_F(Results, SomebodysFilesAreNeverReplaced) {
  fs::create_directory(folder_ / "run");
  std::ofstream(folder_ / "run" / "thesis.tex") << "years of work";
  EXPECT_THAT(MessageOf<InputError>([this] { ResultDirectory results(folder_ / "run", "study"); }),
              HasSubstr("found a folder with files that are not a result, expected a new or an "
                        "empty folder, or an earlier result of 'study'; choose another place with "
                        "-o"));
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "thesis.tex"), "years of work");
  std::ofstream(folder_ / "run" / "manifest.json") << R"({"program": "other", "verb": "study"})";
  EXPECT_THAT(MessageOf<InputError>([this] { ResultDirectory results(folder_ / "run", "study"); }),
              HasSubstr("found a folder with files that are not a result"));
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THAT(MessageOf<InputError>([this] { ResultDirectory results(folder_ / "file", "study"); }),
              HasSubstr("found a file, expected"));
  fs::create_directory_symlink(folder_, folder_ / "link");
  EXPECT_THAT(MessageOf<InputError>([this] { ResultDirectory results(folder_ / "link", "study"); }),
              HasSubstr("found a symbolic link"));
  for (const char* name : {"", ".", "..", "/"}) {
    EXPECT_THAT(MessageOf<InputError>([name] { ResultDirectory results(fs::path(name), "study"); }),
                HasSubstr("a folder with a name of its own"))
        << name;
  }
}

// Also inside a result: notes, a plot, a link that were put beside what a run wrote.
TEST_F(Results, SomebodysFilesInAResultAreNeverReplaced) {
  WriteResult("old");
  fs::create_directories(folder_ / "run" / "plots");
  for (const char* name : {"notes.txt", "plots/mine.png", ".hidden"}) {
    const fs::path file = folder_ / "run" / name;
    std::ofstream(file) << "mine";
    EXPECT_THAT(MessageOf<InputError>([this] { WriteResult("new"); }),
                HasSubstr(std::string("found '") + name +
                          "', which the earlier run did not write, expected a new or an empty "
                          "folder, or an earlier result of 'study'; move it away, or choose "
                          "another place with -o"));
    EXPECT_EQ(ReadTextFile(file), "mine");
    EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "old");
    fs::remove(file);
  }
  fs::create_directory_symlink("/", folder_ / "run" / "link");
  EXPECT_THAT(MessageOf<InputError>([this] { WriteResult("new"); }), HasSubstr("found 'link'"));
  fs::remove(folder_ / "run" / "link");
  WriteResult("new");
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "new");
}

// A file that appears while the run is under way is kept, too.
TEST_F(Results, SomebodysFilesThatComeDuringTheRunAreKept) {
  WriteResult("old");
  ResultDirectory results(folder_ / "run", "study");
  WriteManifest(RunManifest{}, &results);
  std::ofstream(folder_ / "run" / "notes.txt") << "mine";
  EXPECT_THAT(MessageOf<InputError>([&] { results.Commit(); }), HasSubstr("found 'notes.txt'"));
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "notes.txt"), "mine");
}

TEST_F(Results, OnlyAResultOfTheSameVerbIsReplaced) {
  WriteResult("old");
  EXPECT_THAT(
      MessageOf<InputError>([this] { ResultDirectory results(folder_ / "run", "simulate"); }),
      HasSubstr("found a result of 'study', expected a new or an empty folder, or an earlier "
                "result of 'simulate'; choose another place with -o"));
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "old");
}

TEST_F(Results, MessagesNameTheFileWhereItWillBe) {
  ResultDirectory results(folder_ / "run", "study");
  results.WriteText("a", "x");
  EXPECT_THAT(MessageOf<InputError>([&] { results.WriteText("a/b", "x"); }),
              testing::StartsWith((folder_ / "run" / "a").string() + ": found"));
  fs::create_directory(folder_ / "locked");
  EXPECT_THAT(MessageOf<InputError>(
                  [&] { WriteFileAtomically(folder_ / "locked" / std::string(250, 'n'), "x"); }),
              testing::StartsWith((folder_ / "locked" / "nnn").string()));
}

TEST_F(Results, PlacesThatCannotBeWrittenAreUnusableInput) {
  EXPECT_THAT(MessageOf<InputError>([] { ResultDirectory results("/proc/nowhere/run", "study"); }),
              HasSubstr("making the folder failed (No such file or directory), expected a place "
                        "that can be written to; choose another place with -o"));
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THAT(
      MessageOf<InputError>([this] { ResultDirectory results(folder_ / "file" / "run", "study"); }),
      HasSubstr("making the folder failed (Not a directory)"));
  EXPECT_THAT(MessageOf<InputError>([this] { WriteFileAtomically(folder_, "x"); }),
              HasSubstr("creating the file failed (Is a directory)"));
}

TEST_F(Results, AFullDiskIsUnusableInputAndNamesTheFile) {
  OutputFile file("/dev/full");
  const std::string message = MessageOf<InputError>([&file] {
    file.Write("a few bytes");
    file.Close();
  });
  EXPECT_EQ(message,
            "/dev/full: found writing failed (No space left on device), expected a place that can "
            "be written to; free some space, or choose another place with -o");
}

// The limit of a file's size stands in for a disk that fills up while a result is written: no root
// is needed for it, and write() fails half-way just the same.
TEST_F(Results, ADiskThatFillsUpLeavesTheOldResult) {
  WriteResult("old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int status = 0;
    try {
      ResultDirectory results(folder_ / "run", "study");
      results.WriteText("signals.csv", std::string(300000, 'x'));
      results.Commit();
    } catch (const InputError& error) {
      status = std::string(error.what()).find("File too large") == std::string::npos ? 1 : 2;
    }
    ::_exit(status);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "old");
  EXPECT_EQ(Names(), std::set<std::string>{"run"});
}

TEST_F(Results, AKilledRunLeavesTheOldResultAndTheNextOneCleansUp) {
  WriteResult("old");
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ResultDirectory results(folder_ / "run", "study");
    for (int i = 0;; ++i) {
      results.WriteText("signals.csv", std::string(100000, 'x'));
      if (i == 0) (void)!::write(pipe_ends[1], "x", 1);
    }
  }
  char byte = 0;
  ASSERT_EQ(::read(pipe_ends[0], &byte, 1), 1);
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ::close(pipe_ends[0]);
  ::close(pipe_ends[1]);
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "old");
  EXPECT_EQ(Names().size(), 2u);  // the hidden leftover
  WriteResult("new");
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "new");
  EXPECT_EQ(Names(), std::set<std::string>{"run"});
}

// A reader that looks all the time never sees a missing or a mixed result.
TEST_F(Results, AReaderSeesAWholeResultAtAnyTime) {
  WriteResult("0");
  std::atomic<bool> is_done = false;
  int looks = 0;
  int misses = 0;
  std::thread reader([&] {
    while (!is_done) {
      ++looks;
      if (::access((folder_ / "run" / "manifest.json").c_str(), R_OK) != 0) ++misses;
    }
  });
  for (int i = 0; i < 30; ++i) WriteResult(std::to_string(i));
  is_done = true;
  reader.join();
  EXPECT_GT(looks, 0);
  EXPECT_EQ(misses, 0);
}

TEST_F(Results, TwoRunsAtOnceDoNotMix) {
  ResultDirectory first(folder_ / "run", "study");
  ResultDirectory second(folder_ / "run", "study");
  for (ResultDirectory* results : {&first, &second}) {
    results->WriteText("signals.csv", results == &first ? "first" : "second");
    WriteManifest(RunManifest{}, results);
  }
  first.Commit();
  second.Commit();
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "signals.csv"), "second");
  EXPECT_EQ(Names(), std::set<std::string>{"run"});
}

TEST_F(Results, TheManifestNamesTheExactInputs) {
  fs::create_directories(folder_ / "cars" / "a");
  std::ofstream(folder_ / "cars" / "a" / "car.yaml") << "abc";
  std::ofstream(folder_ / "study.yaml") << "study";
  RunManifest manifest;
  manifest.command_line = {"kingpin", "study", "study.yaml"};
  manifest.inputs = {folder_ / "study.yaml", folder_ / "cars" / "a" / "car.yaml",
                     folder_ / "study.yaml"};
  manifest.overrides.push_back(ParseOverride("a.b=[1 mm, 2]"));
  manifest.seed = 42;
  manifest.threads = 2;
  manifest.instruction_set = "AVX2";
  manifest.solver = {{"steps", 1000.0}};
  manifest.duration = 0.1 + 0.2;
  ResultDirectory results(folder_ / "run", "study");
  WriteManifest(manifest, &results);
  results.Commit();
  const auto json = nlohmann::json::parse(ReadTextFile(folder_ / "run" / "manifest.json"));
  EXPECT_EQ(json["verb"], "study");
  EXPECT_EQ(json["outputs"],
            (std::vector<std::string>{"inputs/cars/a/car.yaml", "inputs/study.yaml"}));
  EXPECT_EQ(json["inputs"].size(), 2u);
  EXPECT_EQ(json["inputs"][1]["sha256"],
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(json["inputs"][1]["copy"], "inputs/cars/a/car.yaml");
  EXPECT_EQ(ReadTextFile(folder_ / "run" / "inputs" / "cars" / "a" / "car.yaml"), "abc");
  EXPECT_EQ(json["overrides"]["a.b"], "[1 mm, 2]");
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(json["solver"]["steps"], 1000.0);
  EXPECT_EQ(json["duration"]["value"].get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json["version"], GetVersion().version);
  EXPECT_EQ(json["revision"], GetVersion().revision);
  EXPECT_FALSE(json["compiler"].get<std::string>().empty());
}

TEST_F(Results, NumbersInJsonReadBackExactlyAndNanIsNull) {
  ResultDirectory results(folder_ / "run", "study");
  nlohmann::ordered_json json;
  json["third"] = 1.0 / 3.0;
  json["nan"] = std::nan("");
  results.WriteJson("summary.json", json);
  results.Commit();
  const auto read = nlohmann::json::parse(ReadTextFile(folder_ / "run" / "summary.json"));
  EXPECT_EQ(read["third"].get<double>(), 1.0 / 3.0);
  EXPECT_TRUE(read["nan"].is_null());
}

TEST_F(Results, ASingleFileIsReplacedWhole) {
  const fs::path file = folder_ / "new" / "a.json";
  WriteFileAtomically(file, "one");
  WriteFileAtomically(file, "two");
  EXPECT_EQ(ReadTextFile(file), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), fs::directory_iterator()), 1);
  EXPECT_THAT(MessageOf<InputError>([] { WriteFileAtomically("/dev/full", "x"); }),
              HasSubstr("No space left on device"));
}

// FIPS 180-4 examples, and lengths around the padding's limits against the sum of a longer known
// one: a million times `a`.
TEST(Sha256, PublishedVectors) {
  EXPECT_EQ(CalcSha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(CalcSha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(CalcSha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(CalcSha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace kingpin::io
