// glocal submit with schedulers that only pretend; tests/cluster has the real ones.
#include <gmock/gmock.h>

#include <cstdlib>
#include <string>

#include "app/room.hpp"

namespace glocal::test::submit_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Programs are found in a folder of the test's own alone. All of Slurm's work, unless a test says otherwise.
class Submit : public Room {
 protected:
  Submit() {
    write_experiment("trials: {every_scan: 2, max_steps: 6}\n");  // 11 of them.
    fs::create_directory(file("bin"));
    pretend("scontrol", "echo 'Configuration data as of now'; echo 'MaxArraySize            = 1001'");
    pretend("squeue", "echo '7 /somewhere/else/.shards/array.sbatch'");
    pretend("sbatch", "case $* in *--version*) ;; *--dependency*) echo '42;cluster' ;; *) echo 41 ;; esac");
    pretend("scancel", ":");
    for (const char* name : {"sh", "seq", "cat"})
      fs::create_symlink(fs::path("/usr/bin") / name, file("bin/") + name);
    setenv("PATH", file("bin").c_str(), 1);
  }
  ~Submit() override { setenv("PATH", path_.c_str(), 1); }

  /// A program that notes its arguments, then does this.
  void pretend(const std::string& name, const std::string& text) const {
    std::ofstream(file("bin/" + name)) << "#!/bin/sh\necho " << name << " \"$@\" >>" << file("calls") << "\n"
                                       << text << "\n";
    fs::permissions(file("bin/" + name), fs::perms::owner_all);
  }
  void remove(const std::string& name) const { fs::remove(file("bin/" + name)); }

  [[nodiscard]] Answer submit(const std::string& options) const {
    return run("submit " + file("room.yaml") + " --out " + file("results") + " " + options);
  }
  [[nodiscard]] std::string script(const std::string& name) const {
    return content(file("results/.shards/" + name));
  }
  [[nodiscard]] std::string calls() const { return content(file("calls")); }

  void expect_nothing_done() const {
    EXPECT_FALSE(fs::exists(file("results")));
    EXPECT_THAT(calls(), Not(HasSubstr("--parsable")));
  }
  void expect_refused(const std::string& options, const std::string& words) const {
    const Answer answer = submit(options);
    EXPECT_EQ(answer.exit_code, 2) << options;
    EXPECT_THAT(answer.err, HasSubstr(words)) << options;
    expect_nothing_done();
  }

 private:
  std::string path_ = std::getenv("PATH");
};

TEST_F(Submit, QueuesAnArrayAndThenTheMerge) {
  const Answer answer = good(submit(
      "--slurm --shards 8 --limit 2 --time 10 --sbatch-option --partition=short --sbatch-option=--mem=1G"));
  const std::string folder = file("results/.shards/");
  EXPECT_THAT(calls(), HasSubstr("sbatch --parsable " + folder + "array.sbatch\n" +
                                 "sbatch --parsable --dependency=afterany:41 " + folder + "merge.sbatch\n"));
  EXPECT_THAT(script("array.sbatch"),
              AllOf(HasSubstr("\n#SBATCH --array=1-8%2\n"), HasSubstr("\n#SBATCH --time=10\n"),
                    HasSubstr("\n#SBATCH --partition=short\n#SBATCH --mem=1G\n")));
  EXPECT_THAT(answer.out, AllOf(HasSubstr(script("array.sbatch")), HasSubstr(script("merge.sbatch")),
                                HasSubstr("array 41 runs the shards, then job 42 puts"),
                                HasSubstr("glocal status " + file("results") + " --watch")));
  EXPECT_TRUE(fs::is_directory(folder + "logs"));
  // What is to be done is planned: jobs only do it.
  EXPECT_THAT(run("status " + file("results")).out, HasSubstr("0 of 11 trials done"));
}

