// The scripts of glocal submit, as they are to be.
#include "app/job_scripts.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "temporary_folder.hpp"

namespace glocal::test::job_scripts_test {
namespace {

using namespace glocal::app;
using testing::HasSubstr;
using testing::Not;

ShardedRun plain_run() {
  ShardedRun run;
  run.name = "room";
  run.program = "/opt/bin/glocal";
  run.file = "/home/me/room.yaml";
  run.out = "/data/room";
  run.shards = 8;
  return run;
}

ShardedRun full_run() {
  ShardedRun run = plain_run();
  run.plugins = {"/opt/my plugin.so", "/opt/b.so"};
  run.file = "/home/it's me/room.yaml";
  run.options = {"--set",  "name=a b", "--set",     "map.ros_map.path=$HOME/`x`.yaml",
                 "--seed", "7",        "--threads", "2"};
  run.working_folder = "/home/it's me";
  run.datasets = "/data/sets";
  run.out = "/data/a \"b\" 100%";
  run.jobs = 3;
  run.cores = 6;
  return run;
}

TEST(JobScripts, PlainArray) {
  EXPECT_EQ(array_script(plain_run(), {.tasks = 8}),
            R"(#!/bin/bash
# Runs the 8 shards of room as an array of 8 tasks. Written by glocal submit, which queues it with
#   sbatch --parsable /data/room/.shards/array.sbatch
#   sbatch --dependency=afterany:ID /data/room/.shards/merge.sbatch
# where ID is what the first one prints. Whoever queues it again runs only what is missing.
#SBATCH --job-name=glocal_room
#SBATCH --array=1-8
#SBATCH --cpus-per-task=1
#SBATCH --output="/data/room/.shards/logs/%A_%a.log"
#SBATCH --open-mode=append
#SBATCH --requeue
# A task may be killed or requeued at any time: finished trials are kept. When its time is over, Slurm sends
# SIGTERM to all of its processes, and SIGKILL 30 s later (KillWait). glocal then ends after the step under
# way, so no --signal is needed.
exec /opt/bin/glocal run /home/me/room.yaml --shard "$SLURM_ARRAY_TASK_ID/8" --out /data/room
)");
}

TEST(JobScripts, ArrayWithAllOptionsAndOddPaths) {
  EXPECT_EQ(array_script(full_run(), {.tasks = 4,
                                      .limit = 2,
                                      .time = "1:00:00",
                                      .options = {"--partition=short", "--mail-user=\"a b\""}}),
            R"(#!/bin/bash
# Runs the 8 shards of room as an array of 4 tasks. Written by glocal submit, which queues it with
#   sbatch --parsable '/data/a "b" 100%/.shards/array.sbatch'
#   sbatch --dependency=afterany:ID '/data/a "b" 100%/.shards/merge.sbatch'
# where ID is what the first one prints. Whoever queues it again runs only what is missing.
#SBATCH --job-name=glocal_room
#SBATCH --array=1-4%2
#SBATCH --cpus-per-task=6
#SBATCH --output="/data/a \"b\" 100%%/.shards/logs/%A_%a.log"
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --time=1:00:00
#SBATCH --partition=short
#SBATCH --mail-user="a b"
# A task may be killed or requeued at any time: finished trials are kept. When its time is over, Slurm sends
# SIGTERM to all of its processes, and SIGKILL 30 s later (KillWait). glocal then ends after the step under
# way, so no --signal is needed.
export GLOCAL_DATASETS=/data/sets
# Relative paths in options start here.
cd '/home/it'\''s me' || exit 2
# Slurm takes no more tasks in an array: each runs several shards, one after the other.
code=0
for ((shard = SLURM_ARRAY_TASK_ID; shard <= 8; shard += 4)); do
  /opt/bin/glocal --plugin '/opt/my plugin.so' --plugin /opt/b.so run '/home/it'\''s me/room.yaml' --set 'name=a b' --set 'map.ros_map.path=$HOME/`x`.yaml' --seed 7 --threads 2 --shard "$shard/8" --out '/data/a "b" 100%' --jobs 3 || code=$?
  # 1 means that a trial has failed: the other shards are run all the same.
  [ "$code" -le 1 ] || break
done
exit "$code"
)");
}

TEST(JobScripts, Merge) {
  EXPECT_EQ(merge_script(full_run(), {.tasks = 4, .time = "10", .options = {"--partition=short"}}),
            R"(#!/bin/bash
# Puts the results of the 8 shards of room together, and says what is missing. Written by glocal submit.
#SBATCH --job-name=glocal_merge_room
#SBATCH --output="/data/a \"b\" 100%%/.shards/logs/merge_%j.log"
#SBATCH --open-mode=append
#SBATCH --time=10
#SBATCH --partition=short
exec /opt/bin/glocal merge '/data/a "b" 100%'
)");
}

TEST(JobScripts, GnuParallel) {
  EXPECT_EQ(shard_script(plain_run()),
            R"(#!/bin/sh
# Runs one of the 8 shards of room; its number is the argument. Written by glocal submit.
exec /opt/bin/glocal run /home/me/room.yaml --shard "$1/8" --out /data/room
)");
  EXPECT_EQ(parallel_script(plain_run(), {}),
            R"(#!/bin/sh
# Runs the 8 shards of room with GNU parallel on this machine, then puts the results together. Written by
# glocal submit. Again, for what is missing:
#   sh /data/room/.shards/parallel.sh
cd /data/room/.shards || exit 2
# Shards that ended well, by the joblog, are passed over; glocal submit begins a new one. What
# became of the others, the merge says.
seq 8 | parallel --joblog joblog --resume-failed sh shard.sh {}
exec /opt/bin/glocal merge /data/room
)");
}

TEST(JobScripts, GnuParallelOnSeveralMachines) {
  const std::string script = parallel_script(full_run(), {.hosts = "/home/it's me/hosts.txt", .limit = 4});
  EXPECT_THAT(script, HasSubstr("the 8 shards of room with GNU parallel on several machines, then"));
  EXPECT_THAT(script, HasSubstr("\ncd '/data/a \"b\" 100%/.shards' || exit 2\n"));
  EXPECT_THAT(script, HasSubstr("\nseq 8 | parallel --joblog joblog --resume-failed --jobs 4 --workdir . "
                                "--sshloginfile '/home/it'\\''s me/hosts.txt' sh shard.sh {}\n"));
}

TEST(JobScripts, ShardsOfSeveralCoresLeaveNoneToShare) {
  ShardedRun run = plain_run();
  const auto jobs_with = [&](int cores) {
    run.cores = cores;
    return parallel_script(run, {});
  };
  EXPECT_THAT(jobs_with(1), Not(HasSubstr("--jobs")));
  EXPECT_THAT(jobs_with(4), HasSubstr(" --jobs 25% "));
  // As little as can be said.
  EXPECT_THAT(jobs_with(256), HasSubstr(" --jobs 1% "));
}

TEST(JobScripts, OneShardIsNotCalledSeveral) {
  ShardedRun run = plain_run();
  run.shards = 1;
  EXPECT_THAT(array_script(run, {}), HasSubstr("Runs the one shard of room as an array of 1 task."));
  EXPECT_THAT(array_script(run, {}), HasSubstr("\n#SBATCH --array=1-1\n"));
}

/// The shell itself says what it reads.
TEST(ShellWord, IsOneWordToTheShell) {
  const TemporaryFolder folder;
  for (const std::string text :
       {"plain", "", "a b", "it's", "\"$HOME\" `id` \\ * ? [a] ~ !", "-n", "#", "a\nb", "ä"}) {
    const std::string out = folder / "out";
    ASSERT_EQ(std::system(("sh -c 'printf \"%s|\" \"$@\"' sh " + shell_word(text) + " end >" + out).c_str()),
              0);
    std::ifstream file(out);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text + "|end|");
  }
}

}  // namespace
}  // namespace glocal::test::job_scripts_test
