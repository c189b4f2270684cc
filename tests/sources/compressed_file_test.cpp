#include "sources/compressed_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <sstream>

#include "files.hpp"

namespace glocal::compressed_file_test {
namespace {

template <class Compressor>
std::string compressed(const std::string& text) {
  std::ostringstream out;
  boost::iostreams::filtering_ostream filter;
  filter.push(Compressor());
  filter.push(out);
  filter << text;
  filter.reset();
  return out.str();
}

/// Something that does not compress to nothing.
std::string some_text() {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += fmt::format("{}{}", (i * 7919) % 104729, i % 12 == 0 ? '\n' : ' ');
  return text;
}

struct Format {
  const char* name;
  std::string (*compress)(const std::string&);
};

class CompressedFile : public testing::TestWithParam<Format> {};

TEST_P(CompressedFile, IsKnownByItsContent) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_decompressed(folder.write("odd_name.txt", GetParam().compress(some_text()))), some_text());
}

TEST_P(CompressedFile, IsRefusedWhenCutOffAnywhere) {
  const test::TemporaryFolder folder;
  const std::string whole = GetParam().compress(some_text());
  for (const std::size_t missing :
       {std::size_t{1}, std::size_t{5}, std::size_t{20}, whole.size() / 2, whole.size() - 8}) {
    const auto file = folder.write("a.log", whole.substr(0, whole.size() - missing));
    EXPECT_EQ(test::config_error(file.parent_path(), [&] { static_cast<void>(read_decompressed(file)); }),
              fmt::format("a.log: error: the {} data is damaged or ends early; get a fresh copy of the file",
                          GetParam().name))
        << missing;
  }
}

TEST_P(CompressedFile, IsRefusedWhereItDecompressesToMoreThanTheLimit) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("bomb.log", GetParam().compress(std::string(3'000'000, '0')));
  EXPECT_EQ(read_decompressed(file, 0.003).size(), 3'000'000U);
  EXPECT_EQ(
      test::config_error(file.parent_path(), [&] { static_cast<void>(read_decompressed(file, 0.0029)); }),
      "bomb.log: error: has more than 0.0029 GB (decompressed, if it is compressed); if it is the right "
      "file, thin it out, or take a part of it");
}

INSTANTIATE_TEST_SUITE_P(Formats, CompressedFile,
                         testing::Values(Format{"gzip", compressed<boost::iostreams::gzip_compressor>},
                                         Format{"bzip2", compressed<boost::iostreams::bzip2_compressor>},
                                         Format{"xz", compressed<boost::iostreams::lzma_compressor>}),
                         [](const auto& format) { return format.param.name; });

TEST(PlainFile, IsReadAsItIs) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_decompressed(folder.write("a.gz", "plain\n")), "plain\n");
  EXPECT_EQ(read_decompressed(folder.write("empty", "")), "");
}

TEST(PlainFile, IsRefusedWhereItIsLargerThanTheLimit) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.log", std::string(1001, 'x'));
  EXPECT_EQ(test::config_error(file.parent_path(), [&] { static_cast<void>(read_decompressed(file, 1e-6)); })
                .substr(0, 41),
            "a.log: error: has more than 1e-06 GB (dec");
  EXPECT_EQ(read_decompressed(file, 1.001e-6).size(), 1001U);
}

TEST(PlainFile, IsRefusedWhereThereIsNone) {
  const test::TemporaryFolder folder;
  const auto message = [&](const std::filesystem::path& file) {
    return test::config_error(file.parent_path(), [&] { static_cast<void>(read_decompressed(file)); });
  };
  EXPECT_EQ(message(folder / "missing.log"),
            "missing.log: error: cannot be opened: No such file or directory");
  std::filesystem::create_directory(folder / "sub");
  EXPECT_EQ(message(folder / "sub"), "sub: error: is a folder; a file is needed");
}

}  // namespace
}  // namespace glocal::compressed_file_test
