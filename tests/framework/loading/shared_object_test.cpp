#include "loading/shared_object.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "temporary_folder.hpp"

namespace glocal::test::shared_object_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path good = fs::path(GLOCAL_TEST_PLUGINS) / "every_kind.so";

std::string why_not(const fs::path& file) {
  return why_no_shared_object(file).value_or("");
}

TEST(SharedObject, AWholeOneIsAccepted) {
  EXPECT_EQ(why_not(good), "");
}

TEST(SharedObject, APlaceWithoutAFileAFolderAndTextAreNone) {
  const TemporaryFolder folder;
  EXPECT_THAT(why_not(folder.path() / "none.so"), HasSubstr("no such file"));
  EXPECT_THAT(why_not(folder.path()), HasSubstr("folder"));
  std::ofstream(folder.path() / "text.so") << std::string(1000, 'a');
  EXPECT_THAT(why_not(folder.path() / "text.so"), HasSubstr("not a shared object"));
  std::ofstream(folder.path() / "empty.so").flush();
  EXPECT_THAT(why_not(folder.path() / "empty.so"), HasSubstr("not a shared object"));
}

/// Of a good one that has another byte in this place.
std::string why_not_with(std::streamoff place, char byte) {
  const TemporaryFolder folder;
  fs::copy(good, folder / "other.so");
  std::fstream(folder / "other.so", std::ios::in | std::ios::out | std::ios::binary).seekp(place).put(byte);
  return why_not(folder / "other.so");
}

TEST(SharedObject, AProgramIsNone) {
  // A program that may be loaded anywhere has the type of a shared object; an object file has not.
  constexpr std::streamoff e_type = 16;
  constexpr char object_file = 1;
  EXPECT_THAT(why_not_with(e_type, object_file), HasSubstr("not a shared object"));
}

TEST(SharedObject, OneForAnotherProcessorIsNone) {
  constexpr std::streamoff e_machine = 18;
  constexpr char arm = 0x28;
  EXPECT_THAT(why_not_with(e_machine, arm), HasSubstr("another kind of processor"));
}

TEST(SharedObject, ATruncatedOneIsSeenWhereverItWasCut) {
  const TemporaryFolder folder;
  const fs::path cut = folder.path() / "cut.so";
  const auto size = fs::file_size(good);
  for (const double share : {0.003, 0.01, 0.2, 0.5}) {
    fs::copy(good, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_NE(why_not(cut), "") << share;
  }
}

}  // namespace
}  // namespace glocal::test::shared_object_test
