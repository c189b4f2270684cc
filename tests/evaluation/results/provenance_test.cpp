#include "evaluation/results/provenance.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "files.hpp"
#include "glocal/error.hpp"
#include "matchers/register.hpp"

namespace glocal::test::provenance_test {
namespace {

TEST(Sha256, AgreesWithPublishedDigests) {
  // FIPS 180-4 examples: "abc", nothing, and a million times "a", which is longer than any buffer.
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.write("empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(folder.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, NamesAFileItCannotRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of<RunError>([&] { return sha256_of_file(folder / "nothing"); }),
            (folder / "nothing").string() + ": cannot read");
}

TEST(Provenance, SaysWhereResultsComeFrom) {
  const TemporaryFolder folder;
  const auto input = folder.write("abc", "abc");
  Catalog catalog;
  register_matchers(catalog);
  FileHashes hashes;
  const nlohmann::ordered_json json = provenance(catalog, 3, {input}, hashes);
  for (const char* key : {"version", "revision", "compiler", "host", "cpu"}) {
    EXPECT_FALSE(json.at(key).get<std::string>().empty()) << key;
  }
  EXPECT_EQ(json.at("threads"), 3);
  ASSERT_EQ(json.at("inputs_sha256").size(), 1U);
  EXPECT_EQ(json["inputs_sha256"].at(input.string()),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(json.at("plugins").empty());
}

TEST(WhyOtherRun, NamesWhatHasChanged) {
  const TemporaryFolder folder;
  const auto input = folder.write("abc", "abc");
  const auto experiment = folder.write("e.yaml", "first");
  FileHashes hashes;
  auto record = provenance(Catalog(), 1, {input, experiment}, hashes);
  folder.write("effective.yaml", "values");
  std::vector<std::filesystem::path> plugins;
  std::string typed_in = "code";
  const auto why = [&](const std::string& effective) {
    folder.write("provenance.json", record.dump());
    FileHashes now;
    now.tell("the clusterer 'mine'", typed_in);
    return why_other_run(input.parent_path(), effective, {}, experiment, plugins, now).value_or("");
  };
  EXPECT_EQ(why("values"), "");
  EXPECT_EQ(why("other values"), "it is of other values (effective.yaml)");
  folder.write("e.yaml", "with a comment");
  EXPECT_EQ(why("values"), "");
  folder.write("abc", "abd");
  EXPECT_EQ(why("values"), input.string() + " has changed since");
  folder.write("abc", "abc");
  const auto clouds = folder.write("clouds/0.pcd", "").parent_path();
  record["inputs_sha256"][clouds.string()] = hashes.of(clouds);
  folder.write("clouds/0.pcd", "of a file its own hash tells");
  folder.write("clouds/.hidden", "");
  EXPECT_EQ(why("values"), "");
  folder.write("clouds/1.pcd", "");
  EXPECT_EQ(why("values"), clouds.string() + " has changed since");
  std::filesystem::remove(clouds / "1.pcd");
  plugins.emplace_back("the clusterer 'mine'");
  EXPECT_EQ(why("values"), "it is without the clusterer 'mine'");
  record["inputs_sha256"]["the clusterer 'mine'"] = "code";
  EXPECT_EQ(why("values"), "");
  typed_in = "other code";
  EXPECT_EQ(why("values"), "the clusterer 'mine' has changed since");
  typed_in = "code";
  record["program_sha256"]["library"] = "another";
  EXPECT_EQ(why("values"), "it is of another build of the program");
}

TEST(Provenance, SaysWhatAVariantIsOf) {
  Variant variant{.name = "a_intel_seed-3",
                  .experiment = {},
                  .setting = "a",
                  .case_name = "intel",
                  .role = CaseRole::judge,
                  .values = {{"z.b", "5"}, {"c", "[1, x]"}}};
  variant.experiment.seed = 3;
  EXPECT_EQ(origin_json(variant).dump(),
            R"({"setting":"a","seed":3,"case":"intel","role":"judge","values":{"z.b":"5","c":"[1, x]"}})");
  EXPECT_TRUE(origin_json({"", {}}).is_null());
}

TEST(WhyOtherRun, TheSameValuesForAnotherPartAreAnotherRun) {
  const TemporaryFolder folder;
  FileHashes hashes;
  Variant variant{.name = "a", .experiment = {}, .setting = "a", .role = CaseRole::choose};
  auto record = provenance(Catalog(), 1, {}, hashes);
  record["variant"] = origin_json(variant);
  folder.write("provenance.json", record.dump());
  folder.write("effective.yaml", "values");
  const auto why = [&] {
    return why_other_run(folder.path(), "values", origin_json(variant), folder.path() / "e.yaml", {}, hashes)
        .value_or("");
  };
  EXPECT_EQ(why(), "");
  variant.role = CaseRole::judge;
  EXPECT_EQ(why(), "it is of another part of the experiment (provenance.json)");
}

TEST(WhyOtherRun, CommentsAreNoValuesButWhatStandsInQuotesIs) {
  const TemporaryFolder folder;
  FileHashes hashes;
  folder.write("provenance.json", provenance(Catalog(), 1, {}, hashes).dump());
  folder.write("effective.yaml", "epsilon: auto  # 0.1 m here\npath: \"/a  # b\"\n");
  const auto why = [&](const std::string& effective) {
    return why_other_run(folder.path(), effective, {}, folder.path() / "e.yaml", {}, hashes).value_or("");
  };
  EXPECT_EQ(why("epsilon: auto\npath: \"/a  # b\"\n"), "");
  EXPECT_EQ(why("epsilon: auto\npath: \"/a  # c\"\n"), "it is of other values (effective.yaml)");
  EXPECT_EQ(why("epsilon: 0.1\npath: \"/a  # b\"\n"), "it is of other values (effective.yaml)");
}

}  // namespace
}  // namespace glocal::test::provenance_test
