// Plugins as users name them: --plugin, GLOCAL_PLUGIN_PATH and the key `plugins` of an experiment.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace glocal::test::plugin_command_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class PluginCommand : public CommandLine {
 protected:
  static std::string plugin(const std::string& name) {
    return fs::path(GLOCAL_TEST_PLUGINS) / (name + ".so");
  }

  /// An experiment of nothing but the plugin's strategies.
  void write_experiment(const std::string& plugins, const std::string& matcher = "oracle") const {
    std::ofstream(file("e.yaml")) << "schema: 1\n"
                                     "name: e\n"
                                  << plugins
                                  << "map: {room: {side: 8.0}}\n"
                                     "observations: {standing: {scans: 20}}\n"
                                     "trials: {every_scan: 5, max_steps: 5}\n"
                                     "localizer:\n"
                                     "  local_mapper: last_scan\n"
                                     "  clusterer: each_alone\n"
                                     "  rater: all_alike\n"
                                     "  threshold_policy: always_half\n"
                                     "  verdict_rule: at_once\n"
                                     "  matcher: "
                                  << matcher << "\n";
  }

  void expect_refused(const std::string& file, const std::vector<std::string>& words) const {
    const Answer answer = run("list --plugin " + file);
    EXPECT_EQ(answer.exit_code, 2) << answer.err;
    EXPECT_THAT(answer.err, HasSubstr(file + ": error: "));
    for (const std::string& word : words) EXPECT_THAT(answer.err, HasSubstr(word));
    EXPECT_EQ(answer.out, "");
  }
};

TEST_F(PluginCommand, StrategiesOfEveryKindAreListedAndDescribed) {
  const Answer list = good(run("list --plugin " + plugin("every_kind")));
  for (const char* name : {"room", "standing", "last_scan", "oracle", "each_alone", "all_alike",
                           "always_half", "at_once", "ahead", "mute"}) {
    EXPECT_THAT(list.out, HasSubstr(name));
    EXPECT_EQ(run("describe " + std::string(name) + " --plugin " + plugin("every_kind")).exit_code, 0)
        << name;
  }
  const Answer room = run("--plugin " + plugin("every_kind") + " describe room");
  EXPECT_THAT(room.out, AllOf(HasSubstr("every_kind 1.2.3"), HasSubstr("side: number (> 0 m), default 8")));
  EXPECT_THAT(run("schema --plugin " + plugin("every_kind")).out, HasSubstr("each_alone"));
  EXPECT_THAT(run("list").out, Not(HasSubstr("oracle")));
}

TEST_F(PluginCommand, FoldersOfPluginsComeFromTheEnvironment) {
  fs::create_directory(file("plugins"));
  fs::copy(plugin("every_kind"), file("plugins/a.so"));
  std::ofstream(file("plugins/readme.txt")) << "not a plugin\n";
  setenv("GLOCAL_PLUGIN_PATH", (":" + file("plugins")).c_str(), 1);
  const Answer found = run("list matcher");
  setenv("GLOCAL_PLUGIN_PATH", file("nowhere").c_str(), 1);
  const Answer missing = run("list matcher");
  unsetenv("GLOCAL_PLUGIN_PATH");
  EXPECT_THAT(found.out, HasSubstr("oracle")) << found.err;
  EXPECT_THAT(refusal(missing), AllOf(HasSubstr("nowhere"), HasSubstr("GLOCAL_PLUGIN_PATH")));
}

TEST_F(PluginCommand, AnExperimentNamesItsPluginsAndRecordsThem) {
  fs::copy(plugin("every_kind"), file("mine.so"));
  write_experiment("plugins: [mine.so]\n");
  good(run("check " + file("e.yaml")));
  good(run("run " + file("e.yaml") + " --quiet --out " + file("results")));
  EXPECT_EQ(Json::parse(content(file("results/summary.json")))["trials"]["right"], 4);
  const Json provenance = Json::parse(content(file("results/provenance.json")));
  EXPECT_EQ(provenance["plugins"], Json({"every_kind 1.2.3"}));
  EXPECT_TRUE(provenance["inputs_sha256"].contains(fs::canonical(file("mine.so")).string()));
}

