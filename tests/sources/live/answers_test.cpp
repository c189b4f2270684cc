#include "sources/live/answers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "sources/bags/message_reader.hpp"
#include "sources/bags/messages.hpp"
#include "sources/live/fake_link.hpp"

namespace glocal::test::live::answers_test {
namespace {

using glocal::bags::Connection;
using glocal::bags::MessageReader;
using glocal::bags::RecordedMessage;
using glocal::live::Answers;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;

constexpr std::int64_t stamp = 3'000'000'004;

class Published : public testing::Test {
 protected:
  /// Of the first and only item.
  std::map<std::string, std::string> diagnostics() const {
    std::map<std::string, std::string> values;
    read("/diagnostics", [&](const RecordedMessage& message) {
      MessageReader reader(message);
      reader.skip(8);  // The stamp.
      EXPECT_EQ(reader.text(), "map");
      ASSERT_EQ(reader.count(1), 1U);
      EXPECT_EQ(reader.number<std::uint8_t>(), 0) << "ok";
      EXPECT_EQ(reader.text(), "glocal: localization");
      EXPECT_EQ(reader.text(), "sure");
      EXPECT_EQ(reader.text(), "glocal");
      for (std::size_t n = reader.count(1); n > 0; --n) {
        const std::string key(reader.text());
        values[key] = reader.text();
      }
    });
    return values;
  }
  void tell(const StepResult& result, Answers& answers) {
    link_.published.clear();
    answers.tell(result, stamp, Pose2{1.0, 0.0, 0.0}, 7);
  }
  std::vector<std::string> topics() const {
    std::vector<std::string> topics;
    for (const LiveMessage& message : link_.published) topics.push_back(message.topic.name);
    return topics;
  }
  /// Calls `use` with a message as a reader of recordings has it.
  template <class Use>
  void read(const std::string& topic, Use use) const {
    for (const LiveMessage& message : link_.published) {
      if (message.topic.name != topic) continue;
      const Connection connection{topic, message.topic.type, "cdr", ""};
      return use(RecordedMessage{&connection, 0, message.bytes, {.file = topic}});
    }
    ADD_FAILURE() << "nothing on " << topic;
  }
  static StepResult declared() {
    StepResult result;
    result.verdict = {VerdictKind::localized, Pose2{4.0, 5.0, 0.5}, {}, "sure"};
    result.verdict.estimate = PoseEstimate{Pose2{4.0, 5.0, 0.5}, 0.98, PoseCovariance{1, 2, 3, 4, 5, 6}};
    result.verdict.evidence = {{"margin", 0.25}};
    return result;
  }

