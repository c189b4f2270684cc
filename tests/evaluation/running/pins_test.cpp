// What a suite pins of its inputs.
#include "evaluation/running/pins.hpp"

#include <gmock/gmock.h>

#include "files.hpp"

namespace glocal::test::pins_test {
namespace {

using testing::HasSubstr;

class Pins : public testing::Test {
 protected:
  Pins() {
    suite_.name = "small";
    suite_.file = folder_.path() / "suites/small.yaml";
    suite_.is_pinned = true;
    suite_.cases = {{"room", "", 2}};
    map_ = folder_.write("map.pgm", "a map");
    suite_.inputs = input_hashes(suite_, {map_}, hashes_);
    loaded_.inputs = {map_};
    loaded_.all_starts = 2;
  }

  std::string fault() {
    Variant variant;
    variant.case_name = "room";
    variant.suite = std::make_shared<const Suite>(suite_);
    FileHashes fresh;
    return error_of([&] { check_pins(variant, loaded_, fresh); });
  }

  TemporaryFolder folder_;
  FileHashes hashes_;
  Suite suite_;
  LoadedExperiment loaded_;
  std::filesystem::path map_;
};

// As sha256sum prints it.
TEST_F(Pins, AFileHasItsOwnHash) {
  const auto inputs = input_hashes(suite_, {folder_.write("empty", "")}, hashes_);
  EXPECT_EQ(inputs.at("../empty"), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_F(Pins, ManyFilesOfAFolderHaveOne) {
  std::set<std::filesystem::path> scans;
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) scans.insert(folder_.write(name, name));
  const auto before = input_hashes(suite_, scans, hashes_);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before.begin()->first, "../");
  scans.insert(folder_.path());
  EXPECT_EQ(input_hashes(suite_, scans, hashes_), before);
  folder_.write("b.pcd", "another scan");
  FileHashes fresh;
  EXPECT_NE(input_hashes(suite_, scans, fresh), before);
}

TEST_F(Pins, WhatIsAsPinnedIsTaken) {
  EXPECT_EQ(fault(), "");
}

TEST_F(Pins, OtherInputsAndOtherStartsAreRefused) {
  loaded_.all_starts = 3;
  EXPECT_THAT(fault(), HasSubstr("the case room has 3 starts with seed 1, and 2 are pinned"));
  folder_.write("map.pgm", "another map");
  EXPECT_THAT(fault(), HasSubstr("and " + suite_.inputs.at("../map.pgm") + " is pinned in "));
  suite_.inputs.clear();
  EXPECT_THAT(fault(), HasSubstr(", and none is pinned in "));
  suite_.is_pinned = false;
  EXPECT_EQ(fault(), "");
}

}  // namespace
}  // namespace glocal::test::pins_test
