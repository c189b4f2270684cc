// What there is to do: written and read, told apart from other experiments, and the same on all machines.
#include "evaluation/sharding/manifest.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "evaluation/results/file_io.hpp"
#include "files.hpp"
#include "glocal/builtin.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::manifest_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

class ManifestTest : public testing::Test {
 protected:
  ManifestTest() {
    register_builtin_strategies(catalog_);
    write_world(folder_.path(), "");
    write("variants: {list: {a: {}, b: {localizer.matcher.ransam.iterations: 20000}}}\nseeds: [1, 2]\n");
  }

  static void write_world(const fs::path& folder, const std::string& more) {
    std::ofstream(folder / "world.yaml") << "size: [12, 6]\n"
                                            "walls:\n"
                                            "  - {points: [[0, 0], [12, 0], [12, 6], [0, 6]], closed: true}\n"
                                            "free_from: [[1, 1]]\n"
                                            "way_points: [[1, 3], [10, 3]]\n"
                                         << more;
  }

  void write(const std::string& more, const fs::path& folder = {}) const {
    std::ofstream((folder.empty() ? folder_.path() : folder) / "e.yaml")
        << "schema: 1\nname: e\n"
           "map: {simulation: {world: world.yaml}}\n"
           "observations: {simulation: {world: world.yaml}}\n"
           "trials: {every_scan: 4, max_steps: 3}\n"
        << more;
  }

  [[nodiscard]] std::vector<Variant> variants(const std::vector<Override>& overrides = {},
                                              const fs::path& folder = {}) const {
    return read_variants((folder.empty() ? folder_.path() : folder) / "e.yaml", overrides, catalog_);
  }

  [[nodiscard]] Manifest planned(std::vector<Variant> of) const {
    ExperimentLoader loader(catalog_, [](const std::string&) {});
    return plan(of, folder_ / "e.yaml", {}, loader);
  }

  [[nodiscard]] std::vector<Fault> differences_of(const std::vector<Variant>& of,
                                                  const Manifest& there) const {
    FileHashes hashes;
    return differences(there, sketch_of(of, folder_ / "e.yaml", {}, catalog_, hashes), of, catalog_,
                       "shared");
  }

  TemporaryFolder folder_;
  Catalog catalog_;
};

TEST_F(ManifestTest, SaysWhatThereIsToDo) {
  const Manifest manifest = planned(variants());
  ASSERT_THAT(manifest.variants, SizeIs(4));
  EXPECT_EQ(manifest.variants[0].name, "a_seed-1");
  EXPECT_EQ(manifest.variants[3].name, "b_seed-2");
  // 16 scans, 0.6 m apart over 9 m: trials start at 0, 4, 8 and 12, and have three steps each.
  EXPECT_EQ(manifest.starts_of(0), (PlannedStarts{{0, 4, 8, 12}, {3, 3, 3, 3}}));
  EXPECT_EQ(manifest.count_trials(), 16U);
  EXPECT_THAT(manifest.starts, SizeIs(1)) << "the same ones are there once";
  EXPECT_THAT(manifest.inputs, ElementsAre(Pair(fs::canonical(folder_ / "world.yaml").string(), SizeIs(64))));
}

TEST_F(ManifestTest, IsReadAsItWasWritten) {
  const Manifest manifest = planned(variants());
  write_manifest(folder_ / "shared", manifest);
  const Manifest read = read_manifest(folder_ / "shared");
  EXPECT_EQ(read.experiment, "e");
  EXPECT_EQ(read.program, manifest.program);
  EXPECT_EQ(read.inputs, manifest.inputs);
  EXPECT_EQ(read.starts, manifest.starts);
  ASSERT_THAT(read.variants, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.variants[i].identity, manifest.variants[i].identity);
    EXPECT_EQ(read.variants[i].values, manifest.variants[i].values);
    EXPECT_EQ(read.variants[i].origin, manifest.variants[i].origin);
  }
  EXPECT_THAT(differences_of(variants(), read), IsEmpty());
}

