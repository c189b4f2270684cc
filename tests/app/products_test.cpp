// Experiments of methods and cases by their names, without a file.
#include <gmock/gmock.h>

#include "app/room.hpp"

namespace glocal::test::products_command_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class ProductsCommand : public Room {
 protected:
  ProductsCommand() {
    folder_.write("few.yaml", "localizer: {matcher: {ransam: {iterations: 5000}}}\n");
    folder_.write("many.yaml", "extends: few.yaml\nlocalizer: {matcher: {ransam: {iterations: 20000}}}\n");
    folder_.write("small_room.yaml",
                  "map: {simulation: {world: world.yaml}}\n"
                  "observations: {simulation: {world: world.yaml}}\n"
                  "trials: {every_scan: 6, max_steps: 5}\n");
  }

  [[nodiscard]] std::string case_option() const { return " --case " + file("small_room.yaml") + " "; }
};

TEST_F(ProductsCommand, RunLeavesAFolderForEachMethodCaseAndSeed) {
  const std::string out = "results";
  good(run("run --quiet --method few.yaml --method many.yaml" + case_option() + "--seeds 1..2 --out " + out));
  for (const char* name : {"few_small_room_seed-1", "few_small_room_seed-2", "many_small_room_seed-1",
                           "many_small_room_seed-2"}) {
    const Json provenance = Json::parse(content(out + "/" + name + "/provenance.json"));
    const std::string method = provenance["variant"]["values"]["method"];
    EXPECT_EQ(provenance["variant"]["case"], "small_room");
    EXPECT_THAT(std::string(name), testing::StartsWith(method));
  }
  EXPECT_THAT(content(out + "/many_small_room_seed-2/effective.yaml"), HasSubstr("20000"));
}

TEST_F(ProductsCommand, ARunIsCalledComparisonUnlessItIsSaidOtherwise) {
  const std::string command = "run --quiet --method few.yaml" + case_option();
  good(run(command + "--out a"));
  EXPECT_EQ(json("a/few_small_room/summary.json")["name"], "comparison");
  good(run(command + "--set name=mine --out b"));
  EXPECT_EQ(json("b/few_small_room/summary.json")["name"], "mine");
}

TEST_F(ProductsCommand, JobsAreGivenTheNamesToo) {
  const Answer answer = good(run("submit --parallel --dry-run --shards 2 --method " + file("few.yaml") +
                                 case_option() + "--seeds 1..2 --out shared"));
  EXPECT_THAT(answer.out,
              HasSubstr(" run --method " + file("few.yaml") + case_option() + "--seeds 1..2 --shard"));
}

TEST_F(ProductsCommand, AFileThatLacksOnlyAMethodIsGivenOne) {
  folder_.write(
      "lacks.yaml",
      "schema: 1\nname: lacks\ncases: [small_room.yaml]\nevaluation: {max_translation_error: 0.4}\n");
  good(run("check lacks.yaml --method few.yaml"));
}

TEST_F(ProductsCommand, HalfAnExperimentIsRefused) {
  EXPECT_THAT(refusal(run("run --method indexed --out results")),
              HasSubstr("Give an experiment file, or --method and --case"));
}

