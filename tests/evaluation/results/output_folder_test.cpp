#include "evaluation/results/output_folder.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <iterator>
#include <utility>

#include "evaluation/results/file_io.hpp"
#include "files.hpp"
#include "glocal/error.hpp"

namespace glocal::test::output_folder_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

/// Files of at most so many bytes, as if the disk were full; the limit before is restored.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    static_cast<void>(std::signal(SIGXFSZ, handler_));
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(OutputFolder, AppearsWholeWhenCommitted) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder / "a/results", false);
    out.append("steps.jsonl", "one\n");
    out.append("maps/global.pcd", "points");
    out.append("steps.jsonl", "two\n");
    EXPECT_FALSE(fs::exists(folder / "a/results"));
    EXPECT_EQ(out.path(), folder / "a/results");
    out.commit();
  }
  EXPECT_EQ(content_of(folder / "a/results/steps.jsonl"), "one\ntwo\n");
  EXPECT_EQ(content_of(folder / "a/results/maps/global.pcd"), "points");
  EXPECT_EQ(entries(folder / "a"), 1);
}

TEST(OutputFolder, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder / "results", false);
    out.append("maps/global.pcd", "points");
  }
  EXPECT_EQ(entries(folder / ""), 0);
}

TEST(OutputFolder, AnEmptyFolderIsFree) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "results");
  OutputFolder out(folder / "results/", false);
  out.append("a", "1");
  out.commit();
  EXPECT_EQ(content_of(folder / "results/a"), "1");
}

TEST(OutputFolder, RefusesWhatIsThere) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "mine");
  const fs::path parent = file.parent_path();
  EXPECT_EQ(
      config_error(parent.parent_path(), [&] { OutputFolder(parent, false); }),
      parent.filename().string() +
          ": error: output: the folder exists and is not empty; choose another one with --out, or replace "
          "earlier results with --force");
  EXPECT_EQ(config_error(parent, [&] { OutputFolder(file, true); }),
            "a.txt: error: output: exists and is not a folder; choose another one with --out");
  EXPECT_EQ(content_of(file), "mine");
  EXPECT_EQ(entries(parent), 1);
}

TEST(OutputFolder, ReplacesOnlyEarlierResults) {
  const TemporaryFolder folder;
  const fs::path parent = (folder / "").parent_path();
  folder.write("home/thesis.tex", "years of work");
  EXPECT_EQ(config_error(parent, [&] { OutputFolder(folder / "home", true); }),
            "home: error: output: --force replaces only earlier results, and this folder has no "
            "provenance.json; choose another one with --out");
  EXPECT_EQ(content_of(folder / "home/thesis.tex"), "years of work");

  folder.write("results/provenance.json", "old");
  folder.write("results/old.txt", "old");
  OutputFolder out(folder / "results", true);
  out.append("provenance.json", "new");
  EXPECT_EQ(content_of(folder / "results/provenance.json"), "old");
  out.commit();
  EXPECT_EQ(content_of(folder / "results/provenance.json"), "new");
  EXPECT_FALSE(fs::exists(folder / "results/old.txt"));
  EXPECT_EQ(entries(parent), 2);
}

TEST(OutputFolder, DoesNotReplaceWhatIsRead) {
  const TemporaryFolder home;
  const fs::path results = home / "results";
  home.write("results/provenance.json", "{}");
  const auto fault = [&](const fs::path& input) {
    return config_error(home.path(), [&] { const OutputFolder again(results, true, {input}); });
  };
  fs::create_directory_symlink(results, home / "link");
  for (const fs::path& input : {results / "maps/global.pgm", home / "link/maps/global.pgm"}) {
    EXPECT_EQ(fault(home.write(fs::relative(input, home.path()), "P5")),
              "results: error: output: --force would remove results/maps/global.pgm, which is read; choose "
              "another folder with --out, or move that file");
  }
  EXPECT_THAT(fault(results), HasSubstr("--force would remove results, which is read"));
  {
    const OutputFolder late(results, true);
    EXPECT_THAT(config_error(home.path(), [&] { late.spare({results / "maps/global.pgm"}); }),
                HasSubstr("--force would remove results/maps/global.pgm, which is read"));
    late.spare({home / "elsewhere.pgm"});
  }
  EXPECT_TRUE(fs::exists(results / "maps/global.pgm"));
  const OutputFolder beside(results, true,
                            {home.write("results2/map.pgm", "P5"), results / "effective.yaml"});
}

TEST(OutputFolder, KeepsResultsThatAppearedMeanwhile) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder / "results", false);
    out.append("provenance.json", "later");
    folder.write("results/provenance.json", "sooner");
    EXPECT_NE(error_of<RunError>([&] { out.commit(); }), "");
  }
  EXPECT_EQ(content_of(folder / "results/provenance.json"), "sooner");
  EXPECT_EQ(entries(folder / ""), 1);
}