TEST_F(Submit, DryRunNeedsNoSlurm) {
  for (const char* name : {"scontrol", "squeue", "sbatch", "scancel"}) remove(name);
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n", "seeds: 1..100\n");
  const Answer answer = good(submit("--slurm --shards 1100 --dry-run"));
  EXPECT_THAT(answer.out, AllOf(HasSubstr(script("array.sbatch")), HasSubstr(script("merge.sbatch")),
                                HasSubstr("Nothing is queued.")));
  EXPECT_THAT(script("array.sbatch"), HasSubstr("--array=1-550\n"));
}

TEST_F(Submit, DryRunQueuesNothing) {
  good(submit("--slurm --dry-run"));
  EXPECT_EQ(calls(), "scontrol show config\n");
}

TEST_F(Submit, TasksTakeSeveralShardsWhereArraysAreShort) {
  // Indices up to 5: with two shards for each task four will do.
  pretend("scontrol", "echo; echo 'MaxArraySize            = 6'");
  const Answer answer = good(submit("--slurm --shards 8"));
  EXPECT_THAT(script("array.sbatch"), AllOf(HasSubstr("--array=1-4\n"), HasSubstr("shard <= 8; shard += 4")));
  EXPECT_THAT(answer.out, HasSubstr("at most 5 tasks in an array: 4 of them run 8 shards"));
  good(submit("--slurm --shards 5"));
  EXPECT_THAT(script("array.sbatch"), AllOf(HasSubstr("--array=1-5\n"), Not(HasSubstr("shard +="))));
}

TEST_F(Submit, ATaskAsksForTheCoresThatItKeepsBusy) {
  write_experiment("trials: {every_scan: 6, max_steps: 5}\n",
                   "variants: {list: {one: {}, three: {threads: 3}}}\n");
  good(submit("--slurm --dry-run --jobs 2"));
  EXPECT_THAT(script("array.sbatch"), AllOf(HasSubstr("--cpus-per-task=6\n"), HasSubstr(" --jobs 2\n")));
}

TEST_F(Submit, ThereAreNoMoreShardsThanTrials) {
  good(submit("--slurm --dry-run"));
  EXPECT_THAT(script("array.sbatch"), HasSubstr("--array=1-11\n"));
}

TEST_F(Submit, TellsWhereThereIsNoSlurm) {
  remove("sbatch");
  expect_refused(
      "--slurm",
      "--slurm: error: sbatch cannot be run: No such file or directory; give this command where Slurm is");
}

TEST_F(Submit, TellsWhatSlurmSays) {
  pretend("scontrol", "echo 'slurm_load_ctl_conf error: Unable to contact slurm controller' >&2; exit 1");
  EXPECT_EQ(refusal(submit("--slurm"), 1),
            "error: scontrol has failed:\nslurm_load_ctl_conf error: Unable to contact slurm controller\n");
  expect_nothing_done();

  pretend("scontrol", ":");
  pretend("sbatch",
          "[ $1 = --version ] || { echo 'sbatch: error: invalid partition specified: short' >&2; exit 1; }");
  EXPECT_EQ(refusal(submit("--slurm"), 1),
            "error: sbatch has failed:\nsbatch: error: invalid partition specified: short\n");
  EXPECT_THAT(calls(), Not(HasSubstr("--dependency")));
}

TEST_F(Submit, CancelsAnArrayWithoutAMerge) {
  pretend("sbatch",
          "case $* in *--dependency*) echo 'sbatch: error: Job dependency problem' >&2; exit 1 ;; *) echo 41 "
          ";; esac");
  EXPECT_EQ(refusal(submit("--slurm"), 1),
            "error: sbatch has failed:\nsbatch: error: Job dependency problem\n"
            "note: job 41, the array before it, has been cancelled\n");
  EXPECT_THAT(calls(), HasSubstr("scancel 41\n"));
  remove("scancel");
  EXPECT_THAT(submit("--slurm").err,
              HasSubstr("job 41, the array before it, is queued still, as scancel failed: No such file"));
}

TEST_F(Submit, QueuesNothingTwice) {
  pretend("squeue", "echo '5 /else/array.sbatch'; echo '41 " + file("results/.shards/array.sbatch") + "'");
  EXPECT_THAT(refusal(submit("--slurm"), 1),
              HasSubstr("job 41 runs these shards already: wait for it, or cancel it first (scancel 41)"));
  expect_nothing_done();
}