TEST_F(PluginCommand, TheEffectiveExperimentRunsWithoutTheOption) {
  write_experiment("");
  good(run("run " + file("e.yaml") + " --quiet --out " + file("a") + " --plugin " + plugin("every_kind")));
  good(run("run " + file("a/effective.yaml") + " --quiet --out " + file("b")));
  EXPECT_EQ(content(file("a/trials.jsonl")), content(file("b/trials.jsonl")));
}

TEST_F(PluginCommand, FaultsInTheParametersOfAPluginsStrategyHavePlaces) {
  write_experiment("plugins: [" + plugin("every_kind") + "]\n");
  EXPECT_THAT(refusal(run("check " + file("e.yaml") + " --set map.room.side=-1 --set map.room.sid=2")),
              AllOf(HasSubstr("-1 is out of range, must be > 0 m"), HasSubstr("did you mean 'side'?")));
}

TEST_F(PluginCommand, AMissingPluginOfAnExperimentIsAFaultOfItsFile) {
  write_experiment("plugins: [nowhere.so]\n");
  EXPECT_THAT(refusal(run("check " + file("e.yaml"))),
              AllOf(HasSubstr("e.yaml:3:11: error: plugins[0]: no such file: "), HasSubstr("nowhere.so")));
}

TEST_F(PluginCommand, NamedTwiceItIsLoadedOnce) {
  good(run("list --plugin " + plugin("every_kind") + " --plugin " + plugin("every_kind")));
}

TEST_F(PluginCommand, AnExceptionInAStepEndsOnlyItsTrial) {
  write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("throws_in_step") + "]\n", "moody");
  const Answer answer = run("run " + file("e.yaml") + " --out " + file("results"));
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_THAT(answer.err, AllOf(HasSubstr("trial 1 failed"), HasSubstr("out of mood")));
  EXPECT_THAT(answer.out, HasSubstr("failed              1"));
  const Json trials = Json::parse(content(file("results/summary.json")))["trials"];
  EXPECT_EQ(trials["count"], 4);
  EXPECT_EQ(trials["undecided"], 3);
  EXPECT_EQ(trials["failed"], 1);
}

TEST_F(PluginCommand, ABrokenContractEndsOnlyItsTrial) {
  write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("ill_behaved") + "]\n", "ill_behaved");
  EXPECT_THAT(refusal(run("run " + file("e.yaml") + " --out " + file("results")), 1),
              HasSubstr("trial 0 failed in step 0: matcher 'ill_behaved' breaks its contract in step "
                        "0: hypothesis 0 has the pose (nan, 0, 0); poses are finite"));
  EXPECT_EQ(Json::parse(content(file("results/summary.json")))["trials"]["failed"], 4);
}

TEST_F(PluginCommand, ACrashSaysInWhichStrategy) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer reports crashes itself";
#endif
  const auto run_how = [&](const std::string& how) {
    write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("ill_behaved") + "]\n",
                     "{ill_behaved: {how: " + how + "}}");
    return run("run " + file("e.yaml") + " --quiet --force --out " + file("results"));
  };
  const std::string where = " in matcher 'ill_behaved', trial 0, step 0; what was finished before is kept\n";
  for (const char* how : {"crash", "crash_in_a_thread"}) {
    const Answer answer = run_how(how);
    EXPECT_EQ(answer.exit_code, 128 + SIGSEGV) << how;
    EXPECT_THAT(answer.err, HasSubstr("error: crashed (SIGSEGV, memory that is not its own)" + where)) << how;
  }
  EXPECT_THAT(refusal(run_how("abort"), 128 + SIGABRT),
              HasSubstr("error: crashed (SIGABRT, it gave up)" + where));
}

TEST_F(PluginCommand, CopiesOfTheProcessAreEnded) {
  for (const char* how : {"fork", "fork_and_go_on"}) {
    write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("ill_behaved") + "]\n",
                     "{ill_behaved: {how: " + std::string(how) + "}}");
    for (const char* options : {"", "--threads=2", "--jobs=2", "--shard=1/1"}) {
      const Answer answer =
          run("run " + file("e.yaml") + " --quiet --out " +
              file(how + std::string(options[0] ? options + 2 : "").substr(0, 4)) + " " + options);
      EXPECT_THAT(answer.err,
                  HasSubstr("error: matcher 'ill_behaved', trial 0, step 0 has called fork(), and "
                            "the copy has come back to the run; the copy is ended"))
          << how << options;
    }
    // Four trials, as without copies.
    const Json trials = Json::parse(content(file(std::string(how) + "/summary.json")))["trials"];
    EXPECT_EQ(trials["count"], 4) << how;
  }
}

