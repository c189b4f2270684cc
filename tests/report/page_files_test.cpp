#include "report/page_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "evaluation/results/file_io.hpp"
#include "files.hpp"
#include "glocal/error.hpp"
#include "report/packed.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::page_files_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

class PageFilesTest : public testing::Test {
 protected:
  static PageData page(const std::string& word) {
    PageData data{{{"maps", Json::array()}, {"runs", Json::array()}}};
    data.chunks = {packed({{"columns", word}}), packed({{"columns", word + word}})};
    return data;
  }

  void write(const PageData& data, std::size_t most_bytes, bool replace = true) const {
    write_page(folder_ / "page.html", "page", data, {.most_bytes = most_bytes, .replace = replace});
  }

  [[nodiscard]] std::set<std::string> names(const std::string& of) const {
    std::set<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_ / of, ignored))
      names.insert(entry.path().filename());
    return names;
  }

  [[nodiscard]] PageData written() const { return data_in(content_of(folder_ / "page.html")); }

  TemporaryFolder folder_;
};

TEST_F(PageFilesTest, KeepsStepsInASmallPage) {
  write(page("small"), 10'000'000);
  EXPECT_EQ(written().chunks, page("small").chunks);
  EXPECT_THAT(names(""), testing::ElementsAre("page.html"));
}

TEST_F(PageFilesTest, PutsThoseOfALargeOneBesideIt) {
  write(page("large"), 1000);
  EXPECT_TRUE(written().chunks.empty());
  const std::string name = written().head["beside"]["hash"].get<std::string>() + "_0.js";
  EXPECT_EQ(written().head["beside"]["folder"], "page_steps");
  EXPECT_THAT(names("page_steps"), testing::ElementsAre(name));
  EXPECT_THAT(content_of(folder_ / "page_steps" / name), testing::HasSubstr(page("large").chunks[1]));
}

TEST_F(PageFilesTest, LeavesNothingOfThePageBefore) {
  write(page("first"), 1000);
  const auto first = names("page_steps");
  folder_.write("page_steps/mine.js", "");
  write(page("second"), 1000);
  const auto second = names("page_steps");
  EXPECT_EQ(second.size(), 2U);
  EXPECT_TRUE(second.contains("mine.js"));
  EXPECT_FALSE(second.contains(*first.begin()));
  write(page("third"), 10'000'000);
  EXPECT_THAT(names("page_steps"), testing::ElementsAre("mine.js"));
  fs::remove(folder_ / "page_steps/mine.js");
  write(page("fourth"), 1000);
  write(page("fifth"), 10'000'000);
  EXPECT_FALSE(fs::exists(folder_ / "page_steps"));
}

TEST_F(PageFilesTest, WritesNothingWhereThePageMayNotBeReplaced) {
  folder_.write("page.html", "mine");
  EXPECT_THROW(write(page("other"), 1000, false), ConfigError);
  EXPECT_EQ(content_of(folder_ / "page.html"), "mine");
  EXPECT_THAT(names(""), testing::ElementsAre("page.html"));
}

TEST_F(PageFilesTest, LeavesThePageThatWasThereWhereTheFolderCannotBeWritten) {
  write(page("before"), 10'000'000);
  folder_.write("page_steps", "a file is in the way");
  EXPECT_THROW(write(page("after"), 1000), RunError);
  EXPECT_EQ(written().chunks, page("before").chunks);
  EXPECT_THAT(names(""), testing::ElementsAre("page.html", "page_steps"));
}

}  // namespace
}  // namespace glocal::test::page_files_test
