// glocal register.
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/program.hpp"
#include "evaluation/results/pcd.hpp"
#include "matchers/surfels/scanned_hall.hpp"

namespace glocal::test::register_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const Pose3 here({5.0, 4.5, 1.2}, turn_about_z(0.3));
const Pose3 there({6.5, 3.0, 1.0}, exponential({0.1, -0.2, 2.0}));

class RegisterCommand : public CommandLine {
 protected:
  RegisterCommand() {
    std::ofstream(file("source.pcd"), std::ios::binary) << pcd(scan_of(hall(), there));
    std::ofstream(file("target.pcd"), std::ios::binary) << pcd(scan_of(hall(), here));
  }

  /// "tx,ty,…" of the true pose.
  [[nodiscard]] static std::string truth() {
    const Pose3 pose = inverse(here) * there;
    const Quaternion& q = pose.rotation;
    std::ostringstream text;
    text << pose.x << ',' << pose.y << ',' << pose.z << ',' << q.x() << ',' << q.y() << ',' << q.z() << ','
         << q.w();
    return text.str();
  }
};

TEST_F(RegisterCommand, SaysThePoseAndJoinsTheClouds) {
  const Answer answer = good(run("register source.pcd target.pcd -o both.pcd"));
  EXPECT_THAT(answer.out, StartsWith("match: score "));
  EXPECT_THAT(answer.out, HasSubstr("quaternion x y z w"));
  const Points both = read_pcd("both.pcd");
  const std::size_t n = scan_of(hall(), here).size();
  EXPECT_EQ(both.size(), 2 * n);
  // The source's points lie in the hall, as the target's do.
  for (std::size_t i = n; i < both.size(); i += 97) {
    const Vector3 p = here * Vector3{both.x[i], both.y[i], both.z[i]};
    EXPECT_GT(p.z(), -0.1);
    EXPECT_LT(p.z(), 4.1);
    EXPECT_GT(p.x(), -0.1);
    EXPECT_LT(p.x(), 14.1);
  }
  EXPECT_THAT(refusal(run("register source.pcd target.pcd -o both.pcd")),
              HasSubstr("both.pcd: error: the file exists; choose another name, or replace it with --force"));
}

TEST_F(RegisterCommand, MakesATableOfPairs) {
  std::ofstream("pairs.csv") << "source,target,tx,ty,tz,qx,qy,qz,qw,class\nsource.pcd,target.pcd," << truth()
                             << ",easy\nsource.pcd,target.pcd,1,2,3,0,0,0,1,odd\n";
  const Answer table = good(run("register --pairs pairs.csv"));
  EXPECT_THAT(table.out, HasSubstr("easy              1        1       1          0 of 1          0 of 0"));
  EXPECT_THAT(table.out, HasSubstr("odd               1        1       0          0 of 0          1 of 1"));
  EXPECT_THAT(table.out, HasSubstr("all               2        2       1"));

  const Answer lines = run("register --json --pairs pairs.csv");
  std::istringstream in(lines.out);
  std::string line;
  std::size_t n = 0;
  for (; std::getline(in, line); ++n) {
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json["source"], "source.pcd");
    EXPECT_EQ(json["verdict"], "match");
    EXPECT_EQ(json["target_from_source"]["translation"].size(), 3U);
    EXPECT_EQ(json["target_from_source"]["quaternion"].size(), 4U);
    EXPECT_GT(json["overlap"].get<double>(), 0.5);
    EXPECT_GT(json["cpu_s"].get<double>(), 0.0);
  }
  EXPECT_EQ(n, 2U);
}

TEST_F(RegisterCommand, ComparesMethodsByName) {
  std::ofstream("pairs.csv") << "source,target\nsource.pcd,target.pcd\n";
  const Answer unnamed = run("register --json --pairs pairs.csv");
  EXPECT_FALSE(nlohmann::json::parse(unnamed.out).contains("method"));
  const Answer named = good(run("register --json --method surfel_pairs --pairs pairs.csv"));
  auto json = nlohmann::json::parse(named.out);
  EXPECT_EQ(json["method"], "surfel_pairs");
  EXPECT_EQ(json["target_from_source"], nlohmann::json::parse(unnamed.out)["target_from_source"]);
  const Answer table = run("register --method surfel_pairs,surfel_pairs --pairs pairs.csv");
  EXPECT_THAT(table.out, StartsWith("surfel_pairs\nclass "));
  EXPECT_THAT(table.out, HasSubstr("\n\nsurfel_pairs\nclass "));

  const std::string clouds = "source.pcd target.pcd";
  EXPECT_THAT(run("register --method surfel_pairs " + clouds).out, StartsWith("surfel_pairs\nmatch: "));
  EXPECT_THAT(refusal(run("register --method surfel_pair " + clouds)),
              HasSubstr("there is no cloud registrar 'surfel_pair' (did you mean 'surfel_pairs'?)"));
  EXPECT_THAT(run("register --method surfel_pairs,surfel_pairs " + clouds + " --out both.pcd").err,
              HasSubstr("--out takes the pose of one method"));
}