TEST_F(Submit, FaultsShowBeforeAnythingIsQueued) {
  write_experiment("trials: {every_scan: 6, max_step: 5}\n");
  expect_refused("--slurm", "unknown key 'max_step'");
  pretend("parallel", "echo GNU parallel 20221122");
  expect_refused("--parallel", "unknown key 'max_step'");
}

TEST_F(Submit, RefusesOptionsThatSchedulersWouldMisread) {
  pretend("parallel", "echo GNU parallel 20221122");
  expect_refused("", "Say --slurm or --parallel");
  expect_refused("--slurm --parallel", "--slurm excludes --parallel");
  expect_refused("--slurm --shards 0", "--shards");
  expect_refused("--slurm --time tomorrow", "--time tomorrow: error: is no time");
  expect_refused("--slurm --sbatch-option partition=short", "is no option of sbatch");
  expect_refused("--slurm --sbatch-option '--mem=1G\nrm -r /'", "is no option of sbatch");
  expect_refused("--slurm --sshlogin hosts", "--sshlogin requires --parallel");
  expect_refused("--slurm --set nothing", "not of the form path=value");
  expect_refused("--parallel --time 10", "--time requires --slurm");
  expect_refused("--parallel --sshlogin hosts", "hosts: error: cannot be read: No such file");
  EXPECT_THAT(refusal(run("submit room.yaml --slurm --out 'a\\b'")),
              HasSubstr("a line break or a backslash"));
  EXPECT_FALSE(fs::exists("a\\b"));
}

TEST_F(Submit, TellsWhereThereIsNoGnuParallel) {
  expect_refused("--parallel",
                 "there is no GNU parallel (No such file or directory); install the package parallel");
  pretend("parallel", "echo 'parallel from moreutils'; exit 1");
  expect_refused("--parallel", "there is no GNU parallel (parallel is another program)");
}

TEST_F(Submit, GnuParallelRunsAllShardsAndMerges) {
  pretend("parallel",
          "[ $1 = --version ] && echo GNU parallel 20221122 || while read -r n; do sh shard.sh $n; done");
  good(submit("--parallel --shards 3 --seed 5"));
  EXPECT_THAT(calls(), HasSubstr("parallel --joblog joblog --resume-failed sh shard.sh {}\n"));
  good(run_room("one", "--quiet --seed 5"));
  expect_same_results("one", "results");
}

TEST_F(Submit, TellsWhatGnuParallelHasNotDone) {
  pretend("parallel", "[ $1 = --version ] && echo GNU parallel 20221122 || sh shard.sh 2");
  EXPECT_THAT(refusal(submit("--parallel --shards 3"), 3), HasSubstr("of 11 trials are missing"));
}

TEST_F(Submit, CtrlCEndsAllInGoodOrder) {
  // It reaches the script and glocal, which has started it.
  pretend("parallel",
          "[ $1 = --version ] && echo GNU parallel 20221122 && exit; read -r _ _ _ glocal _ "
          "</proc/$PPID/stat; kill -INT $PPID $glocal");
  EXPECT_THAT(refusal(submit("--parallel"), 3), Not(HasSubstr("missing"))) << "nothing is merged";
}

TEST_F(Submit, GnuParallelRunsWhatAnExperimentHasGotSince) {
  pretend("parallel",
          "[ $1 = --version ] && echo GNU parallel 20221122 && exit; [ -f joblog ] || { sh shard.sh 1; sh "
          "shard.sh 2; }; >joblog");
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n", "seeds: [1]\n");
  good(submit("--parallel --shards 2"));
  write_experiment("trials: {every_scan: 2, max_steps: 6}\n", "seeds: [1, 2]\n");
  good(submit("--parallel --shards 2"));
  EXPECT_TRUE(fs::exists("results/seed-2/summary.json"));
}

}  // namespace
}  // namespace glocal::test::submit_test
