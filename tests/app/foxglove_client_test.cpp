// What a viewer is sent, without a connection.
#include "app/foxglove_client.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace glocal::test::foxglove_client_test {
namespace {

using app::FoxgloveChannel;
using app::FoxgloveClient;
using app::FoxgloveMessage;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::json;

std::shared_ptr<const FoxgloveMessage> message(const std::string& bytes, std::int64_t stamp_ns = 0) {
  return std::make_shared<const FoxgloveMessage>(FoxgloveMessage{stamp_ns, bytes});
}

/// A viewer of a map and scans.
class ViewerOfScans : public testing::Test {
 protected:
  static constexpr std::uint32_t map = 0, scan = 1;
  static constexpr std::size_t most_bytes = 10'000;

  /// Texts, or "ID: BYTES" of messages, as they are sent.
  std::vector<std::string> sent() {
    std::vector<std::string> sent;
    while (const auto frame = client_.next()) {
      if (frame->is_text()) {
        sent.push_back(frame->head);
      } else {
        EXPECT_EQ(frame->head.size(), 13U);
        EXPECT_EQ(frame->head[0], '\1');
        sent.push_back(fmt::format("{}: {}", static_cast<int>(frame->head[1]), frame->message->bytes));
      }
    }
    return sent;
  }
  void subscribe(std::uint32_t channel, int id) {
    client_.take(fmt::format(R"({{"op": "subscribe", "subscriptions": [{{"id": {}, "channelId": {}}}]}})", id,
                             channel));
  }

  std::vector<FoxgloveChannel> channels_ = {
      {{"/map", "nav_msgs/OccupancyGrid"}, message("a map")},
      {{"/scan", "sensor_msgs/LaserScan"}, nullptr},
  };
  FoxgloveClient client_{channels_, most_bytes};
};

TEST_F(ViewerOfScans, IsToldWhoSpeaksAndOfWhat) {
  channels_.push_back({{"/caf\xe9", "std_msgs/Empty"}, nullptr});
  client_.advertise(2);
  const auto texts = sent();
  ASSERT_EQ(texts.size(), 3U);
  EXPECT_EQ(Json::parse(texts[0])["op"], "serverInfo");
  const Json first = Json::parse(texts[1])["channels"];
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[1]["id"], 1);
  EXPECT_EQ(first[1]["topic"], "/scan");
  EXPECT_EQ(first[1]["schemaName"], "sensor_msgs/msg/LaserScan");
  EXPECT_THAT(first[1]["schema"], HasSubstr("float32[] ranges"));
  const Json later = Json::parse(texts[2])["channels"];
  ASSERT_EQ(later.size(), 1U);
  EXPECT_EQ(later[0]["id"], 2);
  EXPECT_EQ(later[0]["topic"], "/caf\xef\xbf\xbd") << "what is no UTF-8 is replaced";
}

TEST_F(ViewerOfScans, GetsWhatItHasSubscribedToAndWhatIsKept) {
  sent();
  client_.offer(scan, message("unasked for"));
  subscribe(scan, 7);
  subscribe(map, 8);
  client_.offer(scan, message("first"));
  client_.offer(scan, message("second"));
  EXPECT_THAT(sent(), ElementsAre("8: a map", "7: first", "7: second"));
  client_.offer(scan, message("no longer wanted"));
  client_.take(R"({"op": "unsubscribe", "subscriptionIds": [7]})");
  client_.offer(scan, message("neither"));
  EXPECT_THAT(sent(), IsEmpty());
  subscribe(scan, 7);
  client_.offer(scan, message("again"));
  EXPECT_THAT(sent(), ElementsAre("7: again"));
}

TEST_F(ViewerOfScans, HasStampsAndIdsInLittleEndian) {
  sent();
  subscribe(scan, 0x01020304);
  client_.offer(scan, message("x", 0x0102030405060708));
  const auto frame = client_.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->head, std::string("\1\4\3\2\1\x8\7\6\5\4\3\2\1"));
}

TEST_F(ViewerOfScans, MissesTheOldestWhereItIsSlowButNoMap) {
  sent();
  subscribe(map, 1);
  subscribe(scan, 2);
  channels_.push_back({{"/tf", "tf2_msgs/TFMessage"}, nullptr});
  client_.advertise(2);
  for (int i = 0; i < 100; ++i) client_.offer(scan, message(fmt::format("{:01000}", i)));
  channels_[map].kept = message("a newer map");
  client_.offer(map, channels_[map].kept);
  const auto got = sent();
  ASSERT_GT(got.size(), 8U);
  ASSERT_LT(got.size(), 12U);
  EXPECT_THAT(got[0], HasSubstr("/tf"));
  EXPECT_EQ(got.back(), "1: a newer map") << "and the older one no longer";
  for (std::size_t i = 1; i + 1 < got.size(); ++i)
    EXPECT_THAT(got[i], testing::EndsWith(fmt::format("0{}", 100 - (got.size() - 1 - i)))) << i;
}

TEST_F(ViewerOfScans, OneMessageThatIsTooLargeIsSent) {
  sent();
  subscribe(scan, 2);
  client_.offer(scan, message("small"));
  client_.offer(scan, message(std::string(2 * most_bytes, 'x')));
  EXPECT_EQ(sent().size(), 1U);
}

TEST_F(ViewerOfScans, WhoNeverReadsFillsNoMemory) {
  for (int i = 0; i < 10'000; ++i) {
    client_.take("rubbish");
    client_.take_binary();
    subscribe(map, i);
    client_.take(fmt::format(R"({{"op": "unsubscribe", "subscriptionIds": [{}]}})", i));
  }
  std::size_t bytes = 0;
  while (const auto frame = client_.next()) bytes += frame->size();
  EXPECT_LE(bytes, most_bytes);
}

TEST_F(ViewerOfScans, SubscribesToAChannelOnceAndWithAnIdOfItsOwn) {
  sent();
  subscribe(scan, 2);
  subscribe(scan, 3);
  subscribe(map, 2);
  const auto said = sent();
  ASSERT_EQ(said.size(), 2U);
  for (const std::string& text : said) EXPECT_EQ(Json::parse(text)["op"], "status") << text;
}

}  // namespace
}  // namespace glocal::test::foxglove_client_test