  FakeLink link_;
  GlobalMap map_{{}};
};

TEST_F(Published, APoseOnceItIsDeclaredAndTheBestOneAlways) {
  Answers answers(link_, map_, "/robot", {});
  StepResult searching;
  searching.verdict.candidates = {Pose2{1.0, 0.0, 0.0}, Pose2{2.0, 0.0, 0.0}};
  tell(searching, answers);
  EXPECT_THAT(topics(), ElementsAre("/robot/glocal/candidates", "/robot/diagnostics"));
  tell(declared(), answers);
  EXPECT_THAT(topics(), Contains("/robot/initialpose"));
  tell(declared(), answers);
  EXPECT_THAT(topics(), Not(Contains("/robot/initialpose")));
  EXPECT_THAT(topics(), Contains("/robot/glocal/pose"));
  tell(searching, answers);
  tell(declared(), answers);
  EXPECT_THAT(topics(), Contains("/robot/initialpose")) << "declared anew";
  answers.begin_anew();
  tell(declared(), answers);
  EXPECT_THAT(topics(), Contains("/robot/initialpose")) << "another drive";
}

TEST_F(Published, TopicsThatAreAdvertisedBefore) {
  const Answers answers(link_, map_, "/robot", {});
  EXPECT_THAT(link_.advertised, ElementsAre("/robot/initialpose", "/robot/glocal/pose",
                                            "/robot/glocal/candidates", "/robot/diagnostics"));
  const Answers with_tf(link_, map_, "", {.publishes_tf = true});
  EXPECT_THAT(link_.advertised, Contains("/tf"));
  EXPECT_THAT(link_.published, IsEmpty());
}

TEST_F(Published, PoseAndCovarianceAreThoseOfTheMessage) {
  Answers answers(link_, map_, "", {.map = "plan"});
  tell(declared(), answers);
  read("/initialpose", [](const RecordedMessage& message) {
    const auto pose = glocal::bags::read_pose(message);
    EXPECT_EQ(pose.header.stamp_ns, stamp);
    EXPECT_EQ(pose.header.frame, "plan");
    EXPECT_NEAR(pose.pose.x, 4.0, 1e-12);
    EXPECT_NEAR(pose.pose.heading(), 0.5, 1e-12);
    ASSERT_EQ(pose.covariance.size(), 36U);
    EXPECT_EQ(pose.covariance[0], 1.0);
    EXPECT_EQ(pose.covariance[1], 2.0);
    EXPECT_EQ(pose.covariance[6], 2.0);
    EXPECT_EQ(pose.covariance[7], 4.0);
    EXPECT_EQ(pose.covariance[5], 3.0);
    EXPECT_EQ(pose.covariance[11], 5.0);
    EXPECT_EQ(pose.covariance[35], 6.0);
  });
}

TEST_F(Published, DiagnosticsSayTheVerdictAndWhatItRestsOn) {
  Answers answers(link_, map_, "", {});
  tell(declared(), answers);
  const auto values = diagnostics();
  EXPECT_THAT(values, Contains(Pair("verdict", "localized")));
  EXPECT_THAT(values, Contains(Pair("confidence", "0.9800")));
  EXPECT_THAT(values, Contains(Pair("margin", "0.2500")));
  EXPECT_THAT(values, Contains(Pair("passed_over", "7")));
}

TEST_F(Published, OfSeveralMapsEachPoseIsInTheFrameOfItsOwn) {
  MapData data;
  data.parts = {{"ground", {}, 0.0}, {"first", Pose2{100.0, 50.0, 0.0}, 90.0}};
  const GlobalMap map(std::move(data));
  Answers answers(link_, map, "", {.publishes_tf = true});
  StepResult result = declared();
  result.verdict.map_from_robot = result.verdict.estimate->map_from_robot = Pose2{104.0, 55.0, 0.5};
  result.verdict.candidates = {Pose2{1.0, 2.0, 0.0}, Pose2{101.0, 52.0, 0.0}};
  tell(result, answers);
  for (const char* topic : {"/initialpose", "/glocal/pose"}) {
    read(topic, [](const RecordedMessage& message) {
      const auto pose = glocal::bags::read_pose(message);
      EXPECT_NEAR(pose.pose.x, 4.0, 1e-12);
      EXPECT_NEAR(pose.pose.y, 5.0, 1e-12);
      EXPECT_EQ(pose.header.frame, "first");
    });
  }
  read("/tf", [](const RecordedMessage& message) {
    const auto transforms = glocal::bags::read_transforms(message);
    EXPECT_EQ(transforms[0].header.frame, "first");
    EXPECT_NEAR(transforms[0].parent_from_child.x, 4.0 - std::cos(0.5), 1e-12);
  });
  EXPECT_THAT(diagnostics(), Contains(Pair("map", "first")));
  EXPECT_THAT(diagnostics(), Contains(Pair("candidates_on", "ground, first")));
}

TEST_F(Published, OfSeveralMapsTheCovarianceIsInTheFrameOfThePose) {
  MapData data;
  data.parts = {{"ground", {}, 0.0}, {"first", Pose2{100.0, 50.0, radians(90.0)}, 90.0}};
  const GlobalMap map(std::move(data));
  Answers answers(link_, map, "", {});
  StepResult result = declared();
  result.verdict.map_from_robot = result.verdict.estimate->map_from_robot = Pose2{104.0, 55.0, 0.5};
  tell(result, answers);
  for (const char* topic : {"/initialpose", "/glocal/pose"}) {
    read(topic, [](const RecordedMessage& message) {
      const auto pose = glocal::bags::read_pose(message);
      EXPECT_NEAR(pose.pose.x, 5.0, 1e-12);
      EXPECT_NEAR(pose.pose.y, -4.0, 1e-12);
      // What was along y (variance 4) is along x, and what was along x (1) is against y.
      const std::vector<double> c(pose.covariance.begin(), pose.covariance.end());
      ASSERT_EQ(c.size(), 36U);
      EXPECT_NEAR(c[0], 4.0, 1e-12);
      EXPECT_NEAR(c[1], -2.0, 1e-12);
      EXPECT_NEAR(c[6], -2.0, 1e-12);
      EXPECT_NEAR(c[7], 1.0, 1e-12);
      EXPECT_NEAR(c[5], 5.0, 1e-12);
      EXPECT_NEAR(c[11], -3.0, 1e-12);
      EXPECT_EQ(c[35], 6.0);
    });
  }
}

TEST_F(Published, MapToOdomIfAskedFor) {
  Answers answers(link_, map_, "", {.publishes_tf = true});
  tell(declared(), answers);
  read("/tf", [](const RecordedMessage& message) {
    const auto transforms = glocal::bags::read_transforms(message);
    ASSERT_EQ(transforms.size(), 1U);
    EXPECT_EQ(transforms[0].header.frame, "map");
    EXPECT_EQ(transforms[0].child_frame, "odom");
    // The robot is 1 m along odom's x axis.
    EXPECT_NEAR(transforms[0].parent_from_child.x, 4.0 - std::cos(0.5), 1e-12);
    EXPECT_NEAR(transforms[0].parent_from_child.y, 5.0 - std::sin(0.5), 1e-12);
  });
  StepResult lost = declared();
  lost.verdict.kind = VerdictKind::searching;
  tell(lost, answers);
  EXPECT_THAT(topics(), Not(Contains("/tf")));
}

TEST_F(Published, MapToOdomGoesOnWithOdometry) {
  Answers answers(link_, map_, "", {.publishes_tf = true});
  const auto topics_at = [&](int ms) {
    link_.published.clear();
    answers.tell_again(stamp + std::int64_t{ms} * 1'000'000);
    return topics();
  };
  EXPECT_THAT(topics_at(200), IsEmpty()) << "nothing is declared";
  tell(declared(), answers);
  EXPECT_THAT(topics_at(50), IsEmpty());
  EXPECT_THAT(topics_at(100), ElementsAre("/tf"));
  const auto expect_sent_at = [&](std::int64_t stamp_ns) {
    read("/tf", [&](const RecordedMessage& message) {
      const auto transforms = glocal::bags::read_transforms(message);
      ASSERT_EQ(transforms.size(), 1U);
      EXPECT_EQ(transforms[0].header.stamp_ns, stamp_ns);
      EXPECT_EQ(transforms[0].header.frame, "map");
      EXPECT_EQ(transforms[0].child_frame, "odom");
      EXPECT_NEAR(transforms[0].parent_from_child.x, 4.0 - std::cos(0.5), 1e-12);
    });
  };
  expect_sent_at(stamp + 100'000'000);
  // Of a scan that was made before.
  tell(declared(), answers);
  expect_sent_at(stamp + 100'000'001);
  EXPECT_THAT(topics_at(150), IsEmpty());
  EXPECT_THAT(topics_at(60'000), ElementsAre("/tf"));
  EXPECT_THAT(topics_at(250), ElementsAre("/tf")) << "a minute in the future was a mistake";
  answers.begin_anew();
  EXPECT_THAT(topics_at(500), IsEmpty());
  tell(declared(), answers);
  StepResult lost = declared();
  lost.verdict.kind = VerdictKind::searching;
  tell(lost, answers);
  EXPECT_THAT(topics_at(500), IsEmpty());
}

}  // namespace
}  // namespace glocal::test::live::answers_test