TEST(OutputFolder, EarlierResultsComeBackIfNewOnesCannotTakeTheirPlace) {
  const TemporaryFolder folder;
  folder.write("results/provenance.json", "old");
  {
    OutputFolder out(folder / "results", true);
    out.append("provenance.json", "new");
    // A run that ended between the two renames of commit().
    fs::rename(folder / "results", folder / ".results.replaced");
  }
  EXPECT_FALSE(fs::exists(folder / "results"));
  const OutputFolder out(folder / "results", true);
  EXPECT_EQ(content_of(folder / "results/provenance.json"), "old");
  EXPECT_FALSE(fs::exists(folder / ".results.replaced"));
}

TEST(OutputFolder, TakesUpWhatWasLeftUnfinished) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder / "results", false);
    out.write("a", "1");
    out.keep_unfinished();
  }
  EXPECT_EQ(content_of(folder / ".results.unfinished/a"), "1");
  EXPECT_EQ(entries(folder / ""), 1) << "the lock goes with its owner";
  {
    OutputFolder out(folder / "results", false, {}, [](const fs::path&, bool) { return true; });
    out.write("b", "2");
    out.write("b", "3");
    out.commit();
  }
  EXPECT_EQ(content_of(folder / "results/a"), "1");
  EXPECT_EQ(content_of(folder / "results/b"), "3");
  EXPECT_EQ(entries(folder / ""), 1);
}

TEST(OutputFolder, WhatWasLeftMayBeRemovedBeforeItIsSynced) {
  const TemporaryFolder folder;
  folder.write(".results.unfinished/left.json.part", "half");
  OutputFolder out(folder / "results", false, {}, [](const fs::path&, bool) { return true; });
  fs::remove(folder / ".results.unfinished/left.json.part");
  EXPECT_NO_THROW(out.sync());
}

TEST(OutputFolder, RemovesWhatIsNotTakenUp) {
  const TemporaryFolder folder;
  folder.write(".results.unfinished/a", "1");
  OutputFolder out(folder / "results", false);
  out.commit();
  EXPECT_TRUE(fs::is_empty(folder / "results"));
}

TEST(OutputFolder, TakesUpResultsThatAreNotComplete) {
  const TemporaryFolder folder;
  folder.write("results/a", "1");
  OutputFolder out(folder / "results", false, {}, [](const fs::path&, bool) { return true; });
  EXPECT_FALSE(fs::exists(folder / "results"));
  out.commit();
  EXPECT_EQ(content_of(folder / "results/a"), "1");
}

TEST(OutputFolder, AKillAtTheVeryEndLeavesNothingForLong) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "results");
  fs::create_directory(folder / ".results.replaced");
  folder.write(".results.lock", "");
  OutputFolder::tidy(folder / "results");
  EXPECT_EQ(entries(folder / ""), 1);
}

TEST(OutputFolder, HasOneOwner) {
  const TemporaryFolder folder;
  const OutputFolder out(folder / "results", false);
  EXPECT_EQ(config_error((folder / "").parent_path(), [&] { OutputFolder(folder / "results", true); }),
            "results: error: output: another run is writing this folder; wait for its end, or choose another "
            "one with --out");
  EXPECT_TRUE(fs::exists(out.unfinished()));
}

TEST(OutputFolder, SaysWhyItCannotBeMade) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "");
  EXPECT_EQ(error_of<RunError>([&] { OutputFolder(file / "results", false); }),
            (file / "results").string() + ": cannot write: Not a directory");
}

TEST(OutputFolder, AFullDiskLeavesNothing) {
  const TemporaryFolder folder;
  {
    OutputFolder out(folder / "results", false);
    out.append("provenance.json", "small");
    const FileSizeLimit full(1000);
    EXPECT_EQ(error_of<RunError>([&] { out.append("steps.jsonl", std::string(5000, 'x')); }),
              (folder / "results").string() +
                  ": cannot write steps.jsonl: File too large (for the limit that the shell or the system "
                  "sets: ulimit -f)");
  }
  EXPECT_EQ(entries(folder / ""), 0);
}

TEST(OutputFolder, AFullDiskTellsWhereFinishedWorkIs) {
  const TemporaryFolder folder;
  OutputFolder out(folder / "results", false);
  out.keep_unfinished();
  const FileSizeLimit full(1000);
  EXPECT_THAT(error_of<RunError>([&] { out.write("maps/a.pcd", std::string(5000, 'x')); }),
              AllOf(HasSubstr("/results: cannot write maps/a.pcd: "),
                    HasSubstr("; finished trials are kept in " + out.unfinished().string() +
                              ": give the same command again")));
}