TEST_F(ProductsCommand, FilesOfOtherKindsAreNamed) {
  folder_.write("plan.yaml", "image: plan.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
  const auto fault_of = [&](const std::string& arguments) {
    const Answer answer = run(arguments);
    EXPECT_EQ(answer.exit_code, 2) << arguments;
    EXPECT_THAT(answer.err, testing::EndsWith("\n1 error\n")) << arguments;
    return answer.err;
  };
  EXPECT_THAT(fault_of("simulate plan.yaml --out drive"),
              HasSubstr("plan.yaml: error: is a map, as a map server reads it, and no experiment"));
  EXPECT_THAT(fault_of("check world.yaml"), HasSubstr("is a simulated world, and no experiment"));
  EXPECT_THAT(fault_of("run " + file("small_room.yaml")),
              HasSubstr("no experiment: --case " + file("small")));
  EXPECT_THAT(fault_of("run " + file("few.yaml")), HasSubstr("no experiment: --method " + file("few.yaml")));
}

TEST_F(ProductsCommand, AMethodInPlaceOfAMatcherIsNamed) {
  const std::string said = refusal(run("check room.yaml --set localizer.matcher=indexed"));
  EXPECT_THAT(said, HasSubstr("unknown matcher 'indexed', did you mean 'indexed_ransam'?"));
  EXPECT_THAT(said, HasSubstr("; 'indexed' is a method: --method indexed\n"));
}

TEST_F(ProductsCommand, TheLikeOfAMatcherInSpaceIsNamedAndThatInThePlane) {
  const auto fault_of = [&](const std::string& localizer) {
    folder_.write("method.yaml", "localizer:\n  {" + localizer + "}\n");
    std::string said = refusal(run("check --method method.yaml --case small_room.yaml"));
    EXPECT_THAT(said, testing::EndsWith("\n1 error\n"));
    return said;
  };
  EXPECT_THAT(
      fault_of("matcher: indexed_ransam, motion: free, local_mapper: odometry"),
      HasSubstr("method.yaml:2:13: error: localizer: matcher: the matcher 'indexed_ransam' can do the motion "
                "planar, not free; set localizer.motion to planar, or take surfel_ransam\n"));
  EXPECT_THAT(fault_of("matcher: triangle_ransam"), HasSubstr("to upright or free, or take ransam\n"));
  EXPECT_THAT(
      fault_of("matcher: {indexed_ransam: {space: {rounds: 4}}}"),
      HasSubstr(
          "method.yaml:2:31: error: localizer.matcher.indexed_ransam: key 'space' was removed: in space "
          "the matcher surfel_ransam searches, which has these keys itself\n"));
}

TEST_F(ProductsCommand, TheSameWarningComesOnce) {
  folder_.write("map.pgm", std::string("P5\n3 2\n255\n") + std::string("\x00\xfe\xfe\xfe\xcd\x00", 6));
  for (const char* name : {"one.yaml", "two.yaml"})
    folder_.write(name,
                  "map: {ros_map: {path: map.yaml}}\n"
                  "observations: {simulation: {world: world.yaml}}\ntrials: {every_scan: 6}\n");
  folder_.write("map.yaml",
                "image: map.pgm\nresolution: 0.1\norigin: [0, 0, .nan]\nnegate: 0\n"
                "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const Answer answer = run("check --method few.yaml --case one.yaml --case two.yaml");
  const std::string warning = "the origin's yaw is NaN, and is taken as 0";
  const std::size_t first = answer.err.find(warning);
  ASSERT_NE(first, std::string::npos) << answer.err;
  EXPECT_EQ(answer.err.find(warning, first + 1), std::string::npos) << answer.err;
}

TEST_F(ProductsCommand, CheckTellsWhatAStepHasTimeFor) {
  const std::string check = "check --method indexed --case paper_lab --budget-ms ";
  EXPECT_THAT(
      good(run(check + "30")).out,
      ContainsRegex("1 trials; 30 ms of searches a step are localizer.looks_per_step=[0-9]+ here\n$"));
  EXPECT_THAT(good(run("check --method paper" + case_option() + "--budget-ms 30")).out,
              HasSubstr("trials; no search of its first trials is long enough to be timed\n"));
  EXPECT_THAT(refusal(run(check + "0")), HasSubstr("--budget-ms: "));
}

TEST_F(ProductsCommand, ListTellsWhatIsBuiltIn) {
  EXPECT_THAT(run("list methods").out, HasSubstr("\nlidar_free "));
  const Json cases = Json::parse(run("list cases --json").out);
  const auto intel =
      std::find_if(cases.begin(), cases.end(), [](const Json& c) { return c["name"] == "intel"; });
  ASSERT_NE(intel, cases.end());
  EXPECT_THAT((*intel)["about"].get<std::string>(), HasSubstr("Intel Research Lab"));
}

}  // namespace
}  // namespace glocal::test::products_command_test
