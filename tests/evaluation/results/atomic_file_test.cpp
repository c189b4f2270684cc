#include "evaluation/results/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>

#include "evaluation/results/file_io.hpp"
#include "files.hpp"
#include "glocal/error.hpp"

namespace glocal::test::atomic_file_test {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFiles, AppearTogetherWhenCommitted) {
  const test::TemporaryFolder folder;
  AtomicFiles files(false);
  files.add(folder / "sub/a.txt", "first");
  files.add(folder / "sub/b.txt", "second");
  EXPECT_FALSE(fs::exists(folder / "sub/a.txt"));
  files.commit();
  EXPECT_EQ(content_of(folder / "sub/a.txt"), "first");
  EXPECT_EQ(content_of(folder / "sub/b.txt"), "second");
  EXPECT_EQ(entries(folder / "sub"), 2);
}

TEST(AtomicFiles, CanBeWrittenPieceByPiece) {
  const test::TemporaryFolder folder;
  AtomicFiles files(false);
  files.add(folder / "a.txt", "first");
  files.add(folder / "b.txt", "");
  files.append("second, ");
  files.append("third");
  EXPECT_FALSE(fs::exists(folder / "b.txt"));
  files.commit();
  EXPECT_EQ(content_of(folder / "a.txt"), "first");
  EXPECT_EQ(content_of(folder / "b.txt"), "second, third");
}

TEST(AtomicFiles, LeaveNothingWithoutCommit) {
  const test::TemporaryFolder folder;
  folder.write("b.txt", "old");
  {
    AtomicFiles files(true);
    files.add(folder / "a.txt", "new");
    files.add(folder / "b.txt", "new");
  }
  EXPECT_EQ(entries(folder / ""), 1);
  EXPECT_EQ(content_of(folder / "b.txt"), "old");
}

TEST(AtomicFiles, ReplaceWhatALinkLeadsToAndNoDevice) {
  const test::TemporaryFolder folder;
  folder.write("real.txt", "old");
  fs::create_symlink(folder / "real.txt", folder / "link.txt");
  fs::create_symlink(folder / "nowhere", folder / "lost.txt");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  AtomicFiles files(true);
  files.add(folder / "link.txt", "new");
  EXPECT_THAT(error_of([&] { files.add(folder / "lost.txt", "new"); }),
              testing::HasSubstr("is a link that leads nowhere"));
  EXPECT_THAT(error_of([&] { files.add(folder / "pipe", "new"); }),
              testing::HasSubstr("is a device or a pipe"));
  files.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(content_of(folder / "real.txt"), "new");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(AtomicFiles, ReplaceOnlyWhenAllowed) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("a.txt", "old, and longer");
  AtomicFiles refused(false);
  EXPECT_EQ(test::config_error(file.parent_path(), [&] { refused.add(file, "new"); }),
            "a.txt: error: the file exists; choose another name, or replace it with --force");
  EXPECT_EQ(content_of(file), "old, and longer");
  AtomicFiles allowed(true);
  allowed.add(file, "new");
  allowed.commit();
  EXPECT_EQ(content_of(file), "new");
}

TEST(AtomicFiles, SayWhyTheyCannotBeWritten) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  AtomicFiles files(true);
  EXPECT_EQ(test::config_error((folder / "sub").parent_path(), [&] { files.add(folder / "sub", "x"); }),
            "sub: error: is a folder; name a file");
  folder.write("a.txt", "");
  EXPECT_EQ(error_of<RunError>([&] { files.add(folder / "a.txt/b.txt", "x"); }),
            (folder / "a.txt/b.txt").string() + ": cannot write: Not a directory");
}

TEST(AppendToFile, FailsOnAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  EXPECT_EQ(append_to_file("/dev/full", "x"), std::errc::no_space_on_device);
}

TEST(WithoutLinks, FollowsThemToWhereNothingIsYet) {
  const test::TemporaryFolder folder;
  const fs::path real = fs::canonical(folder.path());
  fs::create_directories(real / "a/b");
  fs::create_directory_symlink(real / "a/b", real / "absolute");
  fs::create_directory_symlink("absolute/../c/d", real / "dangling");
  EXPECT_EQ(without_links(real / "absolute/x/./"), real / "a/b/x");
  EXPECT_EQ(without_links(real / "absolute/../x"), real / "a/x");
  EXPECT_EQ(without_links(real / "dangling/x"), real / "a/c/d/x");
  fs::create_directory_symlink("there", real / "here");
  fs::create_directory_symlink("here", real / "there");
  EXPECT_EQ(test::config_error(real, [&] { static_cast<void>(without_links(real / "here/x")); }),
            "here: error: is a symbolic link that leads in a circle; name a folder");
}

}  // namespace
}  // namespace glocal::test::atomic_file_test
