// What viewers send to the server of `glocal live --foxglove`: a message a line.
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/foxglove_client.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_foxglove(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  constexpr std::size_t most_bytes = 2000;
  const auto map = std::make_shared<const app::FoxgloveMessage>();
  const std::vector<app::FoxgloveChannel> channels = {{{"/map", "nav_msgs/OccupancyGrid"}, map},
                                                      {{"/scan", "sensor_msgs/LaserScan"}, nullptr}};
  app::FoxgloveClient client(channels, most_bytes);
  for (int i = 0; i < 2; ++i) fuzz::must_hold(client.next().has_value(), "it is told what there is");
  std::istringstream lines(fuzz::text_of(data, size));
  for (std::string line; std::getline(lines, line);) {
    client.take(line);
    client.offer(1, std::make_shared<const app::FoxgloveMessage>());
  }
  std::size_t bytes = 0;
  while (const auto frame = client.next()) {
    bytes += frame->size();
    fuzz::must_hold(!frame->is_text() || nlohmann::json::accept(frame->head), "texts are JSON");
    fuzz::must_hold(frame->is_text() || frame->channel < channels.size(), "messages are of a channel");
  }
  fuzz::must_hold(bytes <= 2 * most_bytes, "no more waits than may");
  return 0;
}