TEST_F(RegisterCommand, SetsTheParametersOfItsMethods) {
  const std::string clouds = "source.pcd target.pcd";
  const std::string plugin = " --plugin " + std::string(GLOCAL_TEST_PLUGINS) + "/every_kind.so ";
  const auto x_of = [&](const std::string& options) {
    const Answer answer = good(run("register --json --method ahead " + clouds + plugin + options));
    return nlohmann::json::parse(answer.out)["target_from_source"]["translation"][0].get<double>();
  };
  EXPECT_EQ(x_of(""), 1.0);
  EXPECT_EQ(x_of("--set ahead.by=2.5"), 2.5);
  EXPECT_EQ(x_of("--set ahead.by=2.5 --set ahead.by=3"), 3.0);
  // Those of one method leave another alone.
  const std::string both = "register --method surfel_pairs,ahead " + clouds + plugin;
  const Answer answer = good(run(both + "--json --set ahead.by=2.5"));
  const auto own = nlohmann::json::parse(answer.out.substr(0, answer.out.find('\n')));
  const auto unset = nlohmann::json::parse(run("register --json " + clouds).out);
  EXPECT_EQ(own["target_from_source"], unset["target_from_source"]);

  const auto fault = [&](const std::string& options) {
    const Answer refused = run("register " + clouds + plugin + options);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.out, "");
    return refused.err;
  };
  EXPECT_THAT(fault("--method ahead --set ahead.bye=2"),
              HasSubstr("--set ahead.bye=2: error: ahead: unknown key 'bye' (did you mean 'by'?)"));
  EXPECT_THAT(fault("--method ahead --set ahead.by=-2"),
              HasSubstr("--set ahead.by=-2: error: ahead: by: -2 is out of range"));
  EXPECT_THAT(fault("--method ahead --set ahead=2"), HasSubstr("--set ahead=2: error: ahead"));
  EXPECT_THAT(fault("--method ahead --set ahed.by=2"),
              HasSubstr("--set ahed.by=2: error: unknown key 'ahed' (did you mean 'ahead'?)"));
  // It is not asked for.
  EXPECT_THAT(fault("--set ahead.by=2"),
              HasSubstr("--set ahead.by=2: error: unknown key 'ahead' (known keys: surfel_pairs)"));
  EXPECT_THAT(fault("--method ahead --set ahead.by"), HasSubstr("not of the form path=value"));
}

TEST_F(RegisterCommand, NamesAllFaultsOfAList) {
  std::ofstream("pairs.csv") << "source,target,tx,ty,tz,qx,qy,qz,qw\nsource.pcd,none.pcd,1,2,3,0,0,0,1\n"
                             << "source.pcd,target.pcd,1,2,3,0,0,0,2\nsource.pcd\n"
                             << "source.pcd,target.pcd,1,b,3,0,0,0,1\n";
  const Answer answer = run("register --pairs pairs.csv");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("pairs.csv:2: error: no such file: "));
  EXPECT_THAT(answer.err,
              HasSubstr("pairs.csv:3: error: the quaternion (qx qy qz qw) has the length 2.0000"));
  EXPECT_THAT(answer.err, HasSubstr("pairs.csv:4: error: there are 1 values for 9 columns"));
  EXPECT_THAT(answer.err, HasSubstr("pairs.csv:5: error: ty: 'b' is no number"));
  EXPECT_EQ(answer.out, "");
}

TEST_F(RegisterCommand, RefusesWhatItCannotDo) {
  EXPECT_EQ(run("register source.pcd").exit_code, 2);
  EXPECT_EQ(run("register --pairs p.csv source.pcd").exit_code, 2);
  std::ofstream("p.csv") << "a,b\n1,2\n";
  EXPECT_THAT(run("register --pairs p.csv").err, HasSubstr("there is no column 'source'"));
  std::ofstream("p.csv") << "\xEF\xBB\xBFsource,target,x,ty,tz,qx,qy,qz,qw\n";
  EXPECT_THAT(
      refusal(run("register --pairs p.csv")),
      HasSubstr("p.csv:1: error: a pose has the columns tx, ty, tz, qx, qy, qz, qw: give all of them"));
  std::ofstream("bad.pcd") << "VERSION 0.7\nFIELDS x y z\n";
  EXPECT_EQ(run("register bad.pcd source.pcd").exit_code, 2);
  const std::string both = "register source.pcd source.pcd";
  EXPECT_THAT(refusal(run(both + " -o out.ply")), HasSubstr("out.ply: error: the name must end in .pcd"));
  EXPECT_EQ(run(both + " --seed -1").exit_code, 2);
  EXPECT_EQ(run(both + " --voxel-size 4e38").exit_code, 2);
}

TEST_F(RegisterCommand, IsRightOnRealAndSimulatedPairs) {
  const char* const datasets = std::getenv("GLOCAL_DATASETS");
  if (datasets == nullptr) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const Answer lines = run(std::string("register --json --pairs ") + datasets + "/lidar3d/pairs.csv");
  std::istringstream in(lines.out);
  std::size_t pairs = 0;
  std::size_t right = 0;
  for (std::string line; std::getline(in, line); ++pairs) {
    if (nlohmann::json::parse(line)["right"].get<bool>()) ++right;
  }
  EXPECT_EQ(pairs, 40U);
  EXPECT_GE(right, 33U);  // the easy ones, 14 of 16 middle and 4 of 9 hard ones
}

}  // namespace
}  // namespace glocal::test::register_test
