// How much memory the program takes.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/program.hpp"

namespace glocal::test::memory_test {
namespace {

class Memory : public CommandLine {
 protected:
  /// The most that it has had at once, MB.
  [[nodiscard]] long peak(const std::string& arguments) const {
    const std::string command = "exec " GLOCAL_PROGRAM " " + arguments + " >" + file("said");
    const pid_t child = fork();
    if (child == 0) {
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    EXPECT_EQ(wait4(child, &status, 0, &usage), child);
    EXPECT_EQ(status, 0);
    return usage.ru_maxrss / 1024;
  }
};

// What a computer on a robot has left besides everything else.
TEST_F(Memory, LocalizeTakes150MBInAnOfficeOf100MetresAtMost) {
#ifdef GLOCAL_MORE_MEMORY
  GTEST_SKIP() << "sanitizers and emulators take memory of their own";
#endif
  good(run("simulate --site office --side 100 --length 20 --starts 1 --out office"));
  EXPECT_LE(peak("localize office/map.yaml office/drive.log --out answer"), 150);
  EXPECT_THAT(content("said"), testing::HasSubstr("localized after "));
}

}  // namespace
}  // namespace glocal::test::memory_test