TEST_F(ManifestTest, AStartThatIsNoWholeNumberIsRefused) {
  write_manifest(folder_ / "shared", planned(variants()));
  const fs::path file = manifest_file(folder_ / "shared");
  const std::string whole = content_of(file);
  const std::size_t first = whole.find('0', whole.find("\"samples\""));
  ASSERT_NE(first, std::string::npos);
  for (const std::string wrong : {"2.7e48", "-1", "0.5", "\"1\""}) {
    std::ofstream(file) << whole.substr(0, first) << wrong << whole.substr(first + 1);
    EXPECT_THAT(config_error(folder_.path(), [&] { static_cast<void>(read_manifest(folder_ / "shared")); }),
                HasSubstr("is no whole number from 0 on"))
        << wrong;
  }
}

TEST_F(ManifestTest, StartsWithoutStepsAreRefused) {
  write_manifest(folder_ / "shared", planned(variants()));
  const fs::path file = manifest_file(folder_ / "shared");
  auto manifest = nlohmann::ordered_json::parse(content_of(file));
  manifest["starts"][0]["steps"].erase(0);
  std::ofstream(file) << manifest;
  EXPECT_THAT(config_error(folder_.path(), [&] { static_cast<void>(read_manifest(folder_ / "shared")); }),
              HasSubstr("there are not as many steps as samples"));
}

TEST_F(ManifestTest, TheSameTrialHasTheSameIdentityWhereverItsFilesLie) {
  const Manifest here = planned(variants());
  const fs::path elsewhere = folder_ / "elsewhere";
  fs::create_directories(elsewhere);
  write_world(elsewhere, "");
  write("variants: {list: {other_name: {}}}\nseeds: [1]\n", elsewhere);
  const Manifest there = planned(variants({{"threads", "3"}}, elsewhere));
  EXPECT_EQ(there.variants[0].identity, here.variants[0].identity);
  EXPECT_EQ(there.id_of(0, 2), here.id_of(0, 2));

  write_world(elsewhere, "# a change\n");
  EXPECT_NE(planned(variants({}, elsewhere)).variants[0].identity, here.variants[0].identity);
}

TEST_F(ManifestTest, WhateverResultsFollowFromMakesAnotherIdentity) {
  const Manifest manifest = planned(variants());
  std::set<std::string> identities;
  for (const PlannedVariant& variant : manifest.variants) identities.insert(variant.identity);
  EXPECT_THAT(identities, SizeIs(4));
  const Manifest other = planned(variants({{"evaluation.max_translation_error", "0.4"}}));
  EXPECT_FALSE(identities.contains(other.variants[0].identity));
  const std::string& a = manifest.variants[0].identity;
  EXPECT_NE(trial_id(a, 0, 0), trial_id(a, 1, 0)) << "trials have random numbers of their own";
  EXPECT_NE(trial_id(a, 0, 0), trial_id(a, 0, 4));
}

TEST_F(ManifestTest, DifferencesAreNamed) {
  const Manifest manifest = planned(variants());
  const auto faults = differences_of(variants({{"localizer.rater", "softmax"}}), manifest);
  ASSERT_THAT(faults, SizeIs(4));
  EXPECT_EQ(faults[0].file, "shared");
  EXPECT_THAT(faults[0].message, HasSubstr("variant 'a_seed-1': localizer.rater"));

  Manifest of_another_program = manifest;
  of_another_program.program["program_sha256"]["library"] = "0";
  const auto of_program = differences_of(variants(), of_another_program);
  ASSERT_THAT(of_program, SizeIs(1));
  EXPECT_THAT(of_program[0].message, HasSubstr("by another build of the program"));

  write("variants: {list: {a: {}}}\nseeds: [1, 2]\n");
  const auto of_fewer = differences_of(variants(), manifest);
  ASSERT_THAT(of_fewer, SizeIs(2));
  EXPECT_THAT(of_fewer[0].message, HasSubstr("with a variant 'b_seed-1', which is not here"));
}

TEST_F(ManifestTest, MoreSeedsAreNoDifference) {
  const Manifest manifest = planned(variants());
  write("variants: {list: {a: {}, b: {localizer.matcher.ransam.iterations: 20000}}}\nseeds: 1..3\n");
  EXPECT_THAT(differences_of(variants(), manifest), IsEmpty());
  FileHashes hashes;
  EXPECT_TRUE(has_more_variants(manifest, sketch_of(variants(), "e.yaml", {}, catalog_, hashes)));
  EXPECT_EQ(planned(variants()).variants[0].identity, manifest.variants[0].identity);
}

}  // namespace
}  // namespace glocal::test::manifest_test