/// Shards of trials that start at the stamps 0, 5, 10 and 15, one step each.
class CrashingShard : public PluginCommand {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "the sanitizer reports crashes itself";
#endif
  }

  [[nodiscard]] Answer run_shard(const std::string& how, const std::string& options = "") const {
    write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("ill_behaved") + "]\n",
                     "{ill_behaved: {" + how + "}}");
    return run("run " + file("e.yaml") + " --set trials.max_steps=1 --quiet --shard 1/1 --out " +
               file("shared") + " " + options);
  }

  [[nodiscard]] std::vector<Json> merged_trials() const {
    static_cast<void>(run("merge " + file("shared")));
    std::ifstream lines(file("shared/trials.jsonl"));
    std::vector<Json> trials;
    for (std::string line; std::getline(lines, line);) trials.push_back(Json::parse(line));
    return trials;
  }
};

TEST_F(CrashingShard, ATrialThatCrashesTwiceIsARowAndTakesNoOthersWithIt) {
  for (const char* jobs : {"", "--jobs 2"}) {
    fs::remove_all(file("shared"));
    EXPECT_THAT(refusal(run_shard("how: crash, stamp: 5", jobs), 1),
                AllOf(HasSubstr("trial 1 has crashed (SIGSEGV); it is tried once more, alone"),
                      HasSubstr("trial 1 has crashed (SIGSEGV); it is given up")));
    const auto trials = merged_trials();
    ASSERT_EQ(trials.size(), 4U);
    for (const Json& trial : trials)
      EXPECT_EQ(trial["outcome"], trial["trial"] == 1 ? "failed" : "undecided") << trial;
    EXPECT_EQ(trials[1]["why"], "crashed (SIGSEGV) in matcher 'ill_behaved', step 0, in each of 2 processes");
    EXPECT_EQ(trials[1]["start"]["stamp"], 5.0);
    EXPECT_EQ(trials[1]["start"].size(), trials[0]["start"].size());
    const Answer status = run("status " + file("shared") + " --json");
    EXPECT_EQ(Json::parse(status.out)["all"]["failed"], 1);
    EXPECT_EQ(run("merge --force --quiet " + file("shared")).exit_code, 1);
    good(run("summarize " + file("shared")));
    EXPECT_EQ(run_shard("how: crash, stamp: 5").exit_code, 1) << "it stays failed";
    EXPECT_THAT(run_shard("how: crash, stamp: 5").err, Not(HasSubstr("crashed"))) << "and is not run again";
  }
}

TEST_F(CrashingShard, ATrialIsNotBlamedForTheCrashOfTheStartThatHasItsNumber) {
  // Trial 0 begins at start 1, and trial 1 beside it.
  const Answer answer = run_shard("how: crash, stamp: 5", "--jobs 2 --set trials.only=[1,2]");
  EXPECT_THAT(refusal(answer, 1), HasSubstr("trial 0 has crashed (SIGSEGV); it is given up"));
  EXPECT_THAT(answer.err, Not(HasSubstr("trial 1 has crashed")));
}

TEST_F(CrashingShard, ATrialThatEndsTheProgramHasCrashed) {
  EXPECT_THAT(refusal(run_shard("how: exit, stamp: 10"), 1),
              HasSubstr("trial 2 has crashed (exit(0)); it is given up"));
  const auto trials = merged_trials();
  ASSERT_EQ(trials.size(), 4U);
  EXPECT_EQ(trials[2]["why"], "crashed (exit(0)), in each of 2 processes");
}

TEST_F(CrashingShard, ATrialThatCrashesOnceIsNot) {
  const Answer answer = good(run_shard("how: abort, stamp: 10, once: " + file("mark")));
  EXPECT_THAT(answer.err, HasSubstr("trial 2 has crashed (SIGABRT); it is tried once more, alone"));
  const auto trials = merged_trials();
  ASSERT_EQ(trials.size(), 4U);
  for (const Json& trial : trials) EXPECT_EQ(trial["outcome"], "undecided");
}