TEST(OutputFolder, ALinkStaysAndWhatItLeadsToIsWritten) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "empty");
  fs::create_directory_symlink("empty", folder / "link");
  fs::create_directory_symlink("far/missing", folder / "dangling");
  for (const auto& [link, real] : {std::pair{"link", "empty"}, std::pair{"dangling", "far/missing"}}) {
    for (const std::string text : {"first", "second"}) {
      OutputFolder::check(folder / link, true);
      OutputFolder out(folder / link, true);
      out.append("provenance.json", text);
      out.commit();
      EXPECT_EQ(content_of(folder / real / "provenance.json"), text);
      EXPECT_TRUE(fs::is_symlink(folder / link));
    }
  }
  EXPECT_EQ(entries(folder / ""), 4);
  EXPECT_EQ(entries(folder / "far"), 1);
}

TEST(OutputFolder, IsCheckedWithoutBeingTouched) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "mine");
  const fs::path parent = file.parent_path();
  EXPECT_EQ(error_of<RunError>([&] { OutputFolder::check(file / "results", false); }),
            (file / "results").string() + ": cannot write: Not a directory: " + file.string());
  EXPECT_THAT(config_error(parent, [&] { OutputFolder::check(file, true); }), HasSubstr("is not a folder"));
  EXPECT_THAT(config_error(parent, [&] { OutputFolder::check(parent, true); }),
              HasSubstr("has no provenance.json"));
  OutputFolder::check(folder / "new/results", false);
  EXPECT_FALSE(fs::exists(folder / "new"));
  {
    const OutputFolder other(folder / "results", false);
    EXPECT_THAT(config_error(parent, [&] { OutputFolder::check(folder / "results", false); }),
                HasSubstr("another run is writing this folder"));
  }
  EXPECT_EQ(entries(parent), 1);
}

TEST(OutputFolder, WhatIsUnfinishedGoesOnBeforeWhatWasInterrupted) {
  const TemporaryFolder folder;
  folder.write("results/a", "interrupted");
  folder.write(".results.unfinished/a", "of another run");
  OutputFolder out(folder / "results", true, {}, [](const fs::path&, bool is_final) { return is_final; });
  EXPECT_EQ(content_of(out.unfinished() / "a"), "interrupted");
}

/// Another user than root, who may do everything.
class SomeUser {
 public:
  SomeUser() {
    if (before_ == 0) static_cast<void>(seteuid(65534));
  }
  ~SomeUser() { static_cast<void>(seteuid(before_)); }
  SomeUser(const SomeUser&) = delete;
  SomeUser& operator=(const SomeUser&) = delete;

 private:
  uid_t before_ = geteuid();
};

class LockedResults : public testing::Test {
 protected:
  LockedResults() {
    folder_.write("results/provenance.json", "{}");
    folder_.write("results/maps/a.pcd", "points");
    for (const char* name : {"", "results"}) fs::permissions(folder_ / name, fs::perms::all);
    lock_maps();
  }
  ~LockedResults() override { fs::permissions(folder_ / "results/maps", fs::perms::all); }

  void lock_maps() const { fs::permissions(folder_ / "results/maps", fs::perms(0555)); }

  TemporaryFolder folder_;
};

TEST_F(LockedResults, OfSomeoneElseAreRefusedBeforeTheRun) {
  const SomeUser user;
  EXPECT_EQ(config_error(folder_.path(), [&] { OutputFolder::check(folder_ / "results", true); }),
            "results: error: output: --force cannot remove the earlier results, as results/maps belongs to "
            "someone else (Permission denied); choose another folder with --out");
}

TEST_F(LockedResults, ThatCannotBeRemovedAreNotLeftInSilence) {
  fs::permissions(folder_ / "results/maps", fs::perms::all);
  const SomeUser user;
  OutputFolder out(folder_ / "results", true);
  out.append("provenance.json", "new");
  {
    if (getuid() == 0) static_cast<void>(seteuid(0));
    lock_maps();
    if (getuid() == 0) static_cast<void>(seteuid(65534));
  }
  EXPECT_THAT(error_of<RunError>([&] { out.commit(); }),
              AllOf(HasSubstr((folder_ / ".results.replaced").string() + ": cannot remove"),
                    HasSubstr("remove the folder, then give the same command again")));
  EXPECT_EQ(content_of(folder_ / "results/provenance.json"), "new");
  if (getuid() == 0) static_cast<void>(seteuid(0));
  fs::permissions(folder_ / ".results.replaced/maps", fs::perms::all);
  fs::create_directory(folder_ / "results/maps");
}

}  // namespace
}  // namespace glocal::test::output_folder_test
