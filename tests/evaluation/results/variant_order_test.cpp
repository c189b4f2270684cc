#include "evaluation/results/variant_order.hpp"

#include <gmock/gmock.h>

#include "temporary_folder.hpp"

namespace glocal::test::variant_order_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

TEST(IsBefore, CountsNumbersAsNumbers) {
  EXPECT_TRUE(is_before("angle-5", "angle-10"));
  EXPECT_TRUE(is_before("cell-0.05_n-3", "cell-0.1_n-2"));
  EXPECT_TRUE(is_before("n-1000_a", "n-1000_b"));
  EXPECT_TRUE(is_before("n-2", "n-2_more"));
  EXPECT_TRUE(is_before("a", "b"));
  EXPECT_TRUE(is_before("", "a"));
}

TEST(IsBefore, IsAnOrder) {
  const std::vector<std::string> names = {"",     "a",   "a-1",  "a-1.0", "a-01", "a-1e3",
                                          "a-1x", "a-2", "a-10", "b",     "1",    "a-"};
  for (const std::string& a : names) {
    EXPECT_FALSE(is_before(a, a)) << a;
    for (const std::string& b : names) {
      EXPECT_EQ(is_before(a, b), a != b && !is_before(b, a)) << a << " " << b;
    }
  }
}

class VariantOrder : public testing::Test {
 protected:
  /// Names in the order they are sorted to.
  std::vector<std::string> sorted(const std::vector<std::string>& names) {
    std::vector<fs::path> folders;
    for (const std::string& name : names) folders.push_back(folder_.path() / name);
    sort_by_variant(folder_.path(), folders);
    std::vector<std::string> result;
    for (const fs::path& folder : folders) result.push_back(folder.filename().string());
    return result;
  }
  TemporaryFolder folder_;
};

TEST_F(VariantOrder, IsThatOfTheFile) {
  write_variant_order(folder_.path(), {"paper", "mine", "exact"});
  EXPECT_THAT(sorted({"exact", "mine", "paper"}), ElementsAre("paper", "mine", "exact"));
  EXPECT_THAT(sorted({"exact", "n-10", "n-9", "paper"}), ElementsAre("paper", "exact", "n-9", "n-10"));
  write_variant_order(folder_.path(), {"exact", "paper"});
  EXPECT_THAT(sorted({"paper", "exact"}), ElementsAre("exact", "paper"));
}

TEST_F(VariantOrder, IsByNameWithoutOne) {
  EXPECT_THAT(sorted({"n-10", "n-9", "a"}), ElementsAre("a", "n-9", "n-10"));
  for (const char* damaged : {"", "[1, 2", "{}", "[1]"}) {
    folder_.write("variants.json", damaged);
    EXPECT_THAT(sorted({"b", "a"}), ElementsAre("a", "b")) << damaged;
  }
}

}  // namespace
}  // namespace glocal::test::variant_order_test
