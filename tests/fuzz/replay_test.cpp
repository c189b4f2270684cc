// Every input of every corpus, as the fuzzers read it: what has once been found stays mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/fuzzers.hpp"

namespace glocal::test::replay_test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus_of(const std::string& name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(GLOCAL_SOURCE_DIR) / "tests/fuzz/corpus" / name))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Corpus : public testing::TestWithParam<fuzz::Fuzzer> {};

TEST_P(Corpus, IsReadOrRefused) {
  const std::vector<fs::path> files = corpus_of(GetParam().name);
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    const std::string input = content_of(file);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_NO_THROW(GetParam().run(reinterpret_cast<const std::uint8_t*>(input.data()), input.size()));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(fuzz::fuzzers),
                         [](const auto& fuzzer) { return std::string(fuzzer.param.name); });

}  // namespace
}  // namespace glocal::test::replay_test