TEST_F(CrashingShard, AnotherVersionOfAPluginIsRefused) {
  fs::copy(plugin("ill_behaved"), file("mine.so"));
  const auto run_mine = [&] {
    write_experiment("plugins: [" + plugin("every_kind") + ", mine.so]\n", "{ill_behaved: {how: nan}}");
    return run("run " + file("e.yaml") + " --quiet --shard 1/1 --out " + file("shared"));
  };
  ASSERT_EQ(run_mine().exit_code, 1) << "all trials fail";
  std::ofstream(file("mine.so"), std::ios::app) << "more";
  EXPECT_THAT(refusal(run_mine()),
              HasSubstr("the folder was made otherwise: with other plugins, or other versions"));
}

TEST_F(PluginCommand, ASecondInterruptEndsAStepThatHangs) {
  write_experiment("plugins: [" + plugin("every_kind") + ", " + plugin("ill_behaved") + "]\n",
                   "{ill_behaved: {how: hang}}");
  // Long enough for the step to begin; a first signal that comes before leaves nothing for the second to end.
  const std::string script =
      std::string(GLOCAL_PROGRAM) + " run " + file("e.yaml") + " --quiet --out " + file("results") +
      " & p=$!; sleep 2; kill -INT $p; sleep 1; kill -0 $p || exit 90; kill -TERM $p; wait $p";
  EXPECT_EQ(std::system(("bash -c '" + script + "' 2>/dev/null").c_str()), (128 + SIGTERM) << 8);
}

TEST_F(PluginCommand, ResultsBringNoCodeAlong) {
  write_experiment("plugins: [" + plugin("every_kind") + "]\n");
  good(run("run " + file("e.yaml") + " --quiet --out " + file("a")));
  const std::string explain = "explain " + file("a") + " --trial 0 --step 0";
  EXPECT_THAT(refusal(run(explain)),
              AllOf(HasSubstr("a/effective.yaml: error: needs the plugin "), HasSubstr("every_kind.so"),
                    HasSubstr("--plugin "), HasSubstr("--trust-plugins")));
  const Answer named = good(run(explain + " --plugin " + plugin("every_kind")));
  const Answer trusted = good(run(explain + " --trust-plugins"));
  EXPECT_EQ(named.out, trusted.out);
  good(run("reliability " + file("a")));
}

TEST_F(PluginCommand, WhatIsNoPluginIsRefused) {
  expect_refused(file("none.so"), {"no such file"});
  std::ofstream(file("text.so"))
      << "#!/bin/sh\necho I am a script, not a plugin, and long enough to be read\n";
  expect_refused(file("text.so"), {"not a shared object", "glocal_add_plugin()"});
  fs::copy(plugin("every_kind"), file("cut.so"));
  fs::resize_file(file("cut.so"), fs::file_size(file("cut.so")) / 3);
  expect_refused(file("cut.so"), {"truncated", "again"});
  expect_refused(plugin("wrong_symbol"), {"no function 'glocal_plugin'", "GLOCAL_PLUGIN"});
}

TEST_F(PluginCommand, WhatDoesNotFitThisProgramIsRefused) {
  expect_refused(plugin("wrong_tag"), {"API version (it: 999, glocal: 15)",
                                       "size of Hypothesis (it: none, glocal: ", "build it again"});
  expect_refused(plugin("missing_dependency"), {"libgone.so", "install what is missing"});
  expect_refused(plugin("duplicate"),
                 {"matcher 'ransam' of copycat 2.0 is already registered by glocal", "rename one"});
}

TEST_F(PluginCommand, WhatThrowsWhileItIsLoadedIsRefused) {
  expect_refused(plugin("throws_loading"), {"threw an exception while it was loaded: no device"});
  expect_refused(plugin("throws_registering"),
                 {"threw an exception while it registered its strategies: no licence for 12 registries"});
}

TEST_F(PluginCommand, APluginExportsNothingButItsEntry) {
  const std::string symbols = file("symbols");
  ASSERT_EQ(std::system(("nm -D --defined-only " + plugin("every_kind") + " >" + symbols).c_str()), 0);
  const std::string text = content(symbols);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_THAT(text, HasSubstr(" T glocal_plugin\n"));
}

}  // namespace
}  // namespace glocal::test::plugin_command_test
