#include "evaluation/running/others_load.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace glocal::test::others_load_test {
namespace {

TEST(OthersLoad, SaysNothingTooSoon) {
  EXPECT_EQ(OthersLoad().mean(), std::nullopt);
}

TEST(OthersLoad, DoesNotCountThisProcess) {
  const OthersLoad quiet;
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  const OthersLoad busy;
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(1100);
  while (std::chrono::steady_clock::now() < end) {
  }
  const auto alone = quiet.mean();
  const auto beside = busy.mean();
  if (!alone || !beside) GTEST_SKIP() << "the system does not tell";
  // Others may come and go, but there are no more processors than there are.
  EXPECT_GE(*beside, 0.0);
  EXPECT_LE(*beside, std::thread::hardware_concurrency());
}

}  // namespace
}  // namespace glocal::test::others_load_test
